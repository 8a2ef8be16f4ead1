#pragma once

// Private to this room: what a Shape holds. Includes OpenCASCADE.

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "beltgrinding/shape.h"
#include "brep/shape_tasks.h"
#include "face_sides.h"

namespace beltgrinding {

struct Shape::Impl {
    TopoDS_Shape shape;
    TopTools_IndexedMapOfShape faces;  ///< in FreeCAD's order, from 1
    std::string name;                  ///< for messages
    std::vector<int> solid_of_face;    ///< index into `solids`, -1 for a loose face
    std::vector<TopoDS_Shape> solids;

    /// Face `i` from 0, as oriented in its shell.
    const TopoDS_Face& face(std::size_t i) const {
        return TopoDS::Face(faces(static_cast<int>(i) + 1));
    }
    /// True if the face's solid has a negative volume: its normals all point inwards.
    bool inside_out(std::size_t face) const;
    /// `Shape::warnings` but for those of its sides.
    std::vector<Fact> odd_things(const Shape& of) const;
    /// Which side of the loose faces is outside, found when first asked for. Throws Cancelled.
    const FaceSides& sides(const RunContext& context) const;
    /// The triangulated copy that sides and common borders are told by, and how near free edges
    /// must be to be one, mm. Throws InputError, Standard_Failure, Cancelled.
    std::pair<TopoDS_Shape, double> mesh_for_sides(const RunContext& context) const;

    // Set before anybody else has it.
    mutable bool foreign = false;  ///< the reader's process has read it, and tried it

    // Costly facts, found once when first asked for.
    mutable std::mutex mutex;
    mutable std::vector<signed char> solid_sign;            ///< 0: not yet known
    mutable std::unordered_map<std::size_t, double> areas;  ///< mm2, by face
    mutable std::unique_ptr<Box> extents;
    mutable std::optional<bool> valid;
    mutable std::unique_ptr<std::vector<Fact>> warnings;
    mutable std::mutex sides_mutex;
    mutable std::unique_ptr<FaceSides> known_sides;
};

/// Adds the curves on surfaces that are missing: sampling walks the trimming curves in the
/// surface's parameters, and on any surface but a plane they must be stored. It changes edges that
/// faces share, so it is done once, before anybody else has the shape; on a damaged one it may
/// never end.
void add_missing_curves(const TopoDS_Shape& shape);

enum class MissingCurves {
    kAdd,     ///< a shape of FreeCAD's or of our own
    kAreDone  ///< the reader of CAD files has added them
};

/// Takes `shape` in: numbers its faces. Throws InputError naming `name` if it is null or has no
/// faces.
Shape make_shape(const TopoDS_Shape& shape, const std::string& name,
                 MissingCurves curves = MissingCurves::kAdd);

/// How a shape is triangulated.
struct MeshingParameters {
    double deflection = 0;  ///< mm, or a share of each edge's size if `relative`
    double angle = 0;       ///< rad between facets
    bool relative = false;
};

/// A copy of `shape` (the original is shared with other threads) that carries a triangulation by
/// OpenCASCADE, made here: it may never end. Throws Standard_Failure.
TopoDS_Shape triangulated_copy(const TopoDS_Shape& shape, const MeshingParameters& parameters);

/// The same, bit for bit, made by the reader's process: cancellable at any moment, within its
/// limits of time and memory. Where there is no reader that works, made here, unless the shape is
/// foreign. `name` stands for the shape in messages. Throws InputError, Standard_Failure,
/// Cancelled.
TopoDS_Shape mesh_in_reader(const TopoDS_Shape& shape, const MeshingParameters& parameters,
                            const std::string& name, bool foreign, const RunContext& context);

/// The triangles that the faces of `shape` carry; those with `turned` set (by face; empty: none)
/// are turned over.
TriangleMesh triangles_of(const TopoDS_Shape& shape, const std::vector<char>& turned = {});

/// `Shape::extents`, by triangles made here or by the reader.
Box tight_extents(const TopoDS_Shape& shape, const std::string& name, bool by_reader);

/// `shape_from_mesh`, in this process.
Shape faces_of_mesh(const TriangleMesh& mesh);

/// What `shape_answer` and `faces_answer` packed; `name` stands for it in messages. Throws
/// Standard_Failure if the bytes are no such answer's, InputError as make_shape.
Shape unpack_shape_answer(std::string_view bytes, const std::string& name);

}  // namespace beltgrinding

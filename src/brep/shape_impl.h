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
#include <unordered_map>
#include <vector>

#include "beltgrinding/shape.h"

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

    // Costly facts, found once when first asked for.
    mutable std::mutex mutex;
    mutable std::vector<signed char> solid_sign;            ///< 0: not yet known
    mutable std::unordered_map<std::size_t, double> areas;  ///< mm2, by face
    mutable std::unique_ptr<Box> extents;
    mutable std::optional<bool> valid;
    mutable std::unique_ptr<std::vector<Fact>> warnings;
};

/// Adds the curves on surfaces that are missing: sampling walks the trimming curves in the
/// surface's parameters, and on any surface but a plane they must be stored. It changes edges that
/// faces share, so it is done once, before anybody else has the shape; on a damaged one it may
/// never end.
void add_missing_curves(const TopoDS_Shape& shape);

/// The shape that `BRepTools::Write` wrote; null if the text is no BREP.
TopoDS_Shape read_brep_text(const std::string& text);

enum class MissingCurves {
    kAdd,     ///< a shape of FreeCAD's or of our own
    kAreDone  ///< the reader of CAD files has added them
};

/// Takes `shape` in: numbers its faces. Throws InputError naming `name` if it is null or has no
/// faces.
Shape make_shape(const TopoDS_Shape& shape, const std::string& name,
                 MissingCurves curves = MissingCurves::kAdd);

/// A copy of `shape` (the original is shared with other threads) that carries a triangulation by
/// OpenCASCADE; `angle` in rad between facets. Cancellable.
TopoDS_Shape triangulated_copy(const TopoDS_Shape& shape, double deflection, double angle,
                               bool relative, const RunContext& context);

/// Triangulates `shape` (a copy: the original is shared with other threads); cancellable.
TriangleMesh mesh_of(const TopoDS_Shape& shape, double deflection, bool relative,
                     const RunContext& context);

}  // namespace beltgrinding

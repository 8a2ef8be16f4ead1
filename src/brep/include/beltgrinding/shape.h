#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "beltgrinding/fact.h"
#include "beltgrinding/geometry.h"
#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// The middle of a face, mm.
struct FaceCentre {
    Vec3 centroid = Vec3::Zero();  ///< of its area; on a curved face not on it
    Vec3 point = Vec3::Zero();     ///< on the face
    Vec3 normal = Vec3::Zero();    ///< unit, at `point`, as the face is oriented; 0: no point found
};

/// A boundary representation. Values are cheap to copy (they share OpenCASCADE's data) and never
/// change. Lengths in mm, frame: work. Faces are numbered from 0 in the order of
/// `TopExp::MapShapes(FACE)`, which is FreeCAD's `Face1`, `Face2`, ... less one.
class Shape {
  public:
    struct Impl;

    /// Reads STEP (.step .stp), IGES (.iges .igs) or BREP (.brep .brp), in a process of its own
    /// (`set_cad_reader`): no damaged file takes this one down. Throws InputError naming the file:
    /// missing, no file, unreadable, damaged, null shape, no faces; more than the environment
    /// allows of time (BELTGRINDING_CAD_TIME_LIMIT_S, 900 s if unset), of memory
    /// (BELTGRINDING_CAD_MEMORY_LIMIT_MB, half of what this process may use), or of what the reader
    /// hands over (BELTGRINDING_CAD_ANSWER_LIMIT_MB, half of that); Cancelled within 0.1 s.
    /// `scale`: the shape is made so many times larger than the file says.
    static Shape read(const std::string& path, const RunContext& context = {}, double scale = 1);
    /// The same for the text of a BREP file that came from elsewhere. `name` stands for the shape
    /// in messages.
    static Shape read_brep(const std::string& text, const std::string& name = "shape",
                           const RunContext& context = {}, double scale = 1);
    /// Reads the text that `BRepTools::Write` and FreeCAD's `exportBrepToString` make, in this
    /// process: of a shape that is sound, for a damaged one can end it.
    static Shape from_brep(const std::string& text, const std::string& name = "shape",
                           double scale = 1);
    /// The text that `from_brep` reads, without triangulation.
    std::string write_brep() const;
    /// Number of faces.
    std::size_t face_count() const;
    /// True if the face bounds a solid (its normal then points out of it); else it is loose.
    bool bounds_solid(std::size_t face) const;
    /// Area by Gauss integration, mm2.
    double face_area(std::size_t face) const;
    /// The place on the face that is nearest to the centroid of its area, within its borders; where
    /// a whole circle is as near, or the nearest one lies beyond the borders, the middle of its
    /// parameters; no point where that lies in a hole. None: OpenCASCADE cannot find the centroid.
    /// Throws InputError as `face_area` does.
    std::optional<FaceCentre> face_centre(std::size_t face) const;
    /// Name of the face's surface type ("plane", "bspline", ...).
    std::string surface_type(std::size_t face) const;
    /// Tight extents of the triangulated shape (not the pole box), mm.
    Box extents() const;
    /// By OpenCASCADE's check. Its mesher may not end on the faults of a shape that is not.
    bool valid() const;
    /// For each face, whether its outside is against its orientation. A solid's faces look out of
    /// it; loose ones as their neighbours and what they enclose tell, as given where nothing tells.
    /// Throws Cancelled.
    std::vector<char> reversed(const RunContext& context = {}) const;
    /// The same shape with its loose faces (`all`), and then those of `faces` (from 0), flipped.
    /// Throws InputError for a face that is not there or bounds a solid.
    Shape flipped(bool all, const std::vector<std::size_t>& faces) const;
    /// For each face, those that it has a border in common with, ascending: an edge, or free edges
    /// that lie on each other. Throws InputError where the shape cannot be triangulated, Cancelled.
    std::vector<std::vector<std::size_t>> neighbours(const RunContext& context = {}) const;
    /// Things the user should know: not valid, extents beyond 10 m or below 0.1 mm (a unit
    /// mistake), zero-area faces, loose faces that are turned, in doubt, or contrary. Each is one
    /// sentence that names the face.
    std::vector<Fact> warnings() const;

    /// For this room: OpenCASCADE's data.
    const Impl& impl() const { return *impl_; }
    /// For this room: a shape around OpenCASCADE's data.
    explicit Shape(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

  private:
    std::vector<Fact> side_warnings(const RunContext& context) const;

    std::shared_ptr<const Impl> impl_;
    std::shared_ptr<const std::vector<char>> flipped_;  ///< by face; null: none
};

/// The program that reads foreign files and triangulates, in a process of its own for each call:
/// the path of `beltgrinding-cad-reader`. Empty: what the environment's BELTGRINDING_CAD_READER
/// says, else the one beside the library or program that holds this code, else the one where the
/// library was installed. Thread-safe.
void set_cad_reader(const std::string& program);

/// How faces are sampled.
struct SamplingOptions {
    double spacing = 0.5;       ///< mm, distance between neighbouring samples, both directions
    double precision = 0;       ///< mm, by which chords may bulge on curved places; 0: any
    double edge_spacing = 0;    ///< mm, least spacing on curved places; 0: a fortieth of `spacing`
    double depth = 1.0;         ///< mm, HeightField::depth
    std::size_t max_bytes = 0;  ///< refuse what would need more; 0: half of what may be used
    bool parameters = false;    ///< fill SamplingReport::parameters
};

/// What sampling found besides the field.
struct SamplingReport {
    std::vector<double> face_area;  ///< mm2, exact area of each sampled face, in `faces` order
    std::vector<Fact> warnings;     ///< of one face each
    /// u, v of every sample on its face's surface, if asked for. A sample on a seam has those of
    /// one side, a pole (SampleFlag kDegenerate) those of one of its nodes.
    std::vector<std::array<double, 2>> parameters;
    /// Period in u and v of each sampled face's surface; 0 where it is not closed.
    std::vector<std::array<double, 2>> period;
};

/// Samples `faces` (from 0; all faces if empty) of `shape` as a height field of zero heights, in
/// parallel. Grid spacing is `options.spacing` within 10 % in both surface directions wherever the
/// parametrisation allows; samples lie on the trimming edges; areas sum to each face's area within
/// 0.1 %. Throws InputError naming the face (from 1) or the spacing.
HeightField sample_faces(const Shape& shape, std::vector<std::size_t> faces,
                         const SamplingOptions& options, const RunContext& context = {},
                         SamplingReport* report = nullptr);

/// Triangulates `faces` (from 0; the whole shape if empty) to a chord error of `deflection` mm;
/// outward orientation. By the reader's process, under its limits, where there is a reader. Throws
/// InputError naming the face that does not exist, or the limit; Cancelled within 0.1 s.
TriangleMesh triangulate(const Shape& shape, double deflection, const RunContext& context = {},
                         const std::vector<std::size_t>& faces = {});

/// A faceted shell of planar faces from a mesh that came without a B-rep (an STL design), sewn,
/// coplanar neighbours merged. By the reader's process, as `triangulate`. Throws InputError for a
/// mesh without a sound triangle.
Shape shape_from_mesh(const TriangleMesh& mesh, const RunContext& context = {});

}  // namespace beltgrinding

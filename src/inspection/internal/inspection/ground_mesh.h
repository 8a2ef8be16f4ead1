#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "beltgrinding/deviation.h"
#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"
#include "mesh/mesh_check.h"
#include "mesh/surface_mesh.h"

namespace beltgrinding {

/// What a vertex of the ground part's mesh stands on.
enum class MeshVertex : std::uint8_t {
    kDesign,  ///< on no ground face
    kGround,  ///< on a ground face
    kMissed,  ///< on a ground face whose samples there all missed the stock: left on the design
    kBorder,  ///< between a ground face and one that is not
};

/// The whole part as ground: the faces of a height field displaced by it, the others as designed.
/// Frame: work; mm.
struct GroundMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;   ///< counter-clockwise seen from outside
    std::vector<std::uint32_t> face;   ///< of each triangle, from 0
    std::vector<float> deviation;      ///< of each vertex from the design, mm; NaN where not ground
    std::vector<MeshVertex> standing;  ///< of each vertex

    MeshCheck check, design_check;  ///< of this mesh, and of the same triangles undisplaced
    double expected_volume = 0;     ///< mm3, sum of area x height of the samples: check.volume -
                                    ///< design_check.volume in the first order
    std::size_t flipped = 0;        ///< triangles that the displacement turned over
    std::size_t flat = 0;           ///< triangles that point against the design surface itself
    std::size_t limited = 0;        ///< vertices on thin edges held back by the mitre limit
    std::size_t slid = 0;           ///< vertices that follow a moved edge along their face
    std::size_t missed = 0;         ///< vertices left on the design: no stock was found there
    std::size_t defective = 0;      ///< samples whose stock lay below the design; taken as found
    std::vector<Fact> warnings;
};

/// Displaces the vertices of `mesh` on the faces of `field` by the height, linear in the triangles
/// of the samples of that face, along the surface's normal. Where faces with the normals n_i and
/// the heights h_i (0: not ground) meet, a vertex moves by the shortest d with n_i . d = h_i (least
/// squares); faces that are nearly tangent give the mean, and on edges so thin that |d| would
/// exceed 3 max |h_i|, d ends there (mitre limit). Where an edge moves so far sideways that it
/// would turn triangles over, the vertices near it slide along in their tangent planes. Samples
/// that missed the stock are left out of the interpolation; a vertex that has no other stays on the
/// design. Without `ground` nothing is displaced. Self-intersections are not looked for.
GroundMesh ground_mesh(const SurfaceMesh& mesh, const HeightField& field, bool ground = true,
                       const RunContext& context = {});

/// 0xRRGGBBAA of each vertex.
std::vector<std::uint32_t> mesh_colours(const GroundMesh& mesh, const ColourScale& scale);

}  // namespace beltgrinding

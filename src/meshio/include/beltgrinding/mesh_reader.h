#pragma once

#include <string>
#include <vector>

#include "beltgrinding/fact.h"
#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// A mesh or cloud as its file has it: vertices in the file's unit and frame.
struct RawMesh {
    std::vector<Vec3> vertices;       ///< in the file's unit and frame
    std::vector<Triangle> triangles;  ///< indices that lie within `vertices`; none: a cloud
    /// mm of the file's 1, where the file says it (3MF); 0: it does not.
    double unit = 0.0;
    std::size_t turned = 0;  ///< closed pieces that were inside out in the file, and are no more
};

/// What was found out about a mesh while it was read.
struct MeshReport {
    double unit = 1.0;           ///< mm of the file's 1, by which it was scaled
    std::vector<Fact> warnings;  ///< a size that no part has; pieces that were inside out
};

/// Reads a PLY (Turk 1994; ASCII, binary of both byte orders). Polygons become fans, strips
/// triangles; elements that name no vertices are passed over, others refused. Ours, in this
/// process: it needs no more memory and time than the file is large, is fuzzed (tests/fuzz/native),
/// and keeps doubles, where assimp rounds. Throws InputError naming the file and what is wrong with
/// it.
RawMesh read_ply(const std::string& path);

/// Reads STL, OBJ or OFF by assimp, 3MF by lib3mf, both in a process of its own as `Shape::read`
/// (beltgrinding/shape.h), and PLY by `read_ply`; scaled by `unit_mm` (1: the unit that a 3MF says,
/// else millimetres; 1000: metres) and moved by `work_from_mesh`. Closed pieces that are inside out
/// are turned. Throws InputError naming the file; Cancelled within 0.1 s while a library reads.
TriangleMesh read_mesh(const std::string& path, double unit_mm = 1.0,
                       const Frame& work_from_mesh = Frame::Identity(),
                       const RunContext& context = {}, MeshReport* report = nullptr);

}  // namespace beltgrinding

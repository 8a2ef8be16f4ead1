#pragma once

#include <string>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// A mesh or cloud as its file has it: vertices in the file's unit and frame.
struct RawMesh {
    std::vector<Vec3> vertices;       ///< in the file's unit and frame
    std::vector<Triangle> triangles;  ///< indices that lie within `vertices`; none: a cloud
};

/// Reads a PLY (Turk 1994; ASCII, binary of both byte orders); polygons become fans, other elements
/// than vertices and faces are passed over. Ours, in this process: it needs no more memory and time
/// than the file is large, is fuzzed (tests/fuzz/native), and keeps doubles, where assimp rounds.
/// Throws InputError naming the file and what is wrong with it.
RawMesh read_ply(const std::string& path);

/// Reads STL, OBJ or OFF by assimp, 3MF by lib3mf, both in a process of its own as `Shape::read`
/// (beltgrinding/shape.h), and PLY by `read_ply`; scaled by `unit_mm` (1: millimetres, 1000:
/// metres) and moved by `work_from_mesh`. Throws InputError naming the file; Cancelled within 0.1 s
/// while a library reads.
TriangleMesh read_mesh(const std::string& path, double unit_mm = 1.0,
                       const Frame& work_from_mesh = Frame::Identity(),
                       const RunContext& context = {});

}  // namespace beltgrinding

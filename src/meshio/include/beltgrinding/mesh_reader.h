#pragma once

#include <string>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// A mesh or cloud as its file has it: vertices in the file's unit and frame.
struct RawMesh {
    std::vector<Vec3> vertices;       ///< in the file's unit and frame
    std::vector<Triangle> triangles;  ///< indices that lie within `vertices`; none: a cloud
};

/// Reads a PLY (Turk 1994; ASCII, binary of both byte orders); polygons become fans, other elements
/// than vertices and faces are passed over. Ours, because assimp 5.2 crashes on damaged ones.
/// Throws InputError naming the file and what is wrong with it.
RawMesh read_ply(const std::string& path);

/// Reads STL, OBJ or OFF by assimp, 3MF by lib3mf, PLY by `read_ply`, scaled by `unit_mm` (1:
/// millimetres, 1000: metres) and moved by `work_from_mesh`. Throws InputError naming the file.
TriangleMesh read_mesh(const std::string& path, double unit_mm = 1.0,
                       const Frame& work_from_mesh = Frame::Identity());

}  // namespace beltgrinding

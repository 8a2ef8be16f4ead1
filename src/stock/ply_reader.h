#pragma once

#include <string>
#include <vector>

#include "base/geometry.h"

namespace beltgrinding {

/// A mesh as its file has it: vertices in the file's unit and frame.
struct RawMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;  ///< indices that lie within `vertices`
};

/// Reads a PLY (Turk 1994; ASCII, binary of both byte orders); polygons become fans, other elements
/// than vertices and faces are passed over. Ours, because assimp 5.2 crashes on damaged ones.
/// Throws InputError naming the file and what is wrong with it.
RawMesh read_ply(const std::string& path);

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/fact.h"
#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Triangles of a whole shape that meet without gaps at its edges. Frame: work; mm.
struct SurfaceMesh {
    /// A face that meets at a vertex, and its outward unit normal there.
    struct Meeting {
        std::uint32_t vertex = 0;
        std::uint32_t face = 0;  ///< index in the shape, from 0
        Vec3f normal = Vec3f::Zero();
    };
    std::vector<Vec3> vertices;       ///< on the faces' surfaces and the edges' curves
    std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
    std::vector<std::uint32_t> face;  ///< of each triangle, from 0
    std::vector<Meeting> meetings;    ///< sorted by vertex, then by face
    std::vector<Fact> warnings;
};

}  // namespace beltgrinding

#pragma once

#include "beltgrinding/geometry.h"

namespace beltgrinding::testing {

/// A box between two corners, its triangles outwards.
inline TriangleMesh box(const Vec3& low, const Vec3& high) {
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) {
        mesh.vertices.push_back(Vec3(((k & 1) != 0 ? high : low).x(),
                                     ((k & 2) != 0 ? high : low).y(),
                                     ((k & 4) != 0 ? high : low).z())
                                    .cast<float>());
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

}  // namespace beltgrinding::testing

#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Soundness and size of a triangle mesh.
struct MeshCheck {
    std::size_t border_edges = 0;        ///< with one triangle; 0: closed
    std::size_t non_manifold_edges = 0;  ///< with three triangles or more
    std::size_t turned_edges = 0;        ///< with two triangles that run round oppositely
    std::size_t components = 0;          ///< pieces connected by edges
    long long euler = 0;                 ///< vertices - edges + triangles; 2 for a ball
    double volume = 0;                   ///< mm3, by the divergence theorem; of a closed mesh
    double area = 0;                     ///< mm2
    bool closed() const {
        return border_edges == 0 && non_manifold_edges == 0 && turned_edges == 0;
    }
};

/// Throws InputError when a triangle names a vertex that does not exist.
MeshCheck check_mesh(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

}  // namespace beltgrinding

#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/shape.h"
#include "mesh/surface_mesh.h"

namespace beltgrinding {

struct SurfaceMeshOptions {
    double deflection = 0.05;             ///< mm, chord error of the faces that are not fine
    double spacing = 0.5;                 ///< mm, of the vertices on fine faces and their borders
    std::vector<std::size_t> fine_faces;  ///< from 0
};

/// Triangulates `shape` by OpenCASCADE to the deflection, one triangulation for all faces so that
/// neighbours share the vertices of their common edge, and then halves every mesh edge on a fine
/// face that is longer than sqrt(2) spacing, with the triangles on both sides of it, until none is
/// left. New vertices lie on the edge's curve, or on the surface at the mean of the ends'
/// parameters. The mesh is closed where the shape's faces share their edges. The result does not
/// depend on the number of threads. Throws InputError for a number that is no length, a face that
/// does not exist, or a shape that OpenCASCADE cannot triangulate.
SurfaceMesh surface_mesh(const Shape& shape, const SurfaceMeshOptions& options,
                         const RunContext& context = {});

}  // namespace beltgrinding

#pragma once

// Private to this room: OpenCASCADE's triangulation of a shape, taken over into a FaceMesh.

#include <TopoDS_Shape.hxx>
#include <vector>

#include "mesh_refinement.h"

namespace beltgrinding {

struct AssembledMesh {
    FaceMesh mesh;
    std::vector<std::uint32_t> without_triangles;  ///< faces, from 0
    bool torn = false;  ///< two faces divide a common edge in different ways
};

/// The triangulation that `shape` carries; neighbouring faces share the vertices of their edge.
/// `reverse`: for each face, whether its triangles are to be turned over.
AssembledMesh assemble(const TopoDS_Shape& shape, const std::vector<char>& reverse);

}  // namespace beltgrinding

#pragma once

#include <string>

#include "beltgrinding/deviation.h"
#include "inspection/ground_mesh.h"

namespace beltgrinding {

/// Binary STL.
std::string mesh_stl(const GroundMesh& mesh);
/// Binary PLY; with a scale also the vertices' colours (red green blue alpha) and the float
/// property `deviation` (mm; NaN where not ground).
std::string mesh_ply(const GroundMesh& mesh, const ColourScale* scale);

/// Binary PLY of the samples' tops (`ground` true) or of the design points, with triangles, vertex
/// colours (red green blue alpha) and the float property `deviation` (mm; NaN where missed). `run`,
/// one word or none, is told in its comment.
std::string deviation_ply(const HeightField& field, const ColourScale& scale, bool ground,
                          const std::string& run = "");

/// Binary PLY with nothing but vertices and triangles, as FreeCAD's Mesh reads it fastest; vertex i
/// is sample i.
std::string mesh_ply(const HeightField& field, bool ground);

}  // namespace beltgrinding

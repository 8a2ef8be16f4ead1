#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "beltgrinding/deviation.h"
#include "inspection/ground_mesh.h"

namespace beltgrinding {

/// Where a file of `whole` bytes goes, piece after piece: gives memory for the next `bytes`, all of
/// which are written before it is asked for more.
using FileMemory = std::function<char*(std::size_t bytes, std::size_t whole)>;

/// Binary STL.
void mesh_stl(const GroundMesh& mesh, const FileMemory& memory);
/// Binary PLY; with a scale also the vertices' colours (red green blue alpha) and the float
/// property `deviation` (mm; NaN where not ground).
void mesh_ply(const GroundMesh& mesh, const ColourScale* scale, const FileMemory& memory);

/// Binary PLY of the samples' tops (`ground` true) or of the design points, with triangles, vertex
/// colours (red green blue alpha) and the float property `deviation` (mm; NaN where missed). `run`,
/// one word or none, is told in its comment.
void deviation_ply(const HeightField& field, const ColourScale& scale, bool ground,
                   const std::string& run, const FileMemory& memory);

/// Binary PLY with nothing but vertices and triangles, as FreeCAD's Mesh reads it fastest; vertex i
/// is sample i.
void mesh_ply(const HeightField& field, bool ground, const FileMemory& memory);

}  // namespace beltgrinding

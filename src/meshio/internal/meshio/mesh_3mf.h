#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// The bytes of a 3MF file (3MF Core Specification 1.3) with one mesh. Vertices in mm, rounded to
/// single precision and 1e-6 mm; triangles counter-clockwise seen from outside; `colours`
/// 0xRRGGBBAA, one a vertex, or empty. By lib3mf, in the reader's process: it sets a program's
/// locale and leaves it so. Throws InputError where the reader was built without it, and for a mesh
/// that lib3mf refuses (a vertex that is not finite, a triangle that names one twice).
std::string write_3mf(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                      std::span<const std::uint32_t> colours = {});

}  // namespace beltgrinding

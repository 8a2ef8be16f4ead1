#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "beltgrinding/geometry.h"
#include "beltgrinding/mesh_reader.h"

namespace beltgrinding {

/// The bytes of a 3MF file (3MF Core Specification 1.3) with one mesh. Vertices in mm, rounded to
/// single precision and 1e-6 mm; triangles counter-clockwise seen from outside; `colours`
/// 0xRRGGBBAA, one a vertex, or empty. By lib3mf. Throws InputError where this was built without
/// it, and for a mesh that lib3mf refuses (a vertex that is not finite, a triangle that names one
/// twice).
std::string write_3mf(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                      std::span<const std::uint32_t> colours = {});

/// The mesh of a 3MF file: all that is built, in one, in the file's unit. None where this was built
/// without lib3mf. Throws InputError naming the file.
std::optional<RawMesh> read_3mf(const std::string& path);

}  // namespace beltgrinding

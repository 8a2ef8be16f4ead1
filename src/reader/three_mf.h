#pragma once

// Private to this room: 3MF (3MF Core Specification 1.3) by lib3mf.

#include <optional>
#include <string>

#include "meshio/mesh_bytes.h"

namespace beltgrinding {

/// The bytes of a file with one mesh, mm. Throws InputError where this was built without lib3mf,
/// and for a mesh that it refuses (a triangle that names a vertex twice).
std::string write_3mf_file(const MeshBytes& mesh);

/// The mesh of a file: all that is built, in one, in the file's unit, which it says. None where
/// this was built without lib3mf. Throws InputError naming the file.
std::optional<MeshBytes> read_3mf(const std::string& path);

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// A mesh as the libraries of the reader's process have it: single precision, one colour a vertex
/// or none.
struct MeshBytes {
    std::vector<Vec3f> vertices;         ///< in the file's unit and frame
    std::vector<Triangle> triangles;     ///< indices of vertices
    std::vector<std::uint32_t> colours;  ///< 0xRRGGBBAA
    double unit = 0.0;                   ///< mm of 1, as the file says; 0: it does not
};

/// The mesh as bytes for another process of the same build.
std::string pack_mesh(const MeshBytes& mesh);

/// What `pack_mesh` packed. None if the bytes are not such a mesh's: too few or too many, an index
/// that is no vertex's, colours that are not one a vertex.
std::optional<MeshBytes> unpack_mesh(std::string_view bytes);

}  // namespace beltgrinding

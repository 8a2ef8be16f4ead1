#pragma once

// Private to this room: what goes between the reader's process and its host beside a shape's bytes.

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

constexpr double kNoArea = -1.0;  ///< of a face that OpenCASCADE cannot integrate
/// Of a face whose area was not found in time; one that evaluates to no number is NaN.
constexpr double kEndlessArea = std::numeric_limits<double>::infinity();

/// What the reader has asked of a shape.
struct TriedShape {
    bool valid = false;
    std::optional<Box> extents;      ///< mm; none if it could not be meshed
    std::vector<double> areas;       ///< mm2, of each face
    std::vector<signed char> signs;  ///< of each solid's volume; 0: no face of it was met
};

/// As bytes; none: nothing was asked.
std::string pack_tried(const std::optional<TriedShape>& tried);

/// Takes it off the front. Throws Standard_Failure if the bytes are not such.
std::optional<TriedShape> unpack_tried(std::string_view& bytes);

/// A mesh as bytes.
std::string pack_triangles(const TriangleMesh& mesh);

/// What `pack_triangles` packed; none if the bytes are not such a mesh's.
std::optional<TriangleMesh> unpack_triangles(std::string_view bytes);

}  // namespace beltgrinding

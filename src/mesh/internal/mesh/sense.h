#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Turns the closed pieces of a mesh that are inside out (negative signed volume), with all that
/// lies within their boxes; a cavity in a piece stays as it is. Pieces with borders stay: nothing
/// tells their sense. Vertices in one place count as one. Returns how many pieces were turned.
std::size_t turn_outward(const std::vector<Vec3>& vertices, std::vector<Triangle>& triangles);

}  // namespace beltgrinding

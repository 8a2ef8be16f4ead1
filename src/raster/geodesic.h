#pragma once

// Private to this room.

#include <cstdint>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// Distances on a triangulated surface by fast marching (Kimmel, Sethian 1998). `distance` holds
/// the sources' values, +inf elsewhere, and is filled for all vertices that can be reached; mm.
void march(const std::vector<Vec3>& point, const std::vector<Triangle>& triangles,
           std::vector<double>& distance, const RunContext& context);

}  // namespace beltgrinding

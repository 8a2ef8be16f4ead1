#pragma once

#include <vector>

#include "beltgrinding/height_field.h"

namespace beltgrinding {

/// Raises each of `values` (one per sample) to the largest of the samples that up to `rings`
/// sides of triangles lead to. Throws InputError where there are not as many as samples.
void spread_largest(const HeightField& field, std::vector<float>& values, int rings);

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/deviation.h"

namespace beltgrinding {

// Packed colours 0xRRGGBBAA of one value a sample, on all threads: for a view that follows a run.
// `flags` are the samples' (HeightField::flags); missed samples get their own grey. All throw
// InputError if the lengths differ.

/// Of deviations, mm, by their verdict.
std::vector<std::uint32_t> deviation_colours(std::span<const double> heights,
                                             std::span<const std::uint8_t> flags,
                                             const ColourScale& scale);

/// Of what has no sign (a removed depth, a standard deviation, a pressure, a share of contact):
/// light to dark, up to `limit` in the values' unit.
std::vector<std::uint32_t> magnitude_colours(std::span<const double> values,
                                             std::span<const std::uint8_t> flags, double limit);

/// Of faces: colours of even lightness, far apart for neighbouring numbers.
std::vector<std::uint32_t> face_colours(std::span<const std::uint32_t> faces);

}  // namespace beltgrinding

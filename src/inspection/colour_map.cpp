#include "inspection/colour_map.h"

#include <cmath>
#include <numbers>
#include <string>

#include "base/parallel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 16384;  // samples of one task
constexpr std::uint32_t kFaceColours = 256;

/// `colour(i)` for every i of [0, n).
template <class Colour>
std::vector<std::uint32_t> each(std::size_t n, Colour&& colour) {
    std::vector<std::uint32_t> colours(n);
    parallel_blocks(n, kBlock, RunContext(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) colours[i] = colour(i);
    });
    return colours;
}

void check(std::size_t values, std::size_t flags) {
    if (values != flags) {
        throw InputError("inspection.colours", "colours: {values} values for {samples} samples",
                         {{"values", values}, {"samples", flags}});
    }
}

/// Hues a golden section apart (so that any few in a row differ), each with the same weight of
/// red, green and blue.
std::uint32_t face_colour(std::uint32_t face) {
    const double hue = 2.0 * std::numbers::pi * std::fmod(face / std::numbers::phi, 1.0);
    std::uint32_t packed = 0;
    for (int k = 0; k < 3; ++k) {
        const double value = 0.62 + 0.3 * std::cos(hue - 2.0 * std::numbers::pi * k / 3.0);
        packed = packed << 8U | static_cast<std::uint32_t>(std::lround(255.0 * value));
    }
    return packed << 8U | 255U;
}

}  // namespace

std::vector<std::uint32_t> deviation_colours(std::span<const double> heights,
                                             std::span<const std::uint8_t> flags,
                                             const ColourScale& scale) {
    check(heights.size(), flags.size());
    return each(heights.size(), [&](std::size_t i) {
        return (flags[i] & kMissed) != 0 ? scale.missed_colour() : scale.colour(heights[i]);
    });
}

std::vector<std::uint32_t> magnitude_colours(std::span<const double> values,
                                             std::span<const std::uint8_t> flags, double limit) {
    check(values.size(), flags.size());
    const std::uint32_t missed = ColourScale().missed_colour();
    return each(values.size(), [&](std::size_t i) {
        return (flags[i] & kMissed) != 0 ? missed : uncertainty_colour(values[i], limit);
    });
}

std::vector<std::uint32_t> face_colours(std::span<const std::uint32_t> faces) {
    std::vector<std::uint32_t> palette;
    for (std::uint32_t face = 0; face < kFaceColours; ++face) palette.push_back(face_colour(face));
    return each(faces.size(), [&](std::size_t i) { return palette[faces[i] % kFaceColours]; });
}

}  // namespace beltgrinding

#include "beltgrinding/deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/student.h"
#include "beltgrinding/error.h"
#include "heightfield/sound_field.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kSamplesOfTask = 1U << 15U;

struct Colour {
    double r, g, b;
};

// Brown above, blue below: the two ends of ColorBrewer's BrBG and RdYlBu families are told apart in
// every common colour vision deficiency, because they differ in blue against yellow, not in red
// against green. Ramps darken with the distance, so that they also read in grey.
constexpr Colour kGood{0.80, 0.84, 0.80};
constexpr std::array<Colour, 3> kAbove{
    {{0.99, 0.80, 0.35}, {0.90, 0.45, 0.05}, {0.45, 0.15, 0.02}}};
constexpr std::array<Colour, 3> kBelow{
    {{0.55, 0.78, 0.98}, {0.15, 0.40, 0.85}, {0.10, 0.08, 0.40}}};
// One hue for what has no sign.
constexpr std::array<Colour, 3> kUncertain{
    {{0.93, 0.93, 0.90}, {0.55, 0.66, 0.45}, {0.10, 0.30, 0.16}}};
constexpr std::uint32_t kMissedColour = 0x707070FF;

std::uint32_t pack(const Colour& c) {
    const auto byte = [](double v) {
        return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
    };
    return byte(c.r) << 24U | byte(c.g) << 16U | byte(c.b) << 8U | 255U;
}

Colour mix(const Colour& a, const Colour& b, double w) {
    return {a.r + w * (b.r - a.r), a.g + w * (b.g - a.g), a.b + w * (b.b - a.b)};
}

std::uint32_t ramp(const std::array<Colour, 3>& stops, double t) {
    const double u = 2.0 * std::clamp(t, 0.0, 1.0);
    const std::size_t k = u < 1.0 ? 0 : 1;
    const double w = u - static_cast<double>(k);
    return pack(mix(stops[k], stops[k + 1], w));
}

Colour unpack(std::uint32_t packed) {
    const auto share = [packed](unsigned shift) { return (packed >> shift & 255U) / 255.0; };
    return {share(24), share(16), share(8)};
}

/// A ramp that darkens like the constant ones, from one colour in its middle.
std::array<Colour, 3> ramp_of(std::uint32_t packed) {
    const Colour c = unpack(packed);
    return {mix(c, {1, 1, 1}, 0.5), c, mix(c, {0, 0, 0}, 0.6)};
}

/// Place on a ramp of the step in which t in [0, 1] lies; the first and the last are its ends.
double stepped(double t, int bands) {
    if (bands == 1) return 0.5;
    const double step = std::floor(std::clamp(t, 0.0, 1.0) * bands);
    return std::min(step, bands - 1.0) / (bands - 1.0);
}

void refuse_no_band(const Tolerance& tolerance) {
    if (!std::isfinite(tolerance.lower) || !std::isfinite(tolerance.upper) ||
        tolerance.lower > tolerance.upper) {
        throw InputError("inspection.tolerance",
                         "tolerance: the lower limit must not lie above the upper one");
    }
}

/// Fills in what follows from the samples' standard deviations. Sorts `inspected` by them.
void add_uncertainty(const HeightField& field, const Tolerance& tolerance,
                     std::vector<std::uint32_t>& inspected, double area, DeviationStatistics& s) {
    if (field.height_sd.size() != field.size()) return;
    for (const std::uint32_t i : inspected) {
        const double sd = std::max(static_cast<double>(field.height_sd[i]), 1e-12);
        const double share = field.area[i] / area, h = field.height[i];
        s.sd_mean += share * field.height_sd[i];
        s.expected_in_tolerance_share +=
            share * (student_distribution((tolerance.upper - h) / sd, field.sd_freedom) -
                     student_distribution((tolerance.lower - h) / sd, field.sd_freedom));
    }
    std::sort(inspected.begin(), inspected.end(), [&](std::uint32_t a, std::uint32_t b) {
        return field.height_sd[a] != field.height_sd[b] ? field.height_sd[a] < field.height_sd[b]
                                                        : a < b;
    });
    double so_far = 0.0;
    for (const std::uint32_t i : inspected) {
        s.sd_p95 = field.height_sd[i];
        so_far += field.area[i];
        if (so_far >= 0.95 * area) break;
    }
}

}  // namespace

DeviationStatistics deviation_statistics(const HeightField& field, const Tolerance& tolerance) {
    field.validate();
    refuse_no_band(tolerance);
    DeviationStatistics s;
    s.samples = field.size();
    std::vector<std::uint32_t> inspected;
    inspected.reserve(field.size());
    double area = 0.0, sum = 0.0, squares = 0.0, good = 0.0, above = 0.0, below = 0.0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const double a = field.area[i], h = field.height[i];
        s.design_area += a;
        if ((field.flags[i] & kDefective) != 0) ++s.defective;
        if ((field.flags[i] & kMissed) != 0) {
            ++s.missed;
            continue;
        }
        s.stock_volume += a * std::max(static_cast<double>(field.stock_height[i]), 0.0);
        s.removed_volume += a * removed_from(field, i);
        inspected.push_back(static_cast<std::uint32_t>(i));
        area += a;
        sum += a * h;
        squares += a * h * h;
        (h > tolerance.upper ? above : h < tolerance.lower ? below : good) += a;
    }
    if (inspected.empty() || area <= 0.0) return s;
    s.mean = sum / area;
    s.rms = std::sqrt(squares / area);
    s.in_tolerance_share = good / area;
    s.above_share = above / area;
    s.below_share = below / area;
    std::sort(inspected.begin(), inspected.end(), [&](std::uint32_t a, std::uint32_t b) {
        return field.height[a] != field.height[b] ? field.height[a] < field.height[b] : a < b;
    });
    s.min = field.height[inspected.front()];
    s.max = field.height[inspected.back()];
    s.p05 = s.p50 = s.p95 = s.max;
    const std::array<std::pair<double, double*>, 3> wanted{
        {{0.05, &s.p05}, {0.50, &s.p50}, {0.95, &s.p95}}};
    std::size_t next = 0;
    double so_far = 0.0;
    for (const std::uint32_t i : inspected) {
        so_far += field.area[i];
        while (next < wanted.size() && so_far >= wanted[next].first * area) {
            *wanted[next++].second = field.height[i];
        }
    }
    add_uncertainty(field, tolerance, inspected, area, s);
    return s;
}

std::uint32_t uncertainty_colour(double sd, double limit) {
    if (!std::isfinite(sd)) return kMissedColour;
    return ramp(kUncertain, sd / std::max(limit, 1e-9));
}

std::vector<std::uint32_t> uncertainty_colours(const HeightField& field, double limit) {
    field.validate();
    if (field.height_sd.size() != field.size()) {
        throw InputError("inspection.no_uncertainty",
                         "the result has no uncertainty: its law was not calibrated");
    }
    std::vector<std::uint32_t> colours(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        colours[i] = (field.flags[i] & kMissed) != 0
                         ? kMissedColour
                         : uncertainty_colour(field.height_sd[i], limit);
    }
    return colours;
}

void ColourScale::validate() const {
    refuse_no_band(tolerance);
}

std::uint32_t ColourScale::colour(double deviation) const {
    if (!std::isfinite(deviation)) return missed_colour();
    const auto step = [this](double t) { return bands > 0 ? stepped(t, bands) : t; };
    if (deviation > tolerance.upper) {
        return ramp(choice ? ramp_of(choice->above) : kAbove,
                    step((deviation - tolerance.upper) / std::max(limit - tolerance.upper, 1e-9)));
    }
    if (deviation < tolerance.lower) {
        return ramp(choice ? ramp_of(choice->below) : kBelow,
                    step((tolerance.lower - deviation) / std::max(limit + tolerance.lower, 1e-9)));
    }
    return choice ? choice->good | 255U : pack(kGood);
}

std::uint32_t ColourScale::missed_colour() const {
    return kMissedColour;
}

std::vector<std::uint32_t> deviation_colours(const HeightField& field, const ColourScale& scale) {
    field.validate();
    scale.validate();
    std::vector<std::uint32_t> colours(field.size());
    parallel_blocks(field.size(), kSamplesOfTask, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            colours[i] = (field.flags[i] & kMissed) != 0 ? scale.missed_colour()
                                                         : scale.colour(field.height[i]);
        }
    });
    return colours;
}

}  // namespace beltgrinding

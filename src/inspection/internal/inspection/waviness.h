#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// Low-pass of a profile sampled at equal steps: weighted mean with the Gaussian
/// s(x) = exp(-pi (x / (alpha c))^2) / (alpha c), alpha = sqrt(ln 2 / pi), of which a wave as long
/// as the cutoff c comes through by one half. The weights reach to x = c; near the ends those that
/// are left are normalised, so values nearer to an end than c/2 are not to be relied on.
/// ISO 16610-21:2011. `step`, `cutoff` in mm, positive; values in any unit.
std::vector<double> gaussian_filter(std::span<const double> values, double step, double cutoff);

/// A programmed motion over the work: where its contact point ends (mm, work frame), and whether
/// the next one goes on from there.
struct MotionEnd {
    Vec3 point = Vec3::Zero();
    bool begins = false;  ///< the first pose of a program: no motion leads to it
};

/// Waviness in one direction: of the profile's deviations between the two cutoffs. ISO 21920-2.
struct WavinessFigures {
    std::size_t profiles = 0;
    double mean = 0.0;   ///< Wa, arithmetic mean of |w| over all profiles, mm
    double total = 0.0;  ///< Wt, largest height difference within one profile, mm
};

/// The marks that overlapping passes leave on a face.
struct FaceWaviness {
    std::uint32_t face = 0;                        ///< from 0
    double pass_distance = 0.0;                    ///< mm, median across the feed; 0: not known
    double short_cutoff = 0.0;                     ///< mm; shorter waves are not counted
    double long_cutoff = 0.0;                      ///< mm; longer ones are form
    std::optional<WavinessFigures> along, across;  ///< the feed; none: it cannot be told
    /// Why something cannot be told: "no_trace", "no_passes" (too few beside each other),
    /// "too_coarse" (samples), "too_short" (profiles); empty otherwise.
    std::string reason;
};

/// Waviness of each face's deviation along and across the feed, on profiles through samples that
/// are spread over the face: sections of the surface by planes through the normal and the feed (or
/// across it), as far as the wheel was there and the feed keeps its direction within 30 degrees.
/// The feed at a sample is the travel of its dominant motion. The pass distance is the median width
/// of what neighbouring passes were the last on; the cutoffs are a fifth of it (three sample
/// spacings at least) and 2.5 times it. Half of the long cutoff is left away at each end of a
/// profile. `ends`: of all motions, by number. Does not depend on the number of threads.
std::vector<FaceWaviness> waviness(const HeightField& field, const std::vector<MotionEnd>& ends,
                                   const RunContext& context = {});

}  // namespace beltgrinding

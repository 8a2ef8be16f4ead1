#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "beltgrinding/height_field.h"

namespace beltgrinding {

/// Tolerance band around the design surface, mm: lower <= deviation <= upper is good.
struct Tolerance {
    double lower = -0.05;  ///< mm
    double upper = 0.05;   ///< mm
};

/// Area-weighted statistics of the deviation (current height), mm. Missed samples are left out and
/// counted.
struct DeviationStatistics {
    double min = 0;                 ///< smallest
    double max = 0;                 ///< largest
    double mean = 0;                ///< by area
    double rms = 0;                 ///< root of the mean square
    double p05 = 0;                 ///< 5 % of the area lie below
    double p50 = 0;                 ///< half of the area lies below
    double p95 = 0;                 ///< 95 % of the area lie below
    double in_tolerance_share = 0;  ///< share of the inspected area
    double above_share = 0;         ///< share with too much left
    double below_share = 0;         ///< share cut too deep
    double design_area = 0;         ///< mm2, all samples
    double stock_volume = 0;        ///< mm3 above the design before grinding
    double removed_volume = 0;      ///< mm3
    double sd_mean = 0;             ///< of the deviation's standard deviation, where it is known
    double sd_p95 = 0;              ///< 95 % of the area lie below
    double expected_in_tolerance_share = 0;  ///< mean probability of lying in the band
    std::size_t samples = 0;                 ///< all
    std::size_t missed = 0;                  ///< whose rays met no stock
    std::size_t defective = 0;               ///< whose stock lay below the design
};

/// Of all samples. Throws InputError for an invalid band.
DeviationStatistics deviation_statistics(const HeightField& field, const Tolerance& tolerance);

/// Colours that say the verdict and are told apart by colour-blind people: one calm colour inside
/// the band, a ramp above it and another below it, up to `limit` mm; missed samples in their own
/// grey.
struct ColourScale {
    /// Colours of one's own, 0xRRGGBBAA: a ramp runs from a light tint of its colour to a dark
    /// shade.
    struct Choice {
        std::uint32_t good;   ///< in tolerance
        std::uint32_t above;  ///< too much is left
        std::uint32_t below;  ///< cut too deep
    };

    Tolerance tolerance;                ///< mm, what is good
    double limit = 0.5;                 ///< mm, deviation at which the ramps end
    int bands = 0;                      ///< equal steps of each ramp; 0: without steps
    std::optional<Choice> choice = {};  ///< none: the colours described above

    /// Throws InputError unless the tolerance is a band.
    void validate() const;
    /// 0xRRGGBBAA (alpha 255: opaque).
    std::uint32_t colour(double deviation) const;
    /// Of samples whose rays met no stock.
    std::uint32_t missed_colour() const;
};

/// Colour of a standard deviation, light to dark up to `limit` mm: 0xRRGGBBAA.
std::uint32_t uncertainty_colour(double sd, double limit);

/// One packed colour per sample of its standard deviation. Throws InputError if it is not known.
std::vector<std::uint32_t> uncertainty_colours(const HeightField& field, double limit);

/// One packed colour 0xRRGGBBAA per sample.
std::vector<std::uint32_t> deviation_colours(const HeightField& field, const ColourScale& scale);

}  // namespace beltgrinding

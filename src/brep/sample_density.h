#pragma once

// Private to this room: how dense samples must lie by the curvature of the surface.

#include <atomic>
#include <cstddef>

namespace beltgrinding {

/// What is asked of the samples of curved places. Chords of length d on a radius R bulge by
/// d^2 / (8 R). Nothing is asked where both `precision` and `finest` are 0.
struct SampleDensity {
    double spacing = 0;    ///< mm, the largest
    double precision = 0;  ///< mm, by which chords may bulge; 0: normals turn by kTurn at most
    double finest = 0;     ///< mm, the least spacing; 0: a kFinestShare-th of `spacing`

    static constexpr double kTurn = 0.25;          // rad from sample to sample
    static constexpr double kFinestShare = 0.025;  // of the spacing

    bool active() const { return precision > 0 || finest > 0; }
    double least() const;
    /// Spacing in mm along a direction of that normal curvature, 1/mm.
    double at(double curvature) const;
};

/// Samples that all faces of a run may still take.
struct SampleBudget {
    std::atomic<std::size_t> taken{0};
    std::size_t limit = 0;

    /// Throws InputError where `count` more are too many.
    void take(std::size_t count);
};

}  // namespace beltgrinding

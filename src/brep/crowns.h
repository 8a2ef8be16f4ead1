#pragma once

// Private to this room: convex places that are too sharp for the samples on them.

#include <cstddef>

#include "face_sampler.h"

namespace beltgrinding {

/// Convex crowns that samples pass over from one side to the other.
struct Crowns {
    std::size_t edges = 0;  ///< between samples that turn by too much
    /// mm between samples that show the sharpest of them, by its radius: normals then turn by
    /// `SampleDensity::kTurn` from sample to sample. Never less than a `kFinestShare`-th of
    /// `spacing`, never more than it.
    double spacing = 0.0;
};

/// Those that turn by more than `most_turn` rad from one sample to the next, where neither has
/// another nearer across the crown.
Crowns hidden_crowns(const FaceSamples& samples, double spacing, double most_turn);

}  // namespace beltgrinding

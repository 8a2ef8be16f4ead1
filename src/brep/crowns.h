#pragma once

// Private to this room: convex places that are too sharp for the samples on them.

#include "face_sampler.h"

namespace beltgrinding {

/// mm between samples that show the sharpest convex crown which `samples` pass over from one side
/// to the other, by its radius: normals then turn by `SampleDensity::kTurn` from sample to sample.
/// 0 where no crown turns by more than `most_turn` rad from one sample to the next. Never less than
/// a `kFinestShare`-th of `spacing`.
double crown_spacing(const FaceSamples& samples, double spacing, double most_turn);

}  // namespace beltgrinding

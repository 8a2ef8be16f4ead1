#pragma once

#include <cstddef>
#include <cstdint>

namespace beltgrinding {

// Rows of 16 modes, eight at a time: the same bits on all processors (base/lanes.h).

/// What lies between nodes, as of `Conduction`.
struct HeatWays {
    std::size_t nodes;
    const std::uint32_t *first, *neighbour;
    const float *rate, *mean_rate;
};

/// A stage of a Runge-Kutta-Legendre method: next = a now + b before + c L now, by rows; L the sum
/// of rate times difference over a node's ways. `next` may be `before`.
void conduct_stage(const HeatWays& ways, const float* now, const float* before, float* next,
                   float a, float b, float c);

/// row = row decay + (own flux + other other_flux) gain
void heat_row(float* row, const float* decay, const float* gain, const float* own, float flux,
              const float* other, float other_flux);
/// row = row decay
void decay_row(float* row, const float* decay);

}  // namespace beltgrinding

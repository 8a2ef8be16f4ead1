#pragma once

#include <cstddef>
#include <cstdint>

namespace beltgrinding {

// Rows of 16 modes, eight at a time: the same bits on all processors (base/lanes.h).

/// From a node to another.
struct HeatWay {
    std::uint32_t other;
    /// What a K of difference does, 1/s; to the first mode, by the sections' thickness.
    float rate, mean_rate;
};
/// What lies between nodes, as of `HeatPatch`.
struct HeatWays {
    std::size_t nodes;
    const std::uint32_t* first;
    const HeatWay* ways;
    const std::uint8_t* slow;
};
/// Factors of a stage: next = now now + before before + rows rows + change L now.
struct HeatStage {
    double now, before, rows, change;
};

/// A stage, by rows; L the sum of rate times difference over a node's ways. `next` may be `before`.
/// The faster half of the modes of slow nodes becomes 0.
void conduct_stage(const HeatWays& ways, const HeatStage& stage, const float* now,
                   const float* before, const float* rows, float* next);
/// The sum of each row.
void sum_rows(const float* rows, std::size_t count, float* sums);
/// row += (own flux + other other_flux) gain
void heat_row(float* row, const float* gain, const float* own, float flux, const float* other,
              float other_flux);
/// row = row decay. The greatest of the faster half is told.
float decay_row(float* row, const float* decay);
/// All of `count` rows.
void decay_rows(float* rows, std::size_t count, const float* decay);
/// The greatest magnitude.
float greatest_of_row(const float* row);
float sum_of_row(const float* row);
/// The same of row decay.
float sum_of_row(const float* row, const float* decay);

}  // namespace beltgrinding

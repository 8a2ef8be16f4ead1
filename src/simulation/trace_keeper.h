#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/height_field.h"
#include "contact/gap_map.h"

namespace beltgrinding {

/// Keeps a removal trace during a simulation: beside the field, which gets it in the end. The
/// dominant motion is exact, because the steps of a motion follow one another: a sum per sample of
/// what the running motion removed is all that it takes.
class TraceKeeper {
  public:
    /// Goes on with the field's trace, if it has one.
    explicit TraceKeeper(const SampleBlocks& blocks);

    /// The wheel presses with `pressure` (MPa per cell of the map).
    void press(const GapMap& map, const DisplacedPressure& pressure) {
        map.raise(pressure, trace_.peak_pressure);
    }
    /// The motion number `motion` has lowered samples to the heights that they have now. Motions
    /// come one after the other.
    void remove(std::span<const SampleBlocks::Change> changes, std::uint32_t motion);
    /// A block's trace where a motion begins: what the one before removed is no longer asked for.
    struct Block {
        std::array<std::uint32_t, SampleBlocks::kLanes> first, last, dominant;
        std::array<float, SampleBlocks::kLanes> dominant_depth, peak_pressure;
    };
    Block block(std::uint32_t number) const;
    /// Makes a block's trace what it was; its heights are those that it has now.
    void restore(std::uint32_t number, const Block& block);
    /// Hands the trace over to the field.
    void keep(HeightField& field) const;

  private:
    const SampleBlocks& blocks_;
    RemovalTrace trace_;          // by position, whole blocks
    std::vector<double> height_;  // mm, as of the last `remove`
    std::vector<float> removed_;  // mm, by the sample's last motion so far
};

}  // namespace beltgrinding

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
/// what the running motion removed, of the blocks that it has changed, is all that it takes.
class TraceKeeper {
  public:
    /// Goes on with the field's trace, if it has one.
    explicit TraceKeeper(const SampleBlocks& blocks);

    /// The wheel presses with `pressure` (MPa per cell of the map).
    void press(const GapMap& map, const DisplacedPressure& pressure) {
        map.raise(pressure, trace_.peak_pressure);
    }
    /// The motion number `motion` has lowered samples by what the blocks have changed. Motions come
    /// one after the other.
    void remove(std::span<const SampleBlocks::Change> changes, std::uint32_t motion);
    /// A block's trace where a motion begins: what the one before removed is no longer asked for.
    struct Block {
        std::array<std::uint32_t, SampleBlocks::kLanes> first, last, dominant;
        std::array<float, SampleBlocks::kLanes> dominant_depth, peak_pressure;
    };
    Block block(std::uint32_t number) const;
    /// Makes a block's trace what it was.
    void restore(std::uint32_t number, const Block& block);
    /// Nothing comes any more. The only one of these that may fail at the end.
    void end();
    /// Hands the trace over to the field, once it has ended.
    void keep(HeightField& field) noexcept;

  private:
    using Depths = std::array<float, SampleBlocks::kLanes>;  // mm

    Depths& removed_of(std::uint32_t block);

    const SampleBlocks& blocks_;
    RemovalTrace trace_;                    // by position, whole blocks; by sample, once ended
    std::uint32_t motion_ = 0;              // the running one
    std::vector<std::uint32_t> changed_;    // blocks that it has changed, in the order they came
    std::vector<Depths> removed_;           // by it, of these
    std::vector<std::uint32_t> its_place_;  // in these, by block; kNone
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
};

}  // namespace beltgrinding

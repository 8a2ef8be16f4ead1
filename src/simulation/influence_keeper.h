#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/simulation.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// Collects an influence during a simulation, whose motions come one after the other.
class InfluenceKeeper {
  public:
    /// `heights`: mm (samples), before the first motion.
    explicit InfluenceKeeper(const std::vector<double>& heights)
        : height_(heights), removed_(heights.size(), 0.0) {}
    /// For `add` alone, on a field of so many samples.
    explicit InfluenceKeeper(std::size_t samples) : removed_(samples, 0.0) {}

    /// The motion number `motion` has lowered samples to the heights that they have now.
    void remove(const SampleBlocks& blocks, std::span<const SampleBlocks::Change> changes,
                std::uint32_t motion);
    /// The motion number `motion` has `amount` mm at a sample.
    void add(std::uint32_t sample, double amount, std::uint32_t motion);
    /// What has been collected, of `motions` in all. Call once.
    Influence take(std::size_t motions);

  private:
    void begin(std::uint32_t motion);
    void close(std::size_t motion);

    Influence influence_;
    std::vector<double> height_;          // mm, as of the last `remove`
    std::vector<double> removed_;         // mm, by the running motion
    std::vector<std::uint32_t> touched_;  // by the running motion
    std::uint32_t motion_ = 0;
};

}  // namespace beltgrinding

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
    /// On a field of so many samples.
    explicit InfluenceKeeper(std::size_t samples) : removed_(samples, 0.0) {}

    /// The motion number `motion` has lowered samples by what the blocks have changed.
    void remove(const SampleBlocks& blocks, std::span<const SampleBlocks::Change> changes,
                std::uint32_t motion);
    /// The motion number `motion` has `amount` mm at a sample.
    void add(std::uint32_t sample, double amount, std::uint32_t motion);
    /// What has been collected since an earlier part, and the running motion as of now.
    struct Part {
        std::vector<std::size_t> first;  // as of `Influence`, from its begin
        std::vector<std::uint32_t> sample;
        std::vector<float> depth;  // mm
        std::uint32_t motion = 0;
        std::vector<std::uint32_t> touched;
        std::vector<double> removed;  // mm, of those

        /// Goes on with the part after this one.
        void append(const Part& next);
        std::size_t bytes() const;
    };
    /// The part since the last call; from the begin, the first time.
    Part next_part();
    /// Goes on with what such a call gave; in the same order, before anything else.
    void restore(const Part& part);
    /// What has been collected, of `motions` in all. Call once.
    Influence take(std::size_t motions);

  private:
    void begin(std::uint32_t motion);
    void close(std::size_t motion);

    Influence influence_;
    std::vector<double> removed_;         // mm, by the running motion
    std::vector<std::uint32_t> touched_;  // by the running motion
    std::uint32_t motion_ = 0;
    std::size_t given_first_ = 1, given_entries_ = 0;  // by `next_part`
};

}  // namespace beltgrinding

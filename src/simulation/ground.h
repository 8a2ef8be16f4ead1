#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/state.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// What was ground off blocks of samples.
struct GroundPart {
    Since<SampleBlocks::Deepened> deepened;
    ByBlock<SampleBlocks::Ground> ground;

    void append(const GroundPart& next) {
        deepened.append(next.deepened);
        ground.append(next.ground);
    }
    std::size_t bytes() const { return deepened.bytes() + ground.bytes(); }
};

/// The heights of a simulation.
class Ground final : public Keeps<GroundPart> {
  public:
    /// `first_motion`: as of OutputRequest. `blocks` must outlive it.
    Ground(SampleBlocks& blocks, std::uint32_t first_motion)
        : blocks_(blocks), first_motion_(first_motion) {}

    std::string kind() const override {
        return std::to_string(blocks_.field().size()) + " samples from motion " +
               std::to_string(first_motion_);
    }

  private:
    GroundPart take(std::span<const std::uint32_t> blocks) override {
        const auto deepened = blocks_.deepened().subspan(deepened_);
        deepened_ = blocks_.deepened().size();
        return {{{deepened.begin(), deepened.end()}},
                {blocks, [this](std::uint32_t block) { return blocks_.ground(block); }}};
    }
    void put(std::span<const GroundPart* const> parts) override {
        for (const GroundPart* part : parts) {
            for (const auto& deepened : part->deepened.values) blocks_.deepen(deepened);
            part->ground.each([this](std::uint32_t, const SampleBlocks::Ground& ground) {
                blocks_.restore(ground);
            });
        }
        deepened_ = blocks_.deepened().size();
    }

    SampleBlocks& blocks_;
    std::uint32_t first_motion_;
    std::size_t deepened_ = 0;  // in snapshots
};

}  // namespace beltgrinding

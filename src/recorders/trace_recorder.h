#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "beltgrinding/height_field.h"
#include "engine/recorder.h"

namespace beltgrinding {

/// A block's trace where a motion begins: what the one before removed is no longer asked for.
struct TracedBlock {
    std::array<std::uint32_t, SampleBlocks::kLanes> first, last, dominant;
    std::array<float, SampleBlocks::kLanes> dominant_depth, peak_pressure;
};

/// Keeps a removal trace during a simulation: beside the field, which gets it in the end. The
/// dominant motion is exact, because the steps of a motion follow one another: a sum per sample of
/// what the running motion removed, of the blocks that it has changed, is all that it takes.
class TraceRecorder final : public Keeps<ByBlock<TracedBlock>, Recorder> {
  public:
    /// Goes on with the field's trace, if it has one.
    explicit TraceRecorder(const SampleBlocks& blocks);

    std::string kind() const override { return "trace"; }
    void pressed(const Press& press) override;
    void end_step(const StepEnd& end) override;
    void end() override;
    void keep(HeightField& field, SimulationResult&) override;

  private:
    ByBlock<TracedBlock> take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const ByBlock<TracedBlock>* const> parts) override;

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

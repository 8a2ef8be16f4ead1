#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"

namespace beltgrinding {

/// What a pass has of a step that is its last one.
struct FinishStep {
    float begins, ends;  // mm of the wheel's way
    float fresh;         // um, Ra at the reference pressure
    Vec3f along;         // unit, of the belt's surface over the work
    std::uint32_t motion;
    std::uint8_t outside;  // of all but the pressure
};

/// The pass that goes on over a sample.
struct FinishPass {
    float impulse = 0.0f;  // MPa s
    float time = 0.0f;     // s
    std::uint32_t step = 0;
};

/// A block's passes and what they have left.
struct FinishBlock {
    static constexpr std::size_t kLanes = SampleBlocks::kLanes;
    std::array<FinishPass, kLanes> pass;
    std::array<float, kLanes> settled, unknown, crossing;
    std::array<Vec3f, kLanes> lay;
    std::array<std::uint32_t, kLanes> passes, motion;
    std::array<std::uint8_t, kLanes> outside;
};

/// What goes on from step to step.
struct FinishPart {
    ByBlock<FinishBlock> blocks;
    Since<FinishStep> steps;
    // As of now.
    bool any = false;
    PathStep now;
    std::uint32_t motion = 0;
    double travel = 0.0;          // mm
    Vec3 advance = Vec3::Zero();  // mm/s

    std::size_t bytes() const { return sizeof(FinishPart) + blocks.bytes() + steps.bytes(); }
    void append(const FinishPart& next);
};

/// Keeps what finish the passes of a simulation leave: beside the field, which gets it in the end.
/// A pass over a sample lasts while the wheel presses it; it ends where the wheel has gone on by
/// some mm without, or has been away, or with the program.
class FinishRecorder final : public Keeps<FinishPart, Recorder> {
  public:
    /// Goes on with the field's finish, if it has one. `max_travel`: mm, of a step. `blocks` and
    /// `request` must outlive it. Throws InputError where the field's finish is of another one.
    FinishRecorder(const SampleBlocks& blocks, const FinishRequest& request, double belt_speed,
                   double max_travel);

    std::string kind() const override { return "finish"; }
    void begin_step(const StepTurn& turn) override;
    void pressed(const Press& press) override;
    void end() override;
    void keep(HeightField& field, SimulationResult&) override;

  private:
    FinishPart take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const FinishPart* const> parts) override;
    FinishBlock block(std::uint32_t number) const;
    void set_block(std::uint32_t number, const FinishBlock& block);
    template <class Visit>
    void for_lanes(std::uint32_t block, Visit visit) const;
    void end(std::size_t position, FinishPass& pass);

    const SampleBlocks& blocks_;
    const FinishRequest& request_;
    double belt_speed_, most_apart_;  // mm/s; mm
    FinishTrace finish_;              // by position
    std::vector<FinishPass> passes_;  // by position
    std::vector<FinishStep> steps_;
    std::size_t noted_ = 0;  // of them: in a part
    bool any_ = false;
    PathStep now_;
    std::uint32_t motion_ = 0;
    double travel_ = 0.0;          // mm, at the step's end
    Vec3 advance_ = Vec3::Zero();  // mm/s, of the wheel over the work
};

}  // namespace beltgrinding

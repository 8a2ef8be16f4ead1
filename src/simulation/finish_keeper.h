#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "beltgrinding/simulation.h"
#include "contact/gap_map.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// Keeps what finish the passes of a simulation leave: beside the field, which gets it in the end.
/// A pass over a sample lasts while the wheel presses it; it ends where the wheel has gone on by
/// some mm without, or has been away, or with the program.
class FinishKeeper {
  public:
    /// Goes on with the field's finish, if it has one. `max_travel`: mm, of a step. `blocks` and
    /// `request` must outlive it. Throws InputError where the field's finish is of another one.
    FinishKeeper(const SampleBlocks& blocks, const FinishRequest& request, double belt_speed,
                 double max_travel);

    /// From here on the wheel is at this step, of the motion number `motion`.
    void begin_step(const PathStep& step, std::uint32_t motion);
    /// The wheel presses with `pressure` for `duration` s of the step; `cut`: share of a fresh
    /// belt's that remains.
    void press(const GapMap& map, const DisplacedPressure& pressure, double duration, double cut);
    /// Ends all passes and hands the finish over to the field.
    void keep(HeightField& field);

    /// What a pass has of a step that is its last one.
    struct Step {
        float begins, ends;  // mm of the wheel's way
        float fresh;         // um, Ra at the reference pressure
        Vec3f along;         // unit, of the belt's surface over the work
        std::uint32_t motion;
        std::uint8_t outside;  // of all but the pressure
    };
    /// The pass that goes on over a sample.
    struct Pass {
        float impulse = 0.0f;  // MPa s
        float time = 0.0f;     // s
        std::uint32_t step = 0;
    };
    /// A block's passes and what they have left.
    struct Block {
        static constexpr std::size_t kLanes = SampleBlocks::kLanes;
        std::array<Pass, kLanes> pass;
        std::array<float, kLanes> settled, unknown, crossing;
        std::array<Vec3f, kLanes> lay;
        std::array<std::uint32_t, kLanes> passes, motion;
        std::array<std::uint8_t, kLanes> outside;
    };
    Block block(std::uint32_t number) const;
    void restore(std::uint32_t number, const Block& block);
    /// What goes on from step to step, but the blocks.
    struct Part {
        std::vector<Step> steps;  // since the one before
        // As of now.
        bool any = false;
        PathStep now;
        std::uint32_t motion = 0;
        double travel = 0.0;          // mm
        Vec3 advance = Vec3::Zero();  // mm/s

        std::size_t bytes() const { return sizeof(Part) + steps.size() * sizeof(Step); }
        /// Becomes both in one; `next` is the one after it.
        void append(const Part& next);
    };
    /// Since the last call, or the beginning.
    Part next_part();
    /// The parts come in their order.
    void restore(const Part& part);

  private:
    template <class Visit>
    void for_lanes(std::uint32_t block, Visit visit) const;
    void end(std::size_t position, Pass& pass);

    const SampleBlocks& blocks_;
    const FinishRequest& request_;
    double belt_speed_, most_apart_;  // mm/s; mm
    FinishTrace finish_;              // by position
    std::vector<Pass> passes_;        // by position
    std::vector<Step> steps_;
    std::size_t noted_ = 0;  // of them: in a part
    bool any_ = false;
    PathStep now_;
    std::uint32_t motion_ = 0;
    double travel_ = 0.0;          // mm, at the step's end
    Vec3 advance_ = Vec3::Zero();  // mm/s, of the wheel over the work
};

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "actuated_wheel.h"
#include "beltgrinding/simulation.h"
#include "finish_keeper.h"
#include "heat_keeper.h"
#include "influence_keeper.h"
#include "pressing.h"
#include "trace_keeper.h"

namespace beltgrinding {

/// The law at work under the pressed wheel: lowers the field, and counts what the belt has done.
class Grinding {
  public:
    /// All of them must outlive it. `trace`, `heat` and `finish` may be null.
    Grinding(SampleBlocks& blocks, Pressing& pressing, const RemovalLaw& law,
             const SimulationOptions& options, TraceKeeper* trace, HeatKeeper* heat = nullptr,
             FinishKeeper* finish = nullptr);

    /// Tells a belt, before it is pressed, how much of the surface the law takes under its pressure
    /// in `duration` s: about as much as at the last pose.
    void expect(const PathStep& step, double duration);
    /// mm that the law takes during one step at the wheel's deepest place as it is pressed now, if
    /// the wheel follows the surface; one that stands cannot grind deeper than it stands: 0.
    double removal(const PathStep& step);
    /// Removes what the law says during one step, in as many parts as the pressure needs to follow.
    /// After `removal`, for the wheel as it is pressed then. `share`: of a planned step, which has
    /// a number of parts. Returns the volume, mm3.
    double grind(const PathStep& step, double share);

    /// The same under a force control that takes time, with a wheel that moves: after its `look`.
    double grind(const PathStep& step, double share, ActuatedWheel& wheel);

    /// mm, where the wheel stood deepest in the last step that was ground, from its programmed
    /// pose.
    double deepest() const { return deepest_; }
    const BeltState& belt() const { return belt_; }
    /// mm3, time integral of the law's rate so far.
    double integrated_rate() const { return integrated_rate_; }
    /// N s, time integral of the force in the last step that was ground.
    double impulse() const { return impulse_; }
    /// N, the greatest force in the last step that was ground.
    double greatest_force() const { return greatest_force_; }
    /// Hands over `SimulationResult::shifts`.
    Eigen::ArrayXXd take_shifts() { return std::move(shifts_); }
    /// Hands over `SimulationResult::force_influence`, of so many motions.
    Influence take_force_influence(std::size_t motions);
    /// From here on the blocks that may be ground, or pressed, are added to a set that outlives it.
    void watch(BlockSet& reached) { reached_ = &reached; }
    /// What it has counted, and collected since an earlier part.
    struct Part {
        BeltState belt;
        double integrated_rate = 0.0;  // mm3
        InfluenceKeeper::Part force_influence;
    };
    Part next_part();
    /// As `InfluenceKeeper::restore`.
    void restore(const Part& part);
    /// Of the positions of blocks: (64 a block, shifted laws), mm.
    Eigen::ArrayXXd shifts(const std::vector<std::uint32_t>& blocks) const;
    void restore_shifts(const std::vector<std::uint32_t>& blocks, const Eigen::ArrayXXd& shifts);
    /// s of wall time for removal and trace so far.
    const PhaseTimes& times() const { return times_; }

  private:
    /// mm/s where the law takes most, under the wheel as it is pressed.
    double set_rate(const PathStep& step);
    /// Notes what more force would have removed more in the `part` s that were just ground.
    void note_force(double part);
    /// The rates of a law at the current contact.
    void set_rate(const RemovalLaw& law, Eigen::ArrayXd& rate, Eigen::ArrayXd& beside);
    double cut_all(const PathStep& step);
    /// s for which the pressure holds while the surface recedes, at least `least`, at most `left`.
    double holds(double left, double least) const;
    /// Removes for `part` s what the law says of the wheel as it is pressed. Returns the volume,
    /// mm3.
    double remove(double part);
    void follow_trace();
    void note_reach() {
        if (reached_ != nullptr) reached_->add(pressing_.in_reach());
    }
    template <class Visit>
    void for_shifts(const std::vector<std::uint32_t>& blocks, Visit visit) const;
    /// False if the wheel has lost the work.
    bool press_again(const PathStep& step);

    SampleBlocks& blocks_;
    Pressing& pressing_;
    const RemovalLaw& law_;
    const ProcessSettings& process_;
    const OutputRequest& outputs_;
    TraceKeeper* trace_;
    BlockSet* reached_ = nullptr;
    HeatKeeper* heat_;
    FinishKeeper* finish_;
    BeltState belt_;
    double integrated_rate_ = 0.0;
    double impulse_ = 0.0;         // N s
    double greatest_force_ = 0.0;  // N
    Eigen::ArrayXXd shifts_;
    ProcessState state_;                      // of the wheel as pressed
    double fastest_ = 0.0;                    // mm/s, the largest of `rate_`
    double deepest_ = 0.0;                    // mm
    Eigen::ArrayXd rate_, shifted_;           // mm/s per cell
    Eigen::ArrayXd beside_, shifted_beside_;  // mm/s beyond the side faces, as DisplacedPressure's
    std::optional<InfluenceKeeper> force_influence_;
    std::uint32_t motion_ = 0;                 // of the running step
    Eigen::ArrayXd pressed_, pressed_beside_;  // as `rate_` and `beside_`, with more force
    PhaseTimes times_;
};

}  // namespace beltgrinding

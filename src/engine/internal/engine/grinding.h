#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/pressing.h"
#include "engine/recorder.h"
#include "engine/state.h"

namespace beltgrinding {

class ActuatedWheel;

/// The law's rates under a pressure, mm/s: by cell, and beyond the side faces as the pressure's.
void rate_under(const RemovalLaw& law, const DisplacedPressure& pressure, const ProcessState& state,
                Eigen::ArrayXd& rate, Eigen::ArrayXd& beside);

/// What has been ground so far.
struct GrindingMemory {
    BeltState belt;
    double integrated_rate = 0.0;  // mm3
    double clock = 0.0;  // s since the program began, up to which the belt's loading is known
};

/// The law at work under the pressed wheel: lowers the field, and counts what the belt has done.
class Grinding final : public Keeps<Latest<GrindingMemory>> {
  public:
    /// All of them must outlive it. `tolerance`: relative, of the pressure, also while the surface
    /// recedes under it. It tells the recorders what is pressed and removed.
    Grinding(SampleBlocks& blocks, Pressing& pressing, const RemovalLaw& law,
             const ProcessSettings& process, double tolerance, Recorders& recorders);

    /// Tells what is pressed next, before it is, how much of the surface the law takes under its
    /// pressure in `duration` s, or a wheel, in half of that: so its pressure is that on the
    /// surface as it is at the middle of the time. About as much as at the last pose.
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

    /// The belt has run free since it was last in contact, until `time` s of the program.
    void rest_until(double time) { rest(time - now_.clock); }

    /// mm, where the wheel stood deepest in the last step that was ground, from its programmed
    /// pose.
    double deepest() const { return deepest_; }
    const BeltState& belt() const { return now_.belt; }
    /// mm3, time integral of the law's rate so far.
    double integrated_rate() const { return now_.integrated_rate; }
    /// N s, time integral of the force in the last step that was ground.
    double impulse() const { return impulse_; }
    /// N, the greatest force in the last step that was ground.
    double greatest_force() const { return greatest_force_; }
    /// From here on the blocks that may be ground, or pressed, are added to a set that outlives it.
    void watch(BlockSet& reached) { reached_ = &reached; }
    /// s of wall time for removal so far.
    const PhaseTimes& times() const { return times_; }
    std::string kind() const override { return "grinding"; }

  private:
    Latest<GrindingMemory> take(std::span<const std::uint32_t>) override { return {now_}; }
    void put(std::span<const Latest<GrindingMemory>* const> parts) override {
        if (!parts.empty()) now_ = parts.back()->value;
    }

    /// mm/s where the law takes most, under the wheel as it is pressed.
    double set_rate(const PathStep& step);
    double cut_all(const PathStep& step);
    /// s for which the pressure holds while the surface recedes, at least `least`, at most `left`.
    double holds(double left, double least) const;
    /// Removes for `part` s what the law says of the wheel as it is pressed. Returns the volume,
    /// mm3.
    double remove(const PathStep& step, double part);
    /// What the unloaded belt and the mean cut of the loading one would remove in `part` s: the
    /// belt as it is, its loading that of the mean. Sets the rates to it.
    BeltState load(double part);
    void rest(double seconds);
    void note_reach() {
        if (reached_ != nullptr) reached_->add(pressing_.in_reach());
    }
    /// False if the wheel has lost the work.
    bool press_again(const PathStep& step);

    SampleBlocks& blocks_;
    Pressing& pressing_;
    const RemovalLaw& law_;
    const ProcessSettings& process_;
    Recorders& recorders_;
    double recession_;  // share of the wheel's indentation by which it may recede in one go
    BlockSet* reached_ = nullptr;
    GrindingMemory now_;
    double impulse_ = 0.0;         // N s
    double greatest_force_ = 0.0;  // N
    ProcessState state_;           // of the wheel as pressed
    double fastest_ = 0.0;         // mm/s, the largest of `rate_`
    double deepest_ = 0.0;         // mm
    Eigen::ArrayXd rate_;          // mm/s per cell
    Eigen::ArrayXd beside_;        // mm/s beyond the side faces, as DisplacedPressure's
    PhaseTimes times_;
};

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/stopwatch.h"
#include "beltgrinding/simulation_options.h"
#include "engine/pressing.h"
#include "engine/state.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// A step that has its turn.
struct StepTurn {
    const PathStep& step;
    std::uint32_t motion;  ///< its number, with those of the paths before
    const Pressing& pressing;
};

/// The wheel touches at the step's begin; nothing is removed yet.
struct Touch {
    const Pressing& pressing;
    Pressing::State state;
    const BeltState& belt;  ///< what it has done
    double removal;         ///< mm that the law takes in the step, where the wheel is deepest
    double most;            ///< mm of it that a step should take
    int parts;              ///< that the planned step was cut into
};

/// The wheel presses for a part of a step.
struct Press {
    const Pressing& pressing;
    double duration;  ///< s
    double cut;       ///< share of a fresh belt's that remains
};

/// What was removed in such a part.
struct Removal {
    Pressing& pressing;  ///< as pressed before
    const ProcessState& state;
    const Eigen::ArrayXd& rate;    ///< mm/s per cell
    const Eigen::ArrayXd& beside;  ///< mm/s beyond the side faces
    const Eigen::ArrayXd& most;    ///< mm/s per cell, that was left to remove
    const Eigen::ArrayXd& most_beside;
    double duration;        ///< s
    const Sweep& sweep;     ///< of the step, of which `rate` is the mean
    double scale;           ///< of that mean, so that the volume is as at the step's middle
    const BeltState& belt;  ///< at its begin, but for the loading: of the mean cut over it

    /// Other rates at the step's middle as `rate` is, mm/s per cell.
    Eigen::ArrayXd mean(const Eigen::ArrayXd& at_middle) const {
        return scale * pressing.map().mean_over(sweep, at_middle);
    }
};

/// A step is over.
struct StepEnd {
    const PathStep& step;
    std::uint32_t motion;  ///< as of StepTurn
    const Pressing& pressing;
    Pressing::State state;        ///< at its begin
    bool ground;                  ///< the wheel touched, or may have
    bool moving;                  ///< under a force control that takes time
    double asked = 0.0;           ///< mm3 that the law takes
    double volume = 0.0;          ///< mm3 that were taken
    double impulse = 0.0;         ///< N s
    double greatest_force = 0.0;  ///< N
    double deepest = 0.0;         ///< mm, where the wheel stood deepest, from its programmed pose
    double bounce = 0.0;          ///< s, as of WheelControl
    std::span<const SampleBlocks::Change> changes = {};
};

/// Watches a simulation and keeps something of it. The engine knows recorders as a list, tells them
/// all in their order, and takes nothing back: the heights are the same without. It is made before
/// a simulation goes on from a checkpoint, and must keep to the blocks as they are from `begin` on.
class Recorder : public Stateful {
  public:
    using Phase = double PhaseTimes::*;

    /// Its time is counted to that phase.
    explicit Recorder(Phase phase) : phase_(phase) {}
    Phase phase() const { return phase_; }

    virtual void begin() {}
    virtual void begin_step(const StepTurn&) {}
    virtual void touched(const Touch&) {}
    virtual void pressed(const Press&) {}
    virtual void removed(const Removal&) {}
    virtual void end_step(const StepEnd&) {}
    /// Behind the last step: all that may fail.
    virtual void end() {}
    /// Hands over what it has kept.
    virtual void keep(HeightField&, SimulationResult&) {}

  private:
    Phase phase_;
};

/// All of a simulation.
class Recorders {
  public:
    void add(std::unique_ptr<Recorder> one) { all_.push_back(std::move(one)); }
    /// Calls the member on each.
    template <class... Parameters, class... Arguments>
    void tell(void (Recorder::*what)(Parameters...), Arguments&&... arguments) {
        for (const auto& one : all_) {
            const Stopwatch watch(times_.*one->phase());
            ((*one).*what)(arguments...);
        }
    }
    const std::vector<std::unique_ptr<Recorder>>& all() const { return all_; }
    /// s of wall time so far.
    const PhaseTimes& times() const { return times_; }

  private:
    std::vector<std::unique_ptr<Recorder>> all_;
    PhaseTimes times_;
};

}  // namespace beltgrinding

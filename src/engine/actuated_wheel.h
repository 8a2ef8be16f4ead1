#pragma once

#include "engine/wheel_control.h"
#include "force_actuator.h"

namespace beltgrinding {

/// How a wheel that takes time to be pressed stands between two steps.
struct ActuatedMemory {
    ForceActuator actuator;
    bool begun = false;
    double end = 0.0;      // s, of the last step
    double stiffness;      // N/mm, about that of the contact under the commanded force
    double seconds = 0.0;  // of the time step
    bool pressed = false;  // there was a contact in the last stage
    double off = -1.0;     // s since it was lost; negative: it was not
};

/// The wheel pressed by a force control that takes time: goes on with its place, its speed and the
/// regulator's force from step to step.
class ActuatedWheel final : public Keeps<Latest<ActuatedMemory>, WheelControl> {
  public:
    /// Both must outlive it.
    ActuatedWheel(const ProcessSettings& process, Pressing& pressing);

    /// It has a mass or a damping; else the force lags, and the wheel is where that is met.
    bool moves() const override { return process_.dynamics.moves(); }

    std::string kind() const override { return "actuated wheel"; }

    /// Presses the wheel at the step's pose as it stands. At the path's begin and after a rapid
    /// motion it rests where the force is met, else at its travel's end towards the work (away from
    /// it where no force is commanded), and the regulator has come to the step's force. Changes
    /// nothing that a second call would not find.
    Pressing::State look(const SampleBlocks& blocks, const PathStep& step) override;
    /// The step with the force that is met in it, if that only lags.
    PathStep lagging(const PathStep& step) const;
    /// Parts that the step that was looked at should be cut into, for the wheel to be followed: 1
    /// where it stands about still.
    double parts(const PathStep& step) const override;
    double grind(Grinding& grinding, const PathStep& step, double share) override;

    /// s, after which the wheel must be looked at anew: at most `left`.
    double longest(double left, double commanded) const;
    void begin(double seconds, double commanded);
    /// Solves the contact of the next stage. Returns the share of the time step in which its force
    /// acts.
    double press_stage(const SampleBlocks& blocks);
    void end(const PathStep& step) override;
    double bounce() const override { return bounce_; }

  private:
    Latest<ActuatedMemory> take(std::span<const std::uint32_t>) override { return {now_}; }
    void put(std::span<const Latest<ActuatedMemory>* const> parts) override {
        if (!parts.empty()) now_ = parts.back()->value;
    }
    /// Times the force that is tolerated, what the wheel is out of balance by.
    double unrest(double commanded) const;
    void learn_stiffness(double commanded);

    const ProcessSettings& process_;
    Pressing& pressing_;
    ActuatedMemory now_;
    double bounce_ = 0.0;  // of the step
};

}  // namespace beltgrinding

#pragma once

#include <memory>

#include "engine/grinding.h"
#include "engine/pressing.h"
#include "engine/state.h"

namespace beltgrinding {

/// What presses the wheel in a step, and moves it.
class WheelControl : public Stateful {
  public:
    /// Presses the wheel at the step's begin. Changes nothing that a second call would not find.
    virtual Pressing::State look(const SampleBlocks& blocks, const PathStep& step) = 0;
    /// Parts that the step that was looked at should be cut into, for the wheel to be followed.
    virtual double parts(const PathStep& step) const = 0;
    /// The wheel takes time to move: it may come to the work in a step that it begins off it.
    virtual bool moves() const = 0;
    /// Grinds the step that was looked at; as of `Grinding::grind`.
    virtual double grind(Grinding& grinding, const PathStep& step, double share) = 0;
    /// s for which the wheel was off the work when it came back to it in this step; 0: it did not,
    /// or sooner than it can answer.
    virtual double bounce() const = 0;
    /// The step is done, what it begins and ends with included.
    virtual void end(const PathStep& step) = 0;
};

/// The process's. Both must outlive it.
std::unique_ptr<WheelControl> make_wheel_control(const ProcessSettings& process,
                                                 Pressing& pressing);

}  // namespace beltgrinding

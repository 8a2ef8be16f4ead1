#include "actuated_wheel.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

// N/mm, until a contact was seen: only the steps' length depends on it.
constexpr double kFirstStiffness = 200.0;
// A force grows with the indentation like its power, 1 (a plane edge on) to 2 (a sphere on
// independent springs).
constexpr double kExponent = 1.5;
// Share of the force by which the wheel may be out of balance where it is not followed closely.
constexpr double kTolerated = 0.01;
// Time step times the wheel's quickness: an undamped oscillation is wrong by 1.8 % of its amplitude
// after two periods, a damped one by less (0.2 % at a third of the critical damping).
constexpr double kResolved = 0.2;
constexpr double kSameTime = 1e-9;    // s
constexpr double kLeastDepth = 1e-6;  // mm: less is rounding, and tells no stiffness

}  // namespace

ActuatedWheel::ActuatedWheel(const ProcessSettings& process, Pressing& pressing)
    : process_(process),
      pressing_(pressing),
      now_{.actuator = ForceActuator(process.dynamics, process.force_travel),
           .stiffness = kFirstStiffness} {}

void ActuatedWheel::learn_stiffness(double commanded) {
    const double force = pressing_.solution().force;
    const double depth = force > 0.0 ? pressing_.indentation() : 0.0;
    if (!(depth > kLeastDepth)) return;
    const double now = kExponent * force / depth;
    const double more = std::max(commanded, force) / force;
    now_.stiffness = now * std::pow(more, 1.0 - 1.0 / kExponent);
}

Pressing::State ActuatedWheel::look(const SampleBlocks& blocks, const PathStep& step) {
    const bool fresh = !now_.begun || step.time - 0.5 * step.duration > now_.end + kSameTime;
    if (fresh) {
        now_.off = -1.0;
        now_.pressed = false;
        const double travel = process_.force_travel;
        now_.actuator.rest(step.force > 0.0 ? travel : -travel, step.force);
    }
    bounce_ = 0.0;
    if (!moves()) return pressing_.press(blocks, step.work_from_contact, lagging(step).force);
    if (fresh) {
        const auto state = pressing_.press(blocks, step.work_from_contact, step.force);
        if (state != Pressing::State::kNoContact) {
            now_.actuator.rest(pressing_.approach(), step.force);
        }
    }
    pressing_.stand(step.work_from_contact);
    const auto state = pressing_.hold(blocks, now_.actuator.place(), 0.0);
    learn_stiffness(step.force);
    return now_.actuator.held_by_stop(pressing_.solution().force) ? pressing_.at_stop() : state;
}

PathStep ActuatedWheel::lagging(const PathStep& step) const {
    PathStep met = step;
    met.force = now_.actuator.mean_regulated(step.duration, step.force);
    return met;
}

double ActuatedWheel::unrest(double commanded) const {
    const double force = pressing_.solution().force;
    const double scale = kTolerated * std::max({commanded, now_.actuator.regulated(), force});
    if (!(scale > 0.0)) return 0.0;
    const double lagging = std::abs(commanded - now_.actuator.regulated());
    if (!moves() || now_.actuator.held_by_stop(force)) return lagging / scale;
    const double moving =
        now_.stiffness * std::abs(now_.actuator.speed()) / now_.actuator.quickness(now_.stiffness);
    return std::max({lagging, moving, std::abs(now_.actuator.regulated() - force)}) / scale;
}

double ActuatedWheel::parts(const PathStep& step) const {
    const double longest = this->longest(step.duration, step.force);
    return std::min(step.duration / longest, std::ceil(unrest(step.force)));
}

double ActuatedWheel::longest(double left, double commanded) const {
    if (!(unrest(commanded) > 1.0)) return left;
    double longest = left;
    if (moves()) longest = std::min(longest, kResolved / now_.actuator.quickness(now_.stiffness));
    const double lag = process_.dynamics.lag;
    const bool lagging = std::abs(commanded - now_.actuator.regulated()) > kTolerated * commanded;
    if (lag > 0.0 && lagging) longest = std::min(longest, kResolved * lag);
    return longest;
}

void ActuatedWheel::begin(double seconds, double commanded) {
    now_.seconds = seconds;
    now_.actuator.begin(seconds, commanded, now_.stiffness);
}

double ActuatedWheel::press_stage(const SampleBlocks& blocks) {
    const ForceActuator::Stage stage = now_.actuator.stage();
    pressing_.hold(blocks, stage.place, stage.give);
    if (const auto within = now_.actuator.limited(pressing_.approach())) {
        pressing_.hold(blocks, *within, 0.0);
        if (std::abs(*within) >= process_.force_travel) pressing_.at_stop();
        now_.actuator.end_stage(*within);
    } else {
        now_.actuator.end_stage(pressing_.approach());
    }
    const double time = stage.share * now_.seconds;
    const bool before = now_.pressed;
    learn_stiffness(now_.actuator.regulated());
    now_.pressed = pressing_.solution().force > 0.0;
    if (now_.pressed) {
        if (now_.off * now_.actuator.quickness(now_.stiffness) > 1.0)
            bounce_ = std::max(bounce_, now_.off);
        now_.off = -1.0;
    } else if (before) {
        now_.off = time;
    } else if (now_.off >= 0.0) {
        now_.off += time;
    }
    return stage.share;
}

void ActuatedWheel::end(const PathStep& step) {
    if (!moves()) now_.actuator.regulate(step.duration, step.force);
    now_.begun = true;
    now_.end = step.time + 0.5 * step.duration;
}

double ActuatedWheel::grind(Grinding& grinding, const PathStep& step, double share) {
    return moves() ? grinding.grind(step, share, *this) : grinding.grind(lagging(step), share);
}

}  // namespace beltgrinding

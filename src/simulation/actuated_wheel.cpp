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
constexpr double kSameTime = 1e-9;  // s

}  // namespace

ActuatedWheel::ActuatedWheel(const ProcessSettings& process, Pressing& pressing)
    : process_(process),
      pressing_(pressing),
      actuator_(process.dynamics, process.force_travel),
      stiffness_(kFirstStiffness) {}

void ActuatedWheel::learn_stiffness(double commanded) {
    const double force = pressing_.solution().force;
    const double depth = force > 0.0 ? pressing_.indentation() : 0.0;
    if (!(depth > 0.0)) return;
    const double now = kExponent * force / depth;
    const double more = std::max(commanded, force) / force;
    stiffness_ = now * std::pow(more, 1.0 - 1.0 / kExponent);
}

Pressing::State ActuatedWheel::look(const SampleBlocks& blocks, const PathStep& step) {
    const bool fresh = !begun_ || step.time - 0.5 * step.duration > end_ + kSameTime;
    if (fresh) {
        off_ = -1.0;
        pressed_ = false;
        const double travel = process_.force_travel;
        actuator_.rest(step.force > 0.0 ? travel : -travel, step.force);
    }
    bounce_ = 0.0;
    if (!moves()) return pressing_.press(blocks, step.work_from_contact, lagging(step).force);
    if (fresh) {
        const auto state = pressing_.press(blocks, step.work_from_contact, step.force);
        if (state != Pressing::State::kNoContact) {
            actuator_.rest(pressing_.approach(), step.force);
        }
    }
    pressing_.stand(step.work_from_contact);
    const auto state = pressing_.hold(blocks, actuator_.place(), 0.0);
    learn_stiffness(step.force);
    return actuator_.held_by_stop(pressing_.solution().force) ? pressing_.at_stop() : state;
}

PathStep ActuatedWheel::lagging(const PathStep& step) const {
    PathStep met = step;
    met.force = actuator_.mean_regulated(step.duration, step.force);
    return met;
}

double ActuatedWheel::unrest(double commanded) const {
    const double force = pressing_.solution().force;
    const double scale = kTolerated * std::max({commanded, actuator_.regulated(), force});
    if (!(scale > 0.0)) return 0.0;
    const double lagging = std::abs(commanded - actuator_.regulated());
    if (!moves() || actuator_.held_by_stop(force)) return lagging / scale;
    const double moving =
        stiffness_ * std::abs(actuator_.speed()) / actuator_.quickness(stiffness_);
    return std::max({lagging, moving, std::abs(actuator_.regulated() - force)}) / scale;
}

double ActuatedWheel::parts(const PathStep& step) const {
    const double longest = this->longest(step.duration, step.force);
    return std::min(step.duration / longest, std::ceil(unrest(step.force)));
}

double ActuatedWheel::longest(double left, double commanded) const {
    if (!(unrest(commanded) > 1.0)) return left;
    double longest = left;
    if (moves()) longest = std::min(longest, kResolved / actuator_.quickness(stiffness_));
    const double lag = process_.dynamics.lag;
    const bool lagging = std::abs(commanded - actuator_.regulated()) > kTolerated * commanded;
    if (lag > 0.0 && lagging) longest = std::min(longest, kResolved * lag);
    return longest;
}

void ActuatedWheel::begin(double seconds, double commanded) {
    seconds_ = seconds;
    actuator_.begin(seconds, commanded, stiffness_);
}

double ActuatedWheel::press_stage(const SampleBlocks& blocks) {
    const ForceActuator::Stage stage = actuator_.stage();
    pressing_.hold(blocks, stage.place, stage.give);
    if (const auto within = actuator_.limited(pressing_.approach())) {
        pressing_.hold(blocks, *within, 0.0);
        if (std::abs(*within) >= process_.force_travel) pressing_.at_stop();
        actuator_.end_stage(*within);
    } else {
        actuator_.end_stage(pressing_.approach());
    }
    const double time = stage.share * seconds_;
    const bool before = pressed_;
    learn_stiffness(actuator_.regulated());
    pressed_ = pressing_.solution().force > 0.0;
    if (pressed_) {
        if (off_ * actuator_.quickness(stiffness_) > 1.0) bounce_ = std::max(bounce_, off_);
        off_ = -1.0;
    } else if (before) {
        off_ = time;
    } else if (off_ >= 0.0) {
        off_ += time;
    }
    return stage.share;
}

void ActuatedWheel::end(const PathStep& step) {
    if (!moves()) actuator_.regulate(step.duration, step.force);
    begun_ = true;
    end_ = step.time + 0.5 * step.duration;
}

}  // namespace beltgrinding

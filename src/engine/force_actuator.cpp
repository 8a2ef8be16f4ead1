#include "force_actuator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beltgrinding {
namespace {

constexpr double kGamma = 1.0 - std::numbers::sqrt2 / 2.0;
// Times the contact's own: a wheel held by a softer spring stands where the force is met, and the
// contact's equations would only lose digits.
constexpr double kSoftest = 50.0;
constexpr double kSettled = 1e-3;  // N: nearer to the commanded force the regulator has come to it

}  // namespace

ForceActuator::ForceActuator(const ForceDynamics& dynamics, double travel)
    : dynamics_(dynamics), travel_(travel) {}

void ForceActuator::rest(double place, double force) {
    place_ = std::clamp(place, -travel_, travel_);
    speed_ = 0.0;
    regulated_ = force;
}

bool ForceActuator::held_by_stop(double force) const {
    if (place_ >= travel_) return regulated_ >= force;
    return place_ <= -travel_ && regulated_ <= force;
}

double ForceActuator::regulated_after(double seconds, double commanded) const {
    if (!(dynamics_.lag > 0.0)) return commanded;
    return commanded + (regulated_ - commanded) * std::exp(-seconds / dynamics_.lag);
}

double ForceActuator::mean_regulated(double seconds, double commanded) const {
    if (!(dynamics_.lag > 0.0)) return commanded;
    const double x = seconds / dynamics_.lag;
    return commanded - (regulated_ - commanded) * std::expm1(-x) / x;
}

void ForceActuator::regulate(double seconds, double commanded) {
    regulate_to(regulated_after(seconds, commanded), commanded);
}

void ForceActuator::regulate_to(double force, double commanded) {
    regulated_ = std::abs(force - commanded) < kSettled ? commanded : force;
}

double ForceActuator::quickness(double stiffness) const {
    return stiffness / std::max(std::sqrt(stiffness * dynamics_.mass), 0.5 * dynamics_.damping);
}

void ForceActuator::begin(double seconds, double commanded, double stiffness) {
    seconds_ = seconds;
    stage_ = 0;
    from_ = place_;
    from_speed_ = speed_;
    const double h = kGamma * seconds;
    inertia_ = std::max(dynamics_.mass + h * dynamics_.damping, h * h * stiffness / kSoftest);
    forces_[0] = regulated_after(h, commanded);
    forces_[1] = regulated_after(seconds, commanded);
    regulate_to(forces_[1], commanded);
}

ForceActuator::Stage ForceActuator::stage() const {
    const double h = kGamma * seconds_;
    const double push = dynamics_.mass * from_speed_ + h * forces_[stage_];
    return {from_ + h * push / inertia_, h * h / inertia_, stage_ == 0 ? 1.0 - kGamma : kGamma};
}

std::optional<double> ForceActuator::limited(double place) const {
    double within = place;
    if (dynamics_.speed_limit > 0.0) {
        const double most = kGamma * seconds_ * dynamics_.speed_limit;
        within = std::clamp(within, from_ - most, from_ + most);
    }
    within = std::clamp(within, -travel_, travel_);
    if (within == place) return std::nullopt;
    return within;
}

void ForceActuator::end_stage(double place) {
    const bool stopped = std::abs(place) >= travel_;
    const double speed = stopped ? 0.0 : (place - from_) / (kGamma * seconds_);
    if (stage_++ == 0) {
        // Both stages' slopes act from the step's begin on.
        const double rest = (1.0 - kGamma) / kGamma;
        const double way = rest * (place - from_), gain = rest * (speed - from_speed_);
        from_ = place_ + way;
        from_speed_ = speed_ + gain;
        return;
    }
    place_ = place;
    speed_ = speed;
}

}  // namespace beltgrinding

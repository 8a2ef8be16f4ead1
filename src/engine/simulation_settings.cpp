#include <cmath>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation_options.h"

namespace beltgrinding {
namespace {

// mm/s. Belts run at 0.5 to 60 m/s: what is far beyond is given in another unit.
constexpr double kSlowestBelt = 100.0, kFastestBelt = 200e3;

void check_positive(double value, const char* code, const char* form) {
    if (!std::isfinite(value) || value <= 0.0) throw InputError(code, form);
}

constexpr double kRoughest = 1e6;  // um

bool is_limit(double value) {
    return std::isfinite(value) && value >= 0.0;
}

}  // namespace

void ProcessSettings::validate() const {
    if (machine.free_face()) {
        machine.validate();
    } else {
        wheel.validate();
    }
    if (!(belt_speed >= kSlowestBelt && belt_speed <= kFastestBelt)) {
        throw InputError("simulation.belt_speed",
                         "the belt speed is {speed:g} mm/s; no belt is slower than {low:g} mm/s or "
                         "faster than {high:g} mm/s (0.1 and 200 m/s): check its unit",
                         {{"speed", belt_speed}, {"low", kSlowestBelt}, {"high", kFastestBelt}});
    }
    if (force_control) {
        check_positive(force_travel, "simulation.force_travel",
                       "the travel of the force control must be positive and finite");
    }
    if (!is_limit(dynamics.lag) || !is_limit(dynamics.mass) || !is_limit(dynamics.damping) ||
        !is_limit(dynamics.speed_limit)) {
        throw InputError("simulation.force_dynamics",
                         "lag, moving mass, damping and limit of speed of the force control must "
                         "be zero or positive, and finite");
    }
    if (!machine.free_face() && (!is_limit(wheel_growth) || wheel_growth >= wheel.radius)) {
        throw InputError("simulation.wheel_growth",
                         "the wheel's growth must be zero or positive, and less than its radius");
    }
    if (!is_limit(robot_stiffness)) {
        throw InputError("simulation.robot_stiffness",
                         "the robot's stiffness must be zero (rigid) or positive");
    }
    belt.validate();
    if (!is_limit(belt_wear)) {
        throw InputError("simulation.belt_wear", "the belt's wear factor must be zero or positive");
    }
    if (!is_limit(pause)) {
        throw InputError("simulation.pause", "the pause before the path must be zero or positive");
    }
    if (belt.loading > 0.0 && !wear.loads()) {
        throw InputError("simulation.loading_without_law",
                         "the belt comes with a loading of {loading:.3g}, but its wear has no "
                         "loading share; set that, or the belt's loading to 0",
                         {{"loading", belt.loading}});
    }
}

void Resolution::validate() const {
    check_positive(contact_spacing, "simulation.contact_spacing",
                   "the contact grid's spacing must be positive and finite");
    check_positive(contact_tolerance, "simulation.contact_tolerance",
                   "the contact tolerance must be positive and finite");
}

void MonitorLimits::validate(std::size_t samples) const {
    if (!is_limit(heat)) {
        throw InputError("simulation.heat_limit",
                         "the limit of heat must be zero (none) or positive");
    }
    if (lower.size() > 1 && lower.size() != samples) {
        throw InputError("simulation.lower_limits",
                         "the lower limits are neither one for all nor one per sample");
    }
    if (!is_limit(overshoot) || !is_limit(bounce)) {
        throw InputError("simulation.force_limits",
                         "the limits of overshoot and of bounces must be zero (none) or positive");
    }
    if (!is_limit(pressure) || !is_limit(orientation_jump) || !is_limit(tilt)) {
        throw InputError(
            "simulation.limits",
            "the limits of pressure, orientation jump and tilt must be zero (none) or positive");
    }
}

void HeatRequest::validate(std::size_t samples) const {
    if (part == nullptr) return;
    if (part->node_of().size() != samples) {
        throw InputError("heat.other_field", "the heat is of another height field");
    }
    if (!is_limit(friction) || !is_limit(partition) || partition > 1.0) {
        throw InputError("heat.shares",
                         "the coefficient of friction must be positive, and the share of the heat "
                         "into the work between 0 and 1");
    }
    if (!is_limit(low) || !is_limit(high) || low > 1.0 || high < 1.0) {
        throw InputError("heat.range", "the range of the heat must hold what is most likely");
    }
    if (!std::isfinite(start) || !is_limit(burn)) {
        throw InputError("heat.temperatures", "heat: each temperature must be a number of degrees");
    }
}

void FinishRequest::validate() const {
    if (!wanted) return;
    if (!is_limit(roughness) ||
        !(std::isnan(before) || (is_limit(before) && before <= kRoughest)) ||
        !(rest >= 0.0 && rest < 1.0)) {
        throw InputError("finish.roughness",
                         "finish: each roughness must be positive, and the share of it that a pass "
                         "leaves from 0 to below 1");
    }
    for (const double exponent : {pressure_exponent, speed_exponent, feed_exponent, cut_exponent}) {
        if (!std::isfinite(exponent))
            throw InputError("finish.exponent", "an exponent of the finish is not finite");
    }
    for (const double reference : {reference_pressure, reference_speed, reference_feed}) {
        if (!std::isfinite(reference) || !(reference > 0.0))
            throw InputError("finish.reference", "a reference of the finish must be positive");
    }
    for (const Range& range : {pressure, speed, feed, cut}) {
        if (!(range.low >= 0.0 && range.low <= range.high))
            throw InputError("finish.range", "a range of the finish is not in order");
    }
}

PhaseTimes& PhaseTimes::operator+=(const PhaseTimes& more) {
    build += more.build;
    localise += more.localise;
    gap += more.gap;
    contact += more.contact;
    removal += more.removal;
    trace += more.trace;
    events += more.events;
    heat += more.heat;
    finish += more.finish;
    return *this;
}

}  // namespace beltgrinding

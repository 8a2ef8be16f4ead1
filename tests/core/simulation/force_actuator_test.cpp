// The force control that takes time, by itself: against the closed form on a linear contact, and
// what a bouncing wheel's energy does.

#include "force_actuator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace beltgrinding {
namespace {

constexpr double kTravel = 5.0;  // mm

/// A time step on a contact whose force (N) is a function of the place, found by bisection.
void advance(ForceActuator& actuator, double seconds, double commanded, double stiffness,
             const std::function<double(double)>& force) {
    actuator.begin(seconds, commanded, stiffness);
    for (int k = 0; k < ForceActuator::kStages; ++k) {
        const auto stage = actuator.stage();
        double low = -1e3, high = stage.place;  // place + give * force(place) - stage.place rises
        for (int i = 0; i < 200; ++i) {
            const double middle = 0.5 * (low + high);
            (middle + stage.give * force(middle) > stage.place ? high : low) = middle;
        }
        actuator.end_stage(actuator.limited(high).value_or(high));
    }
}

/// Share of a step in force that the contact has, t s after it (m z'' + d z' + k z = F).
double closed_form(double t, double mass, double damping, double stiffness) {
    if (!(mass > 0.0)) return 1.0 - std::exp(-t * stiffness / damping);
    const double w = std::sqrt(stiffness / mass);
    const double zeta = damping / (2.0 * std::sqrt(stiffness * mass));
    if (zeta < 1.0) {
        const double wd = w * std::sqrt(1.0 - zeta * zeta);
        return 1.0 -
               std::exp(-zeta * w * t) * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t));
    }
    const double slow = w * (zeta - std::sqrt(zeta * zeta - 1.0)), fast = w * w / slow;
    return 1.0 - (fast * std::exp(-slow * t) - slow * std::exp(-fast * t)) / (fast - slow);
}

/// The largest error of the contact's force over two periods (or the way to rest) in steps of
/// `resolved` over the quickness, as a share of the step in force.
double error(double mass, double zeta, double resolved) {
    const double k = 200.0;
    const double damping = mass > 0.0 ? 2.0 * zeta * std::sqrt(k * mass) : zeta;
    ForceActuator actuator({0.0, mass, damping, 0.0}, kTravel);
    actuator.rest(50.0 / k, 50.0);
    const double h = resolved / actuator.quickness(k);
    double worst = 0.0;
    for (double t = h; t < 12.0 / actuator.quickness(k); t += h) {
        advance(actuator, h, 80.0, k, [&](double z) { return std::max(k * z, 0.0); });
        const double share = (k * actuator.place() - 50.0) / 30.0;
        worst = std::max(worst, std::abs(share - closed_form(t, mass, damping, k)));
    }
    return worst;
}

TEST(ForceActuator, AStepInForceIsTheClosedForm) {
    // In steps of a fifth of the quickness, as the simulation takes them; and of second order.
    for (const double zeta : {0.0, 0.05, 0.3, 0.7, 1.5, 3.0}) {
        EXPECT_LT(error(2e-3, zeta, 0.2), 0.02) << zeta;
        EXPECT_LT(error(2e-3, zeta, 0.1), 0.35 * error(2e-3, zeta, 0.2) + 1e-3) << zeta;
    }
    EXPECT_LT(error(0.0, 5.0, 0.2), 0.02);  // no mass: of first order
}

TEST(ForceActuator, TheRegulatorLags) {
    ForceActuator actuator({0.05, 1e-6, 0.0, 0.0}, kTravel);
    actuator.rest(0.25, 50.0);
    EXPECT_NEAR(actuator.regulated_after(0.05, 80.0), 80.0 - 30.0 * std::exp(-1.0), 1e-12);
    EXPECT_NEAR(actuator.mean_regulated(0.05, 80.0), 80.0 - 30.0 * (1.0 - std::exp(-1.0)), 1e-12);
    // In two halves as in one.
    actuator.regulate(0.025, 80.0);
    actuator.regulate(0.025, 80.0);
    EXPECT_NEAR(actuator.regulated(), 80.0 - 30.0 * std::exp(-1.0), 1e-12);
}

TEST(ForceActuator, ABouncingWheelGainsNoEnergy) {
    // 1 mm above a contact with F = K z^1.5, pressed by 50 N, undamped.
    const double mass = 2e-3, push = 50.0, K = 200.0;
    const double at_rest = std::pow(push / K, 2.0 / 3.0);
    const double k = 1.5 * push / at_rest;
    for (const double resolved : {0.1, 0.2, 1.0, 5.0}) {
        ForceActuator actuator({0.0, mass, 0.0, 0.0}, 10.0);
        actuator.rest(-1.0, push);
        const double begin = push * 1.0, h = resolved * std::sqrt(mass / k);
        double least = begin, most = begin;
        int bounces = 0;
        bool before = false;
        for (int i = 0; i < 3000; ++i) {
            advance(actuator, h, push, k,
                    [&](double z) { return z > 0.0 ? K * std::pow(z, 1.5) : 0.0; });
            const double z = actuator.place(), v = actuator.speed();
            const double energy =
                0.5 * mass * v * v - push * z + (z > 0.0 ? K / 2.5 * std::pow(z, 2.5) : 0.0);
            most = std::max(most, energy);
            least = std::min(least, energy);
            bounces += before && z <= 0.0 ? 1 : 0;
            before = z > 0.0;
        }
        EXPECT_LT(most, begin * 1.001) << resolved;
        if (resolved <= 0.1) {
            EXPECT_GT(least, 0.98 * begin);
            EXPECT_GT(bounces, 20);
        }
    }
}

TEST(ForceActuator, KeepsToItsLimits) {
    ForceActuator actuator({0.0, 2e-3, 0.0, 20.0}, 0.5);
    actuator.rest(0.0, 50.0);
    const auto nothing = [](double) { return 0.0; };
    double before = 0.0;
    for (int i = 0; i < 100; ++i) {
        advance(actuator, 1e-3, 50.0, 200.0, nothing);
        EXPECT_LE(actuator.place(), 0.5);
        EXPECT_LE(actuator.place() - before, 20.0 * 1e-3 * (1.0 + 1e-9));
        before = actuator.place();
    }
    EXPECT_DOUBLE_EQ(actuator.place(), 0.5);
    EXPECT_EQ(actuator.speed(), 0.0);
    EXPECT_TRUE(actuator.held_by_stop(40.0));
    EXPECT_FALSE(actuator.held_by_stop(60.0));
}

}  // namespace
}  // namespace beltgrinding

// A belt over a curved platen in place of the wheel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/threads.h"
#include "beltgrinding/belt_machine.h"
#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr double kCoefficient = 2e-6;  // mm2/N
constexpr double kForce = 20.0;        // N

SimulationOptions platen(double radius) {
    SimulationOptions o;
    o.process.machine.kind = BeltMachine::Kind::kPlaten;
    o.process.machine.belt.width = 20.0;
    o.process.machine.platen.layers = {{5.0, 2.0, 0.4}};
    o.process.machine.platen.radius = radius;
    o.process.force = kForce;
    o.process.force_travel = 30.0;
    o.process.belt_speed = 20000.0;
    o.resolution.contact_spacing = 1.0;
    return o;
}

SimulationResult ground(HeightField& field, const ToolPath& path, const SimulationOptions& o) {
    const auto model = make_belt_contact(o.process.machine);
    return simulate(field, path, *model, LocalLaw({kCoefficient}), o);
}

/// A pose that presses down at (x, y, z), turned by `tilt` rad about y.
PathPose tilted(double x, double y, double z, double tilt) {
    PathPose pose = pressing_down(x, y, z, 40.0);
    pose.base_from_tcp = pose.base_from_tcp * Eigen::AngleAxisd(tilt, Vec3::UnitY());
    return pose;
}

bool has(const SimulationResult& result, const std::string& kind) {
    return std::any_of(result.events.begin(), result.events.end(),
                       [&](const Event& event) { return event.kind == kind; });
}

/// Middle along x of what was ground, mm.
double middle_of(const HeightField& field, double allowance) {
    double sum = 0.0, moment = 0.0;
    for (std::size_t s = 0; s < field.size(); ++s) {
        const double taken = allowance - field.height[s];
        sum += taken;
        moment += taken * field.point[s].x();
    }
    return moment / sum;
}

TEST(CurvedPlatenSimulation, GrindsAPlaneOnAShortContact) {
    const ToolPath path({pressing_down(30, 15, 0.2, 40.0), pressing_down(30, 25, 0.2, 40.0)}, {});
    const double whole = kCoefficient * 20000.0 * kForce * 0.25;
    std::vector<double> lengths;
    for (const double radius : {70.0, 300.0}) {
        HeightField field = testing::plate(60.0, 40.0, 0.6, 0.2);
        const SimulationResult result = ground(field, path, platen(radius));
        EXPECT_FALSE(has(result, "not_converged"));
        EXPECT_NEAR(result.removed_volume, whole, 0.01 * whole);
        double longest = 0.0;
        for (std::size_t s = 0; s < field.size(); ++s)
            if (field.height[s] < 0.2 - 1e-6)
                longest = std::max(longest, std::abs(field.point[s].x() - 30.0));
        lengths.push_back(longest);
    }
    EXPECT_LT(lengths[0], 10.0);
    EXPECT_GT(lengths[1], 1.3 * lengths[0]);
}

TEST(CurvedPlatenSimulation, TouchesWhereItsFaceIsTheWorksTangent) {
    // Turned by 20 degrees about y, the plane touches R sin(20 degrees) off the middle.
    const double tilt = std::numbers::pi / 9.0, radius = 100.0;
    const SimulationOptions o = platen(radius);
    const double face = radius + o.process.machine.belt.thickness;
    // With that place on the plane z = 0.2 at x = 30.
    const double z = 0.2 + face * (1.0 - std::cos(tilt));
    const double off = face * std::sin(tilt);
    for (const double sign : {1.0, -1.0}) {
        HeightField field = testing::plate(60.0, 40.0, 0.6, 0.2);
        const ToolPath path({tilted(30 + sign * off, 15, z, sign * tilt),
                             tilted(30 + sign * off, 25, z, sign * tilt)},
                            {});
        const SimulationResult result = ground(field, path, o);
        EXPECT_FALSE(has(result, "not_converged"));
        // What the force is along z, the pressure is along the plane's normal.
        const double whole = kCoefficient * 20000.0 * kForce / std::cos(tilt) * 0.25;
        EXPECT_NEAR(result.removed_volume, whole, 0.02 * whole);
        EXPECT_NEAR(middle_of(field, 0.2), 30.0, 0.5);
    }
}

TEST(CurvedPlatenSimulation, WhatStandsBehindThePlaneBesideItIsNotTouched) {
    // Position control: a strip that stands 5 mm behind the plane from 42 mm off the middle on,
    // where the belt has gone back by 5.2 mm, or by 4.94.
    for (const auto& [radius, touched] : {std::pair{171.0, false}, std::pair{180.0, true}}) {
        SimulationOptions o = platen(radius);
        o.process.machine.platen.layers.clear();
        o.process.force_control = false;
        o.must_touch = false;
        HeightField field = testing::plate(4.0, 40.0, 0.6, 0.2);
        const ToolPath path({pressing_down(46, 15, -4.8, 40.0), pressing_down(46, 25, -4.8, 40.0)},
                            {});
        const SimulationResult result = ground(field, path, o);
        EXPECT_EQ(result.removed_volume > 0.0, touched) << radius;
    }
}

TEST(CurvedPlatenSimulation, AContactFarRoundItIsTold) {
    const double tilt = std::numbers::pi / 6.0, radius = 100.0;
    SimulationOptions o = platen(radius);
    o.limits.tilt = 0.3;
    const double face = radius + o.process.machine.belt.thickness;
    const double z = 0.2 + face * (1.0 - std::cos(tilt));
    for (const double sign : {1.0, -1.0}) {
        HeightField field = testing::plate(60.0, 40.0, 0.6, 0.2);
        const double x = 30.0 + sign * face * std::sin(tilt);
        const SimulationResult result = ground(
            field, ToolPath({tilted(x, 18, z, sign * tilt), tilted(x, 20, z, sign * tilt)}, {}), o);
        const auto event =
            std::find_if(result.events.begin(), result.events.end(),
                         [](const Event& one) { return one.kind == "tilted_contact"; });
        ASSERT_NE(event, result.events.end());
        EXPECT_NEAR(event->value, 30.0, 0.5);
        EXPECT_EQ(event->facts[0].code,
                  sign > 0.0 ? "event.belt_tilted_against" : "event.belt_tilted_along");
        EXPECT_NEAR(event->point.x(), 30.0, 1.0);
    }
}

TEST(CurvedPlatenSimulation, AHollowIsSpannedThatIsTighterThanThePlaten) {
    const auto hollow = [](double radius) {
        HeightField field = testing::cylinder(radius, 50.0, 40.0, 0.5);
        for (std::size_t s = 0; s < field.size(); ++s) {
            field.point[s].z() = -field.point[s].z();
            field.normal[s].x() = -field.normal[s].x();
            field.height[s] = 0.2;
        }
        return field;
    };
    SimulationOptions o = platen(80.0);
    o.process.machine.platen.layers.clear();
    const ToolPath path({pressing_down(-0.5, 18, 0.2, 40.0), pressing_down(0.5, 18, 0.2, 40.0)},
                        {});
    for (const double radius : {50.0, 120.0}) {
        HeightField field = hollow(radius);
        const SimulationResult result = ground(field, path, o);
        const auto event =
            std::find_if(result.events.begin(), result.events.end(),
                         [](const Event& one) { return one.kind == "wheel_too_large"; });
        if (radius > 81.0) {
            EXPECT_EQ(event, result.events.end());
            continue;
        }
        ASSERT_NE(event, result.events.end());
        EXPECT_EQ(event->facts[0].code, "event.belt_hollow_along");
        EXPECT_NEAR(event->value, radius, 1.0);
        EXPECT_NEAR(event->limit, 81.0, 1e-9);
    }
}

TEST(CurvedPlatenSimulation, IsTheFlatOneWithARadiusBeyondAllMeasure) {
    const ToolPath path({pressing_down(0, 20, 0.1, 40.0), pressing_down(0, 40, 0.1, 40.0)}, {});
    HeightField flat = testing::cylinder(40.0, 60.0, 60.0, 0.6, 0.2), bent = flat;
    SimulationOptions o = platen(0.0);
    o.process.machine.platen.layers.clear();
    const SimulationResult a = ground(flat, path, o);
    o.process.machine.platen.radius = 1e8;
    const SimulationResult b = ground(bent, path, o);
    EXPECT_NEAR(b.removed_volume, a.removed_volume, 1e-3 * a.removed_volume);
    double most = 0.0, difference = 0.0;
    for (std::size_t s = 0; s < flat.size(); ++s) {
        most = std::max(most, 0.2 - flat.height[s]);
        difference = std::max(difference, std::abs(flat.height[s] - bent.height[s]));
    }
    EXPECT_LT(difference, 0.01 * most);
}

TEST(CurvedPlatenSimulation, ThreadsDoNotChangeABit) {
    const ToolPath path({pressing_down(0, 20, 0.2, 40.0), pressing_down(0, 40, 0.2, 40.0)}, {});
    const auto once = [&](std::size_t count) {
        set_threads(count);
        HeightField field = testing::cylinder(40.0, 60.0, 60.0, 0.6, 0.2);
        SimulationOptions o = platen(100.0);
        ground(field, path, o);
        return field.height;
    };
    EXPECT_EQ(once(1), once(3));
    set_threads(0);
}

}  // namespace
}  // namespace beltgrinding

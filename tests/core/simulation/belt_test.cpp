// A free belt and a platen in place of the wheel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "beltgrinding/belt_machine.h"
#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr double kCoefficient = 2e-6;  // mm2/N
constexpr double kRadius = 40.0;       // mm, of the cylinders

SimulationOptions free_belt(double width = 20.0) {
    SimulationOptions o;
    o.process.machine.kind = BeltMachine::Kind::kFreeBelt;
    o.process.machine.belt.width = width;
    o.process.machine.run.rollers = BeltRun::Rollers::kTensioned;
    o.process.force = 10.0;
    o.process.force_travel = 30.0;
    o.process.belt_speed = 20000.0;
    return o;
}

SimulationOptions platen() {
    SimulationOptions o = free_belt();
    o.process.machine.kind = BeltMachine::Kind::kPlaten;
    o.process.machine.platen.layers = {{5.0, 2.0, 0.4}};
    return o;
}

SimulationResult ground(HeightField& field, const ToolPath& path, const SimulationOptions& o) {
    const auto model = make_belt_contact(o.process.machine);
    return simulate(field, path, *model, LocalLaw({kCoefficient}), o);
}

HeightField rod(double arc = 60.0, double length = 60.0) {
    return testing::cylinder(kRadius, arc, length, 0.6, 0.2);
}

/// Along the top of the rod.
ToolPath along(double from, double to, double z = 0.2) {
    return ToolPath({pressing_down(0.0, from, z, 40.0), pressing_down(0.0, to, z, 40.0)}, {});
}

bool has(const SimulationResult& result, const std::string& kind) {
    return std::any_of(result.events.begin(), result.events.end(),
                       [&](const Event& event) { return event.kind == kind; });
}

TEST(BeltSimulation, AFreeBeltHoldsItsForceAndTakesWhatThePressureAsksFor) {
    HeightField field = rod();
    const SimulationResult result = ground(field, along(20, 40), free_belt());
    for (const StepRecord& step : result.steps) {
        EXPECT_NEAR(step.force, 10.0, 0.05);
        EXPECT_GT(step.contact_area, 10.0);
        EXPECT_GT(step.approach, 1.0);  // it is soft
    }
    EXPECT_FALSE(has(result, "not_converged"));
    const double whole = kCoefficient * 20000.0 * 10.0 * 0.5;  // K V_b F t
    EXPECT_NEAR(result.removed_volume, whole, 0.01 * whole);
    EXPECT_NEAR(result.removed_volume, result.integrated_rate, 0.005 * whole);
}

// In a wrap of 2 alpha the sides press on one another: p = N / R on an arc of 2 alpha R, so that
// the pressure's integral is N W 2 alpha where the force is 2 N W sin(alpha).
TEST(BeltSimulation, AWrapGrindsItsSidesAsWell) {
    HeightField field = testing::cylinder(kRadius, 110.0, 50.0, 0.6, 0.0);
    SimulationOptions o = free_belt();
    o.process.force = 100.0;
    o.process.force_travel = 90.0;
    const SimulationResult result = ground(field, along(22, 28, 0.0), o);
    EXPECT_FALSE(has(result, "not_converged"));
    const double force = 0.5 * 100.0 / 20.0;      // N/mm, of one run
    const double alpha = std::atan(force / 4.0);  // tensioned: along x the pull is the tension
    const double sum = 4.0 / std::cos(alpha) * 20.0 * 2.0 * alpha;
    EXPECT_GT(sum, 1.05 * 100.0);
    const double whole = kCoefficient * 20000.0 * sum * result.process_time;
    EXPECT_NEAR(result.removed_volume, whole, 0.02 * whole);
    EXPECT_NEAR(result.belt.work, 1e-3 * 20000.0 * sum * result.process_time,
                0.02 * result.belt.work);
    double deepest_aside = 0.0;
    for (std::size_t s = 0; s < field.size(); ++s)
        if (std::abs(field.point[s].x()) > kRadius * std::sin(0.6 * alpha))
            deepest_aside = std::max(deepest_aside, -field.height[s]);
    EXPECT_GT(deepest_aside, 0.0);
}

TEST(BeltSimulation, HalvingTheStepsChangesLittle) {
    std::vector<HeightField> fields;
    for (const double travel : {1.0, 0.5}) {
        fields.push_back(rod());
        SimulationOptions o = free_belt();
        o.resolution.max_travel = travel;
        ground(fields.back(), along(25, 35), o);
    }
    double difference = 0.0, removed = 0.0;
    for (std::size_t s = 0; s < fields[0].size(); ++s) {
        difference += std::abs(fields[0].height[s] - fields[1].height[s]) * fields[0].area[s];
        removed += (0.2 - fields[1].height[s]) * fields[0].area[s];
    }
    EXPECT_LT(difference, 0.1 * removed);
}

TEST(BeltSimulation, PositionControlHasTheForceOfTheDepth) {
    // The reference's tensioned belt of 50 mm: 20.56 N at 5 mm.
    HeightField field = testing::cylinder(kRadius, 60.0, 70.0, 0.6, 0.0);
    SimulationOptions o = free_belt(50.0);
    o.process.machine.belt.surface_stiffness = 200.0;
    o.process.force_control = false;
    const ToolPath path = along(35, 35.5, -5.0);
    const auto model = make_belt_contact(o.process.machine);
    const PoseContact contact = contact_at(field, path, 0, *model, o.process);
    EXPECT_NEAR(contact.solution.force, 20.56, 0.03 * 20.56);
    EXPECT_TRUE(contact.solution.converged);
    o.process.robot_stiffness = 5.0;
    const PoseContact soft = contact_at(field, path, 0, *model, o.process);
    EXPECT_LT(soft.solution.force, 0.8 * contact.solution.force);
    EXPECT_NEAR(soft.placed + soft.solution.approach, -soft.solution.force / 5.0,
                0.01 * soft.solution.force / 5.0);
}

TEST(BeltSimulation, APlatenGrindsAPlateAsWideAsTheBelt) {
    HeightField field = testing::plate(60.0, 60.0, 0.6, 0.2);
    const ToolPath path({pressing_down(30, 25, 0.2, 40.0), pressing_down(30, 35, 0.2, 40.0)}, {});
    SimulationOptions o = platen();
    o.process.force = 40.0;
    const SimulationResult result = ground(field, path, o);
    EXPECT_FALSE(has(result, "not_converged"));
    const double whole = kCoefficient * 20000.0 * 40.0 * 0.25;
    EXPECT_NEAR(result.removed_volume, whole, 0.01 * whole);
    for (std::size_t s = 0; s < field.size(); ++s) {
        const double y = field.point[s].y();
        // Beside the belt, which is 20 mm wide and moves by 10 mm, nothing is ground.
        if (y > 14.0 && y < 46.0) continue;
        EXPECT_EQ(field.height[s], 0.2);
    }
}

TEST(BeltSimulation, ABeltMeetsNothingBeyondItsRollers) {
    // The rod lies 70 mm off the middle of a run of 100 mm.
    HeightField field = rod();
    SimulationOptions o = free_belt();
    o.process.machine.run.length = 100.0;
    const ToolPath path({pressing_down(-90, 20, -1.0, 40.0), pressing_down(-90, 40, -1.0, 40.0)},
                        {});
    o.must_touch = false;
    const SimulationResult result = ground(field, path, o);
    EXPECT_EQ(result.removed_volume, 0.0);
    EXPECT_EQ(result.steps.front().force, 0.0F);
}

TEST(BeltSimulation, TheTravelsEndIsTold) {
    HeightField field = rod();
    SimulationOptions o = free_belt();
    o.process.force_travel = 0.5;
    EXPECT_TRUE(has(ground(field, along(25, 30), o), "force_not_reached"));
}

TEST(BeltSimulation, ABeltThatCannotBearTheForceGoesToTheTravelsEndAndIsTold) {
    HeightField field = rod();
    SimulationOptions o = free_belt();
    o.process.machine.belt.tension = 0.05;
    o.process.force = 200.0;
    o.process.force_travel = 4.0;
    const SimulationResult result = ground(field, along(25, 30), o);
    EXPECT_TRUE(has(result, "force_not_reached"));
    for (const StepRecord& step : result.steps) {
        EXPECT_GT(step.force, 0.0);
        EXPECT_NEAR(step.approach, 4.0, 1e-6);
    }
}

TEST(BeltSimulation, WhatABeltBearsBeyondTheCellsIsNotPassedOver) {
    // Between rollers that are 5 mm apart no cell lies clear of both.
    HeightField field = testing::plate(40.0, 40.0, 0.6, 0.2);
    SimulationOptions o = platen();
    o.process.machine.run.length = 5.0;
    o.process.machine.platen.length = 4.0;
    const ToolPath path({pressing_down(20, 18, 0.2, 40.0), pressing_down(20, 22, 0.2, 40.0)}, {});
    const SimulationResult result = ground(field, path, o);
    EXPECT_LT(result.steps.front().force, 0.5 * o.process.force);
    EXPECT_TRUE(has(result, "not_converged"));
}

TEST(BeltSimulation, ValuesThatAreNoneAreRefused) {
    HeightField field = rod();
    const auto refused = [&](const SimulationOptions& o) {
        const auto model = make_belt_contact(free_belt().process.machine);
        EXPECT_THROW(simulate(field, along(25, 30), *model, LocalLaw({kCoefficient}), o),
                     InputError);
    };
    SimulationOptions o = free_belt();
    o.process.machine.belt.tension = 0.0;
    refused(o);
    o = free_belt();
    o.process.machine.run.position = 100.0;
    refused(o);
    o = platen();
    o.process.machine.platen.length = 201.0;
    refused(o);
}

/// The codes of the facts of all events of a kind; what each says has the belt for the wheel.
std::vector<std::string> facts(const SimulationResult& result, const std::string& kind) {
    std::vector<std::string> codes;
    for (const Event& event : result.events) {
        if (event.kind != kind) continue;
        for (const Fact& fact : event.facts) {
            EXPECT_EQ(std::string(fact.text).find("wheel"), std::string::npos) << fact.text;
            codes.emplace_back(fact.code);
        }
    }
    return codes;
}

const std::vector<std::string> kLoses = {"event.belt_loses_contact"};

TEST(BeltSimulation, ABeltThatLosesTheWorkIsCalledABelt) {
    // A gap of 36 mm in the rod, deeper than the travel: a belt of 20 mm is clear of both sides.
    HeightField field = rod(60.0, 110.0);
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (std::abs(field.point[i].y() - 55.0) > 18.0) continue;
        field.height[i] -= 12.0;
        field.stock_height[i] -= 12.0F;
    }
    SimulationOptions o = free_belt();
    o.process.force_travel = 5.0;
    EXPECT_EQ(facts(ground(field, along(22, 88), o), "loss_of_contact"), kLoses);
}

TEST(BeltSimulation, ABeltPressedThroughItsLayersIsCalledABelt) {
    HeightField field = testing::plate(60.0, 60.0, 0.6, 0.2);
    SimulationOptions o = platen();
    o.process.force_control = false;
    const ToolPath path({pressing_down(30, 29, -6.0, 40.0), pressing_down(30, 31, -6.0, 40.0)}, {});
    const SimulationResult result = ground(field, path, o);
    const auto codes = facts(result, "over_compressed");
    ASSERT_FALSE(codes.empty());
    for (const std::string& code : codes) EXPECT_EQ(code, "event.belt_over_compressed");
}

TEST(BeltSimulation, AForceThatItsLayersDoNotBearIsToldOfABelt) {
    HeightField field = testing::plate(60.0, 60.0, 0.6, 0.2);
    SimulationOptions o = platen();
    o.process.force = 50000.0;
    const ToolPath path({pressing_down(30, 29, 0.2, 40.0), pressing_down(30, 31, 0.2, 40.0)}, {});
    const SimulationResult result = ground(field, path, o);
    const auto codes = facts(result, "over_compressed");
    ASSERT_FALSE(codes.empty());
    EXPECT_EQ(codes.front(), "event.force_over_compresses_belt");
    EXPECT_LT(result.steps.back().force, o.process.force);
}

TEST(BeltSimulation, ABeltThatBouncesIsCalledABelt) {
    // Light damping, quickly over a step down.
    HeightField field = testing::plate(30.0, 100.0, 1.0, 0.2);
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field.point[i].y() > 40.0) continue;
        field.height[i] += 2.0;
        field.stock_height[i] += 2.0F;
    }
    SimulationOptions o = platen();
    o.process.force = 40.0;
    o.process.dynamics = {0.0, 8e-3, 0.02, 0.0};
    o.limits.bounce = 0.5;
    const ToolPath path({pressing_down(15, 20, 0.2, 400.0), pressing_down(15, 90, 0.2, 400.0)}, {});
    const auto codes = facts(ground(field, path, o), "bounces");
    ASSERT_FALSE(codes.empty());
    for (const std::string& code : codes) EXPECT_EQ(code, "event.belt_bounces");
}

TEST(BeltSimulation, IsTheSameInAnyThread) {
    const auto once = [] {
        HeightField field = rod();
        ground(field, along(27, 32), free_belt());
        return field.height;
    };
    const std::vector<double> here = once();
    std::vector<double> there;
    std::thread([&] { there = once(); }).join();
    EXPECT_EQ(here, there);
}

}  // namespace
}  // namespace beltgrinding

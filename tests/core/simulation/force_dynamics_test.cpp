// Force control that takes time in a whole simulation: against closed forms, over ribs and edges,
// and against force control that is met at every moment.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/compliance.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr double kRadius = 50.0, kWidth = 10.0;
constexpr double kFoundation = 1.0;  // MPa/mm
constexpr double kMassless = 1e-12;  // mm2/N: a law that takes nothing

SimulationOptions options(const ForceDynamics& dynamics, double travel = 1.0) {
    SimulationOptions o;
    o.process.wheel = {kRadius, kWidth, 0.0};
    o.process.force = 40.0;
    o.process.dynamics = dynamics;
    o.resolution.max_travel = travel;
    o.limits.overshoot = 0.1;
    o.limits.bounce = 0.2;
    return o;
}

SimulationResult run(HeightField& field, const std::vector<PathPose>& poses,
                     const SimulationOptions& o, double coefficient) {
    return simulate(field, ToolPath(poses, {}), ElasticFoundation(kFoundation),
                    LocalLaw({coefficient}), o);
}

std::vector<std::string> kinds(const SimulationResult& result) {
    std::vector<std::string> found;
    for (const Event& event : result.events) found.emplace_back(event.kind);
    return found;
}

bool has(const SimulationResult& result, const std::string& kind) {
    const auto all = kinds(result);
    return std::find(all.begin(), all.end(), kind) != all.end();
}

double greatest(const SimulationResult& result) {
    double most = 0.0;
    for (const StepRecord& step : result.steps) most = std::max(most, double(step.force));
    return most;
}

/// A gutter about the y axis that has the wheel's own form, 16 mm along its round: the area of the
/// contact is the same under each force, so that the contact is linear.
HeightField gutter() {
    const double arc = 16.0, length = 80.0;
    const auto normal = [=](double u, double) {
        const double angle = (u - 0.5 * arc) / kRadius;
        return Vec3(-std::sin(angle), 0.0, std::cos(angle));
    };
    return testing::mapped_field(
        arc, length, 0.5, 0.0,
        [=](double u, double v) { return Vec3(-kRadius * normal(u, v) + Vec3(0, v, kRadius)); },
        normal);
}

/// Along the gutter: 0.5 s under `first` N, then 0.5 s under `second`.
std::vector<PathPose> step_in_force(double first, double second) {
    std::vector<PathPose> poses = {pressing_down(0.0, 15.0, 0.0, 50.0),
                                   pressing_down(0.0, 40.0, 0.0, 50.0),
                                   pressing_down(0.0, 65.0, 0.0, 50.0)};
    poses[0].force = poses[1].force = first;
    poses[2].force = second;
    return poses;
}

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

/// The largest difference of a step's mean force from that of `exact` (N at s after the step in
/// force), as a share of the step in force.
double worst(const SimulationResult& result, double first, double second,
             const std::function<double(double)>& exact) {
    double most = 0.0;
    for (const StepRecord& step : result.steps) {
        const double begin = step.time - 0.5 * step.duration - 0.5;
        double mean = 0.0;
        constexpr int kParts = 40;
        for (int i = 0; i < kParts; ++i) {
            const double t = begin + (i + 0.5) / kParts * step.duration;
            mean += (t > 0.0 ? exact(t) : first) / kParts;
        }
        most = std::max(most, std::abs(step.force - mean));
    }
    return most / std::abs(second - first);
}

TEST(ForceDynamics, AStepInForceIsTheClosedForm) {
    HeightField still = gutter();
    const auto ideal = run(still, step_in_force(40.0, 60.0), options({}), kMassless);
    const auto& a = ideal.steps.front();
    const auto& b = ideal.steps.back();
    const double k = (b.force - a.force) / (b.approach - a.approach);
    ASSERT_NEAR(a.force / a.approach, k, 0.01 * k);  // linear
    for (const double mass : {2e-3, 8e-3, 0.0}) {
        for (const double zeta : {0.1, 0.5, 1.0 + 1e-6, 3.0}) {
            const double damping = 2.0 * zeta * std::sqrt(k * (mass > 0.0 ? mass : 2e-3));
            HeightField field = gutter();
            const auto result = run(field, step_in_force(40.0, 60.0),
                                    options({0.0, mass, damping, 0.0}), kMassless);
            EXPECT_LT(
                worst(result, 40.0, 60.0,
                      [&](double t) { return 40.0 + 20.0 * closed_form(t, mass, damping, k); }),
                0.02)
                << mass << " t, " << zeta;
        }
    }
}

TEST(ForceDynamics, AForceThatLagsIsTheClosedForm) {
    for (const double second : {60.0, 15.0}) {
        HeightField field = gutter();
        const auto result =
            run(field, step_in_force(40.0, second), options({0.06, 0.0, 0.0, 0.0}), kMassless);
        EXPECT_LT(worst(result, 40.0, second,
                        [&](double t) { return second + (40.0 - second) * std::exp(-t / 0.06); }),
                  0.005);
    }
}

/// A plate with a rib of 5 mm across the feed.
HeightField ribbed(double height) {
    HeightField field = testing::plate(70.0, 14.0, 0.5, 0.2);
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (std::abs(field.point[i].x() - 35.0) > 2.5) continue;
        field.height[i] += height;
        field.stock_height[i] += static_cast<float>(height);
    }
    return field;
}

/// mm, how deep the plate is ground along its middle.
std::vector<double> depths(const HeightField& field) {
    std::vector<double> found;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (std::abs(field.point[i].y() - 7.0) < 0.1) {
            found.push_back(field.stock_height[i] - field.height[i]);
        }
    }
    return found;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

const ForceDynamics kFlange = {0.0, 6e-3, 0.8, 0.0};
constexpr double kGrinds = 4e-6;  // mm2/N
constexpr double kFeed = 150.0;   // mm/s: the rib pushes the wheel up at 0.3 times as much

TEST(ForceDynamics, TheWayOverARibConverges) {
    std::vector<std::vector<double>> profiles;
    std::vector<double> forces;
    for (const double travel : {1.0, 0.5, 0.25, 0.125}) {
        HeightField field = ribbed(2.0);
        const auto result =
            run(field, {pressing_down(10.0, 7.0, 0.0, kFeed), pressing_down(60.0, 7.0, 0.0, kFeed)},
                options(kFlange, travel), kGrinds);
        profiles.push_back(depths(field));
        forces.push_back(greatest(result));
        EXPECT_TRUE(has(result, "force_overshoot"));
    }
    const double deepest = *std::max_element(profiles.back().begin(), profiles.back().end());
    const double first = largest_difference(profiles[0], profiles[1]);
    const double last = largest_difference(profiles[2], profiles[3]);
    EXPECT_LT(last, 0.02 * deepest);
    EXPECT_LT(last, 0.7 * first);
    EXPECT_NEAR(forces[2], forces[3], 0.03 * forces[3]);
    EXPECT_GT(forces[3], 1.2 * 40.0);  // ideal force control meets 40 N
}

TEST(ForceDynamics, TheWayIntoAnEdgeAndOutOfItConverges) {
    std::vector<std::vector<double>> profiles;
    for (const double travel : {1.0, 0.5, 0.25}) {
        HeightField field = testing::plate(50.0, 14.0, 0.5, 0.2);
        SimulationOptions o = options(kFlange, travel);
        o.process.force_travel = 1.5;
        run(field, {pressing_down(-18.0, 7.0, 0.2, kFeed), pressing_down(68.0, 7.0, 0.2, kFeed)}, o,
            kGrinds);
        profiles.push_back(depths(field));
    }
    const double deepest = *std::max_element(profiles.back().begin(), profiles.back().end());
    EXPECT_LT(largest_difference(profiles[1], profiles[2]), 0.03 * deepest);
    // The wheel is pushed up at the edge that it runs into, and late to come down at the other.
    HeightField field = testing::plate(50.0, 14.0, 0.5, 0.2);
    SimulationOptions o = options({}, 0.25);
    o.process.force_travel = 1.5;
    run(field, {pressing_down(-18.0, 7.0, 0.2, kFeed), pressing_down(68.0, 7.0, 0.2, kFeed)}, o,
        kGrinds);
    const std::vector<double> ideal = depths(field);
    EXPECT_GT(profiles.back()[4], 1.02 * ideal[4]);
    EXPECT_LT(profiles.back()[profiles.back().size() - 5], 0.98 * ideal[ideal.size() - 5]);
}

TEST(ForceDynamics, AQuickAndLightOneIsIdeal) {
    std::vector<double> differences;
    HeightField still = ribbed(2.0);
    const std::vector<PathPose> poses = {pressing_down(10.0, 7.0, 0.0, kFeed),
                                         pressing_down(60.0, 7.0, 0.0, kFeed)};
    const auto ideal = run(still, poses, options({}), kGrinds);
    const std::vector<double> wanted = depths(still);
    const double deepest = *std::max_element(wanted.begin(), wanted.end());
    for (const double small : {1.0, 0.1, 0.01}) {
        HeightField field = ribbed(2.0);
        const auto result =
            run(field, poses, options({0.0, 6e-3 * small * small, 0.8 * small, 0.0}), kGrinds);
        differences.push_back(largest_difference(depths(field), wanted) / deepest);
        if (small < 0.05) {
            EXPECT_NEAR(result.removed_volume, ideal.removed_volume, 0.01 * ideal.removed_volume);
            EXPECT_NEAR(greatest(result), 40.0, 0.05 * 40.0);
        }
    }
    EXPECT_LT(differences[1], 0.5 * differences[0]);
    EXPECT_LT(differences[2], 0.03);
}

TEST(ForceDynamics, TheWheelBouncesOffARamp) {
    // Light damping, quickly over a step down: the wheel flies, hits, and flies again.
    HeightField field = testing::plate(80.0, 14.0, 0.5, 0.0);
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field.point[i].x() > 30.0) continue;
        field.height[i] += 2.0;
        field.stock_height[i] += 2.0f;
    }
    const auto result =
        run(field, {pressing_down(10.0, 7.0, 0.0, 400.0), pressing_down(75.0, 7.0, 0.0, 400.0)},
            options({0.0, 8e-3, 0.02, 0.0}, 0.5), kMassless);
    EXPECT_TRUE(has(result, "bounces"));
    EXPECT_TRUE(has(result, "force_overshoot"));
    EXPECT_GT(greatest(result), 1.5 * 40.0);
    // The impulses of the contact stop what the force control speeds up: over the whole way its
    // mean is the commanded force, to what the mass has left in the end.
    double impulse = 0.0, time = 0.0;
    for (const StepRecord& step : result.steps) {
        impulse += step.force * step.duration;
        time += step.duration;
    }
    EXPECT_NEAR(impulse / time, 40.0, 0.15 * 40.0);
}

TEST(ForceDynamics, DoesNotDependOnThreadsOrOnTheRunBefore) {
    const auto once = [] {
        HeightField field = ribbed(2.0);
        run(field, {pressing_down(10.0, 7.0, 0.0, kFeed), pressing_down(60.0, 7.0, 0.0, kFeed)},
            options(kFlange), kGrinds);
        return field.height;
    };
    EXPECT_EQ(once(), once());
}

TEST(ForceDynamics, APassBeginsAtRestAfterARapidMotion) {
    HeightField field = testing::plate(60.0, 14.0, 0.5, 0.0);
    std::vector<PathPose> poses = {
        pressing_down(10.0, 7.0, 0.0, 60.0),  pressing_down(25.0, 7.0, 0.0, 60.0),
        pressing_down(25.0, 7.0, 30.0, 60.0), pressing_down(35.0, 7.0, 30.0, 60.0),
        pressing_down(35.0, 7.0, 0.0, 60.0),  pressing_down(50.0, 7.0, 0.0, 60.0)};
    poses[2].rapid = poses[3].rapid = poses[4].rapid = true;
    const auto result = run(field, poses, options(kFlange), kMassless);
    for (const StepRecord& step : result.steps) EXPECT_NEAR(step.force, 40.0, 0.02 * 40.0);
    EXPECT_FALSE(has(result, "bounces"));
}

TEST(ForceDynamics, WithoutAForceTheWheelStaysOffTheWork) {
    HeightField field = testing::plate(60.0, 14.0, 0.5, 0.0);
    std::vector<PathPose> poses = {pressing_down(10.0, 7.0, 0.0, 60.0),
                                   pressing_down(25.0, 7.0, 0.0, 60.0),
                                   pressing_down(50.0, 7.0, 0.0, 60.0)};
    for (const ForceDynamics& dynamics : {kFlange, ForceDynamics{0.02, 0.0, 0.0, 0.0}}) {
        poses[0].force = poses[1].force = 0.0;
        poses[2].force = 40.0;
        const auto later = run(field, poses, options(dynamics), kMassless);
        EXPECT_EQ(later.steps.front().force, 0.0f);
        EXPECT_NEAR(later.steps.back().force, 40.0, 1.0);
        poses[0].force = poses[1].force = 40.0;
        poses[2].force = 0.0;
        const auto sooner = run(field, poses, options(dynamics), kMassless);
        EXPECT_NEAR(sooner.steps.front().force, 40.0, 1.0);
        EXPECT_EQ(sooner.steps.back().force, 0.0f);
    }
}

TEST(ForceDynamics, RefusesNonsense) {
    HeightField field = testing::plate(60.0, 14.0, 0.5, 0.0);
    const std::vector<PathPose> poses = {pressing_down(10.0, 7.0, 0.0, 60.0),
                                         pressing_down(25.0, 7.0, 0.0, 60.0)};
    for (const ForceDynamics& wrong :
         {ForceDynamics{-1.0, 0.0, 0.0, 0.0}, ForceDynamics{0.0, -1.0, 0.0, 0.0},
          ForceDynamics{0.0, 1.0, NAN, 0.0}, ForceDynamics{0.0, 1.0, 0.0, HUGE_VAL}}) {
        EXPECT_THROW(run(field, poses, options(wrong), kMassless), InputError);
    }
    SimulationOptions o = options({});
    o.limits.overshoot = -0.1;
    EXPECT_THROW(run(field, poses, o, kMassless), InputError);
    o = options({});
    o.process.wheel_growth = -0.1;
    EXPECT_THROW(run(field, poses, o, kMassless), InputError);
}

TEST(WheelGrowth, IsAWheelThatStandsDeeper) {
    const std::vector<PathPose> poses = {pressing_down(10.0, 7.0, -0.1, 60.0),
                                         pressing_down(50.0, 7.0, -0.1, 60.0)};
    const std::vector<PathPose> deeper = {pressing_down(10.0, 7.0, -0.13, 60.0),
                                          pressing_down(50.0, 7.0, -0.13, 60.0)};
    SimulationOptions o = options({});
    o.process.force_control = false;
    HeightField plain = testing::plate(60.0, 14.0, 0.5, 0.0);
    HeightField grown = plain;
    run(plain, deeper, o, kGrinds);
    o.process.wheel_growth = 0.03;
    const auto result = run(grown, poses, o, kGrinds);
    EXPECT_LT(largest_difference(depths(grown), depths(plain)), 1e-6);
    EXPECT_EQ(result.steps.front().approach, 0.0f);
}

}  // namespace
}  // namespace beltgrinding

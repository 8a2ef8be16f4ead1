// Steps in the stock, taller than what the wheel reaches into or lower than half a cell, and edges
// of the work: all that the belt presses on is ground, and nothing else changes where a cell's
// border lies.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr double kForce = 40.0, kBeltSpeed = 20000.0, kFeed = 40.0;

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = kForce;
    o.process.belt_speed = kBeltSpeed;
    return o;
}

WheelRim rim() {
    WheelRimDesign design;
    design.outer_radius = 60.0;
    design.width = 20.0;
    design.layers = {{10.0, {4.0, 0.45}}};
    return WheelRim(design);
}

/// Integral of the force over the time, N s, of all steps.
double impulse(const SimulationResult& result) {
    double sum = 0.0;
    for (const StepRecord& step : result.steps) sum += step.force * step.duration;
    return sum;
}

/// What is removed over what the linear law removes with the forces of the steps.
double share_of_the_law(const SimulationResult& result, double coefficient) {
    return result.removed_volume / (coefficient * kBeltSpeed * impulse(result));
}

/// A plate with a rib of `height` mm, 5 mm wide, at 30 mm; along y, or turned by `turn`.
HeightField ribbed(double spacing, double height, double turn) {
    HeightField field = testing::plate(60.0, 60.0, spacing);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3 from = field.point[i] - Vec3(30.0, 30.0, 0.0);
        const double across = from.x() * std::cos(turn) + from.y() * std::sin(turn);
        if (std::abs(across) > 2.5) continue;
        field.height[i] = height;
        field.stock_height[i] = static_cast<float>(height);
    }
    return field;
}

TEST(TallSteps, ARibLosesWhatTheLawSays) {
    const WheelRim wheel = rim();
    for (const double height : {0.6, 3.0}) {
        for (const double coefficient : {1e-6, 2e-5, 1.25e-4}) {
            for (const double spacing : {0.35, 0.5}) {
                for (const double turn : {0.0, 0.4, 0.5 * std::numbers::pi}) {
                    HeightField field = ribbed(spacing, height, turn);
                    const ToolPath path({pressing_down(15.0, 30.0, height, kFeed, 0.0),
                                         pressing_down(45.0, 30.0, height, kFeed, 0.0)},
                                        {});
                    const SimulationResult result =
                        simulate(field, path, wheel, LocalLaw({coefficient}), options());
                    EXPECT_NEAR(share_of_the_law(result, coefficient), 1.0, 0.01)
                        << height << " mm, " << coefficient << ", " << spacing << ", " << turn;
                }
            }
        }
    }
}

TEST(TallSteps, ARibLosesItInPositionControl) {
    const WheelRim wheel = rim();
    for (const double spacing : {0.35, 0.5}) {
        HeightField field = ribbed(spacing, 3.0, 0.0);
        SimulationOptions o = options();
        o.process.force_control = false;
        const ToolPath path({pressing_down(15.0, 30.0, 2.6, kFeed, 0.0),
                             pressing_down(45.0, 30.0, 2.6, kFeed, 0.0)},
                            {});
        const SimulationResult result = simulate(field, path, wheel, LocalLaw({2e-5}), o);
        EXPECT_NEAR(share_of_the_law(result, 2e-5), 1.0, 0.01) << spacing;
    }
}

TEST(TallSteps, ATerraceLosesWhatTheLawSays) {
    const WheelRim wheel = rim();
    for (const double height : {0.3, 1.0, 2.0}) {
        for (const double spacing : {0.35, 0.5}) {
            HeightField field = testing::plate(60.0, 60.0, spacing);
            for (std::size_t i = 0; i < field.size(); ++i) {
                if (field.point[i].x() < 30.1) continue;
                field.height[i] = height;
                field.stock_height[i] = static_cast<float>(height);
            }
            const ToolPath path({pressing_down(10.0, 30.0, 0.5 * height, kFeed, 0.0),
                                 pressing_down(50.0, 30.0, 0.5 * height, kFeed, 0.0)},
                                {});
            const SimulationResult result =
                simulate(field, path, wheel, LocalLaw({2e-5}), options());
            EXPECT_NEAR(share_of_the_law(result, 2e-5), 1.0, 0.01) << height << ", " << spacing;
        }
    }
}

/// mm3 that a pass 0.15 mm below the top of a rib takes, which lies beside the cells by `off` mm.
double taken_from_a_rib(double height, double off) {
    HeightField field = ribbed(0.25, height, 0.0);
    SimulationOptions o = options();
    o.process.force_control = false;
    o.resolution.max_travel = 0.5;
    const ToolPath path({pressing_down(20.0 + off, 30.0, height - 0.15, kFeed, 0.0),
                         pressing_down(40.0 + off, 30.0, height - 0.15, kFeed, 0.0)},
                        {});
    return simulate(field, path, rim(), LocalLaw({2e-6}), o).removed_volume;
}

TEST(LowSteps, AWheelThatDoesNotReachTheGroundBesideARibTakesTheSameWhateverItsHeight) {
    for (const double off : {0.0, 0.13}) {
        const double tall = taken_from_a_rib(3.0, off);
        for (const double height : {0.2, 0.35, 0.5, 0.65})
            EXPECT_NEAR(taken_from_a_rib(height, off) / tall, 1.0, 0.03) << height << ", " << off;
    }
}

TEST(LowSteps, ACurvedSurfaceOfFewSamplesHasNone) {
    // A ridge of R 3 mm along y: samples 0.8 mm apart, whose gaps have bands as those of a step.
    const double radius = 3.0;
    const auto at = [&](double u, double v) {
        const double x = u - 2.0;
        return Vec3(x, v, std::sqrt(radius * radius - x * x) - radius);
    };
    const auto normal = [&](double u, double) {
        const double x = u - 2.0;
        return Vec3(x, 0.0, std::sqrt(radius * radius - x * x)).normalized();
    };
    const WheelRim wheel = rim();
    std::vector<double> approach;
    for (const double spacing : {0.8, 0.2}) {
        const HeightField field = testing::mapped_field(4.0, 40.0, spacing, 0.0, at, normal);
        const ToolPath path(
            {pressing_down(0.0, 20.0, 0.0, kFeed, 0.0), pressing_down(0.0, 30.0, 0.0, kFeed, 0.0)},
            {});
        const PoseContact contact = contact_at(field, path, 0, wheel, options().process);
        approach.push_back(contact.placed + contact.solution.approach);
    }
    EXPECT_NEAR(approach[0], approach[1], 0.06 * approach[1]);
}

TEST(TallSteps, AnEdgeCrossesACellWithoutAJump) {
    const WheelRim wheel = rim();
    const ProcessSettings process = options().process;
    for (const bool along : {false, true}) {  // the edge; under the wheel's middle
        std::vector<double> approach, peak;
        const int steps = 24;
        for (int k = 0; k <= steps; ++k) {
            const double off = 0.05 * k;  // mm: more than a cell
            const HeightField field = testing::plate(60.0, 60.0, 0.5);
            const ToolPath path({along ? pressing_down(30.0, off, 0.0, kFeed, 0.0)
                                       : pressing_down(off, 30.0, 0.0, kFeed, 0.0),
                                 pressing_down(30.0, 30.0, 0.0, kFeed, 0.0)},
                                {});
            const PoseContact contact = contact_at(field, path, 0, wheel, process);
            approach.push_back(contact.placed + contact.solution.approach);
            peak.push_back(contact.solution.peak_pressure);
        }
        const double trend = (approach.back() - approach.front()) / steps;
        for (std::size_t k = 1; k < approach.size(); ++k) {
            EXPECT_NEAR(approach[k] - approach[k - 1], trend, 0.01 * approach[0]) << along << k;
        }
        const auto [least, most] = std::minmax_element(peak.begin(), peak.end());
        EXPECT_LT(*most, 1.3 * *least) << along;
    }
}

}  // namespace
}  // namespace beltgrinding

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr double kCoefficient = 2e-5;  // mm2/N
constexpr double kStock = 0.4;         // mm

SimulationOptions options(double travel) {
    SimulationOptions o;
    o.process.wheel = {40.0, 16.0, 60.0};
    o.process.force = 30.0;
    o.process.belt_speed = 20000.0;
    o.resolution.max_travel = travel;
    return o;
}

struct Ground {
    HeightField field;
    double volume;
};

Ground ground(const ToolPath& path, const SimulationOptions& o) {
    HeightField field = testing::plate(70.0, 40.0, 0.4, kStock);
    WheelRimDesign design;
    design.outer_radius = 40.0;
    design.width = 16.0;
    design.layers = {{15.0, {5.0, 0.45}}};
    const WheelRim rim(design);
    const SimulationResult result = simulate(field, path, rim, LocalLaw({kCoefficient}), o);
    return {std::move(field), result.removed_volume};
}

/// Of what is removed, what is so elsewhere, L1, off the ends of the passes.
double off(const Ground& one, const Ground& reference) {
    double sum = 0.0, removed = 0.0;
    for (std::size_t i = 0; i < one.field.size(); ++i) {
        if (std::abs(one.field.point[i].x() - 35.0) > 10.0) continue;
        const double there = reference.field.height[i];
        sum += std::abs(one.field.height[i] - there) * one.field.area[i];
        removed += (kStock - there) * one.field.area[i];
    }
    return sum / removed;
}

/// Three passes side by side, along the belt or across it.
ToolPath passes(bool across) {
    std::vector<PathPose> poses;
    for (int k = 0; k < 3; ++k) {
        const double y = 16.0 + 4.0 * k;
        const double turn = across ? 1.5707963 : 0.0;
        for (const double x : {15.0, 55.0}) {
            PathPose pose = pressing_down(k % 2 == 0 ? x : 70.0 - x, y, kStock, 30.0, turn);
            pose.rapid = x == 15.0;
            poses.push_back(pose);
        }
    }
    return ToolPath(poses, {});
}

// Of first order, with the pressure stamped at the middle of each step on the surface as it was
// before, the rim's L1 is 0.12, 1.1 and 2.6 % along the belt, and 3.2 % across it.
TEST(StepOrder, LongStepsRemoveWhatShortOnesDo) {
    const Ground fine = ground(passes(false), options(0.25));
    EXPECT_LT(off(ground(passes(false), options(1.0)), fine), 0.0006);
    EXPECT_LT(off(ground(passes(false), options(2.0)), fine), 0.0015);
    EXPECT_LT(off(ground(passes(false), options(4.0)), fine), 0.0045);
    EXPECT_LT(off(ground(passes(true), options(4.0)), ground(passes(true), options(0.25))), 0.015);
}

TEST(StepOrder, AWheelThatLandsGrindsForAsLongAsItTouches) {
    // The force control reaches 5 mm: it lands and leaves within steps, whatever their length.
    const ToolPath path({pressing_down(30, 20, 33.3, 30.0), pressing_down(30, 20, 0.0, 30.0),
                         pressing_down(40, 20, 0.0, 30.0), pressing_down(40, 20, 33.3, 30.0)},
                        {});
    for (const bool force : {true, false}) {
        SimulationOptions o = options(0.1);
        o.process.force_control = force;
        const Ground fine = ground(path, o);
        for (const double travel : {1.0, 2.0, 4.0}) {
            o.resolution.max_travel = travel;
            EXPECT_NEAR(ground(path, o).volume / fine.volume, 1.0, 0.01) << force << travel;
        }
    }
}

TEST(StepOrder, APassBackwardsRemovesTheSame) {
    const ToolPath forth({pressing_down(20, 20, 33.0, 30.0), pressing_down(20, 20, 0.2, 30.0),
                          pressing_down(50, 20, 0.2, 30.0), pressing_down(50, 20, 33.0, 30.0)},
                         {});
    const ToolPath mirrored({pressing_down(50, 20, 33.0, 30.0), pressing_down(50, 20, 0.2, 30.0),
                             pressing_down(20, 20, 0.2, 30.0), pressing_down(20, 20, 33.0, 30.0)},
                            {});
    const Ground one = ground(forth, options(4.0)), other = ground(mirrored, options(4.0));
    EXPECT_NEAR(one.volume, other.volume, 1e-6 * one.volume);
}

}  // namespace
}  // namespace beltgrinding

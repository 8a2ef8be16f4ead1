#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/threads.h"
#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "support/poses.h"
#include "support/synthetic_field.h"
#include "surrogate/regression.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr std::uint32_t kNever = RemovalTrace::kNever;

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = 40.0;
    return o;
}

/// Three motions over the same line, the second much slower; the last pose lies beside the plate.
ToolPath thrice() {
    return ToolPath({pressing_down(10, 20, 0.2, 60), pressing_down(50, 20, 0.2, 60),
                     pressing_down(12, 20, 0.2, 10), pressing_down(48, 20, 0.2, 60)},
                    {});
}

HeightField ground(std::uint32_t first_motion, const ToolPath& path) {
    HeightField field = testing::plate(60.0, 40.0, 0.5, 0.2);
    ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.outputs.first_motion = first_motion;
    simulate(field, path, foundation, LocalLaw({1e-5}), o);
    return field;
}

TEST(RemovalTrace, EverySampleKnowsItsMotions) {
    const HeightField field = ground(7, thrice());
    const RemovalTrace& trace = field.trace;
    ASSERT_EQ(trace.first.size(), field.size());
    int middle = 0, beside = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3& p = field.point[i];
        const double removed = 0.2 - field.height[i];
        EXPECT_EQ(trace.first[i] == kNever, removed == 0.0);
        EXPECT_EQ(trace.last[i] == kNever, removed == 0.0);
        EXPECT_LE(trace.dominant_depth[i], removed + 1e-6);
        if (std::abs(p.y() - 20.0) < 8.0 && std::abs(p.x() - 30.0) < 15.0) {
            ++middle;
            EXPECT_EQ(trace.first[i], 8u);
            EXPECT_EQ(trace.dominant[i], 9u);
            EXPECT_EQ(trace.last[i], 10u);
            // At one sixth of the feed it removes six times as much: 6 of 8 parts.
            EXPECT_NEAR(trace.dominant_depth[i], 0.75 * removed, 0.02 * removed);
            EXPECT_GT(trace.peak_pressure[i], 0.1F);
        } else if (std::abs(p.y() - 20.0) > 11.0) {
            ++beside;
            EXPECT_FALSE(trace.touched(i));
            EXPECT_EQ(trace.dominant_depth[i], 0.0F);
        }
    }
    EXPECT_GT(middle, 1000);
    EXPECT_GT(beside, 1000);
}

TEST(RemovalTrace, TheDominantDepthIsWhatTheMotionAloneRemovedInAllItsSteps) {
    // The sum of the heights' changes, motion by motion, kept outside of the simulation.
    HeightField field = testing::plate(60.0, 40.0, 0.8, 0.2);
    ElasticFoundation foundation(0.5);
    const std::vector<PathPose> poses = thrice().poses();
    std::vector<std::map<std::uint32_t, double>> removed(field.size());
    for (std::uint32_t k = 1; k < poses.size(); ++k) {
        const std::vector<double> before = field.height;
        SimulationOptions o = options();
        o.outputs.first_motion = k - 1;
        simulate(field, ToolPath({poses[k - 1], poses[k]}, {}), foundation, LocalLaw({1e-5}), o);
        for (std::size_t i = 0; i < field.size(); ++i) {
            if (before[i] > field.height[i]) removed[i][k] = before[i] - field.height[i];
        }
    }
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (removed[i].empty()) {
            EXPECT_EQ(field.trace.first[i], kNever);
            continue;
        }
        const auto most =
            std::max_element(removed[i].begin(), removed[i].end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        EXPECT_EQ(field.trace.first[i], removed[i].begin()->first);
        EXPECT_EQ(field.trace.last[i], removed[i].rbegin()->first);
        EXPECT_NEAR(field.trace.dominant_depth[i], most->second, 1e-5 * most->second + 1e-9);
        // Motions that remove the same to rounding may stand for each other.
        EXPECT_NEAR(removed[i].at(field.trace.dominant[i]), most->second, 1e-5 * most->second);
    }
}

TEST(RemovalTrace, PressureWithoutRemovalIsContact) {
    HeightField field = testing::plate(60.0, 40.0, 0.5, 0.2);
    ElasticFoundation foundation(0.5);
    LocalLawParameters law{1e-5};
    law.pressure_threshold = 100.0;  // MPa: nothing is ground
    simulate(field, thrice(), foundation, LocalLaw(law), options());
    std::size_t touched = 0;
    float peak = 0.0F;
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_EQ(field.trace.first[i], kNever);
        if (field.trace.touched(i)) ++touched;
        peak = std::max(peak, field.trace.peak_pressure[i]);
    }
    EXPECT_GT(touched, field.size() / 4);
    // Winkler: F = w k (2/3) (2 c) c^2 / (2 R), p = k c^2 / (2 R); c half the contact's length.
    const double half = std::cbrt(40.0 * 3.0 * 60.0 / (2.0 * 20.0 * 0.5));
    EXPECT_NEAR(peak, 0.5 * half * half / 120.0, 0.03 * peak);
}

TEST(RemovalTrace, ARigidToolTouchesWhereItCuts) {
    HeightField field = testing::plate(40.0, 40.0, 0.5, 0.3);
    Geometric tool;
    SimulationOptions o = options();
    o.process.force_control = false;
    simulate(field, ToolPath({pressing_down(10, 20, 0.1, 20), pressing_down(30, 20, 0.1, 20)}, {}),
             tool, LocalLaw({1e-4}), o);
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_EQ(field.trace.touched(i), field.height[i] < 0.3);
        EXPECT_EQ(field.trace.peak_pressure[i], 0.0F);
    }
}

TEST(RemovalTrace, IsTheSameOnOneAndTwoThreads) {
    std::vector<HeightField> fields;
    for (const std::size_t count : {1, 2}) {
        set_threads(count);
        fields.push_back(ground(0, thrice()));
    }
    set_threads(0);
    EXPECT_EQ(fields[0].height, fields[1].height);
    EXPECT_EQ(fields[0].trace.first, fields[1].trace.first);
    EXPECT_EQ(fields[0].trace.last, fields[1].trace.last);
    EXPECT_EQ(fields[0].trace.dominant, fields[1].trace.dominant);
    EXPECT_EQ(fields[0].trace.dominant_depth, fields[1].trace.dominant_depth);
    EXPECT_EQ(fields[0].trace.peak_pressure, fields[1].trace.peak_pressure);
}

TEST(RemovalTrace, GoesOnFromPathToPathAndIsKeptOutOfAFailedOne) {
    HeightField field = ground(0, thrice());
    const RemovalTrace before = field.trace;
    ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.outputs.first_motion = 4;
    const ToolPath far({pressing_down(0, 0, 100.0, 20.0), pressing_down(9, 0, 100.0, 20.0)}, {});
    EXPECT_THROW(simulate(field, far, foundation, LocalLaw({1e-4}), o), InputError);
    EXPECT_EQ(field.trace.last, before.last);
    EXPECT_EQ(field.trace.peak_pressure, before.peak_pressure);
    const ToolPath over({pressing_down(30, 5, 0.0, 20.0), pressing_down(30, 35, 0.0, 20.0)}, {});
    simulate(field, over, foundation, LocalLaw({1e-5}), o);
    std::size_t later = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (before.first[i] != kNever) {
            EXPECT_EQ(field.trace.first[i], before.first[i]);
        }
        EXPECT_GE(field.trace.peak_pressure[i], before.peak_pressure[i]);
        later += field.trace.last[i] == 5 ? 1 : 0;
    }
    EXPECT_GT(later, 500u);
    o.outputs.trace = false;
    simulate(field, over, foundation, LocalLaw({1e-5}), o);
    EXPECT_TRUE(field.trace.empty());
}

}  // namespace
}  // namespace beltgrinding

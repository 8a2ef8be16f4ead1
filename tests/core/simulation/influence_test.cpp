#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr float kOfDeepest =
    0.05F;  // what is removed at the contact's edge changes with the contact

PathPose pressing_down(double x, double y, double feed, bool rapid = false) {
    PathPose pose;
    pose.base_from_tcp = Eigen::Translation3d(x, y, 0.2) * Eigen::AngleAxisd(M_PI, Vec3::UnitX());
    pose.feed = feed;
    pose.rapid = rapid;
    return pose;
}

ToolPath to_and_fro(double second_feed = 30.0) {
    return ToolPath({pressing_down(10, 20, 60), pressing_down(50, 20, 60),
                     pressing_down(50, 22, 60, true), pressing_down(12, 22, second_feed),
                     pressing_down(12, 36, 60), pressing_down(12, 38, 60, true)},
                    {});
}

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = 40.0;
    o.outputs.influence = true;
    return o;
}

SimulationResult ground(HeightField& field, const ToolPath& path, double coefficient = 1e-6) {
    ElasticFoundation foundation(0.5);
    return simulate(field, path, foundation, LocalLaw({coefficient}), options());
}

TEST(Influence, SumsUpToWhatIsGone) {
    HeightField field = testing::plate(60.0, 40.0, 0.5, 0.2);
    const SimulationResult result = ground(field, to_and_fro());
    const Influence& a = result.influence;
    ASSERT_EQ(a.motions(), 6u);
    std::vector<double> gone(field.size(), 0.0);
    for (std::size_t j = 0; j < a.motions(); ++j) {
        for (std::size_t e = a.first[j]; e < a.first[j + 1]; ++e) {
            EXPECT_GT(a.depth[e], 0.0F);
            if (e > a.first[j]) {
                EXPECT_LT(a.sample[e - 1], a.sample[e]);
            }
            gone[a.sample[e]] += a.depth[e];
        }
    }
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_NEAR(gone[i], 0.2 - field.height[i], 1e-7) << i;
    }
    EXPECT_EQ(a.first[0], a.first[1]);  // the way to the first pose
    EXPECT_EQ(a.first[2], a.first[3]);  // a rapid one
    EXPECT_EQ(a.first[5], a.first[6]);
    EXPECT_LT(a.first[3], a.first[4]);
}

TEST(Influence, IsTheSlopeOfTheHeightsToTheTimeThatAMotionTakes) {
    // Central differences of whole simulations, the second pass 2 % faster and slower.
    HeightField field = testing::plate(60.0, 40.0, 0.5, 0.2);
    const Influence a = ground(field, to_and_fro()).influence;
    HeightField slow = testing::plate(60.0, 40.0, 0.5, 0.2), fast = slow;
    ground(slow, to_and_fro(30.0 / 1.02));
    ground(fast, to_and_fro(30.0 / 0.98));
    const float deepest = *std::max_element(a.depth.begin() + static_cast<long>(a.first[3]),
                                            a.depth.begin() + static_cast<long>(a.first[4]));
    int seen = 0, near = 0;
    for (std::size_t e = a.first[3]; e < a.first[4]; ++e) {
        const std::uint32_t s = a.sample[e];
        const bool later = std::find(a.sample.begin() + static_cast<long>(a.first[4]),
                                     a.sample.end(), s) != a.sample.end();
        if (later || a.depth[e] < kOfDeepest * deepest) continue;  // later motions change, too
        const double slope = (fast.height[s] - slow.height[s]) / 0.04;
        EXPECT_NEAR(a.depth[e], slope, 0.02 * slope) << s;
        near += std::abs(a.depth[e] - slope) <= 0.01 * slope ? 1 : 0;
        ++seen;
    }
    EXPECT_GT(seen, 1000);
    EXPECT_GT(near, 0.99 * seen);
}

TEST(Influence, GroupsAndChainsAddUp) {
    Influence a, b;
    a.first = {0, 2, 3};
    a.sample = {1, 4, 4};
    a.depth = {0.1F, 0.2F, 0.3F};
    b.first = {0, 1};
    b.sample = {2};
    b.depth = {0.5F};
    a.append(b);
    EXPECT_EQ(a.first, (std::vector<std::size_t>{0, 2, 3, 4}));
    const std::vector<std::uint32_t> group = {1, 1, 0};
    const Influence g = a.grouped(group, 3);
    EXPECT_EQ(g.first, (std::vector<std::size_t>{0, 1, 3, 3}));
    EXPECT_EQ(g.sample, (std::vector<std::uint32_t>{2, 1, 4}));
    EXPECT_FLOAT_EQ(g.depth[2], 0.5F);
    EXPECT_THROW(a.grouped(group, 1), InputError);
    EXPECT_THROW(b.grouped(group, 3), InputError);
}

}  // namespace
}  // namespace beltgrinding

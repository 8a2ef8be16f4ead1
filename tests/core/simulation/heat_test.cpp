#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/threads.h"
#include "beltgrinding/heat.h"
#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

PathPose pressing_down(double x, double y) {
    PathPose pose;
    pose.base_from_tcp = Eigen::Translation3d(x, y, 0.2) * Eigen::AngleAxisd(M_PI, Vec3::UnitX());
    pose.feed = 30.0;
    return pose;
}

/// K, of each sample of a plate of which those `without` tells have no area.
template <class Without>
std::vector<float> rise(Without without) {
    HeightField field = testing::plate(60.0, 40.0, 0.5, 0.2);
    for (std::size_t s = 0; s < field.size(); ++s)
        if (without(field.point[s])) field.area[s] = 0.0f;
    PartHeat part(field, 1.0, {15.0, 500.0, 7900.0});
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = 40.0;
    o.heat.part = &part;
    o.heat.friction = 0.4;
    o.heat.partition = 0.5;
    ElasticFoundation foundation(0.5);
    simulate(field, ToolPath({pressing_down(15, 20), pressing_down(45, 20)}, {}), foundation,
             LocalLaw({1e-6}), o);
    return field.heat.rise;
}

TEST(Heat, ASampleWithoutAreaSpoilsNothing) {
    const auto middle = [](const Vec3& p) {
        return std::abs(p.x() - 30.0) < 2.0 && std::abs(p.y() - 20.0) < 2.0;
    };
    const std::vector<float> whole = rise([](const Vec3&) { return false; });
    const std::vector<float> holed = rise(middle);
    ASSERT_EQ(whole.size(), holed.size());
    const float most = *std::max_element(whole.begin(), whole.end());
    EXPECT_GT(most, 10.0f);
    // What has no area lets its share to the others, which are as hot beside it as before, or more.
    const HeightField field = testing::plate(60.0, 40.0, 0.5, 0.2);
    int seen = 0;
    for (std::size_t s = 0; s < holed.size(); ++s) {
        ASSERT_TRUE(std::isfinite(holed[s])) << s;
        const Vec3& p = field.point[s];
        if (std::abs(p.x() - 30.0) > 3.0 || std::abs(p.y() - 20.0) < 5.0) continue;
        if (whole[s] < 0.5f * most) continue;
        EXPECT_GT(holed[s], 0.95f * whole[s]) << p.transpose();
        EXPECT_LT(holed[s], 1.3f * whole[s]) << p.transpose();
        ++seen;
    }
    EXPECT_GT(seen, 50);
}

TEST(Heat, IsTheSameOnOneAndTwoThreads) {
    const auto all = [](const Vec3&) { return false; };
    set_threads(1);
    const std::vector<float> one = rise(all);
    set_threads(2);
    const std::vector<float> two = rise(all);
    set_threads(0);
    EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace beltgrinding

#include "gap/wheel_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

struct Cloud {
    std::vector<Vec3> point, normal;
};

/// The inside of half a cylinder of `radius` about the y axis, open upwards; lowest at the origin.
Cloud trough(double radius) {
    Cloud cloud;
    for (int i = -90; i <= 90; ++i)
        for (int j = -30; j <= 30; ++j) {
            const double t = i * std::numbers::pi / 180;
            const Vec3 out(std::sin(t), 0, -std::cos(t));
            cloud.point.push_back(radius * out + Vec3(0, j, radius));
            cloud.normal.push_back(-out);
        }
    return cloud;
}

Frame pressing_down() {
    Frame frame = Frame::Identity();
    frame.linear() = Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()).toRotationMatrix();
    return frame;
}

ContactWheel wheel_of(double radius, double width) {
    ContactWheel wheel;
    wheel.radius = radius;
    wheel.width = width;
    return wheel;
}

TEST(WheelFit, FindsAConcavePlaceThatIsTighterThanTheWheel) {
    const Cloud cloud = trough(30.0);
    const auto depth = [&](double radius) {
        return wheel_fit(wheel_of(radius, 20), {pressing_down()}, cloud.point, cloud.normal)[0];
    };
    EXPECT_NEAR(depth(20.0), 0.0, 1e-9);
    EXPECT_NEAR(depth(29.9), 0.0, 1e-9);
    // The trough's rim at (30, 30) from the contact, the wheel's centre 50 above it.
    EXPECT_NEAR(depth(50.0), 50.0 - std::hypot(30.0, 20.0), 1e-3);
}

TEST(WheelFit, HeedsWidthAndCrown) {
    // A wall beside a plate, 15 mm from the contact.
    Cloud cloud;
    for (int i = -20; i <= 20; ++i) {
        for (int j = 0; j <= 15; ++j) {
            cloud.point.push_back(Vec3(i, j, 0));
            cloud.normal.push_back(Vec3::UnitZ());
        }
        cloud.point.push_back(Vec3(i, 15, 4));
        cloud.normal.push_back(Vec3(0, -1, 1).normalized());
    }
    const std::vector<Frame> pose{pressing_down()};
    EXPECT_EQ(wheel_fit(wheel_of(40, 28), pose, cloud.point, cloud.normal)[0], 0.0);
    EXPECT_NEAR(wheel_fit(wheel_of(40, 32), pose, cloud.point, cloud.normal)[0], 4.0, 1e-9);
    ContactWheel crowned = wheel_of(40, 32);
    crowned.crown_radius = 25;
    EXPECT_NEAR(wheel_fit(crowned, pose, cloud.point, cloud.normal)[0], 0.0, 1e-9);
}

TEST(RunFit, CountsWhatReachesThroughTheFlatBelt) {
    // Pressing down: x stays, y and z are turned round; behind the belt is above it.
    FlatRun run;
    run.length = 100.0;
    run.middle = 10.0;
    run.width = 30.0;
    run.behind = 40.0;
    const auto depth = [&](const Vec3& point) {
        return run_fit(run, {pressing_down()}, {point, Vec3(0, 0, -5)})[0];
    };
    EXPECT_EQ(depth({0, 0, -1}), 0.0);
    EXPECT_NEAR(depth({0, 14, 3}), 3.0, 1e-12);
    EXPECT_EQ(depth({0, 16, 3}), 0.0);  // beside it
    EXPECT_NEAR(depth({59, 0, 7}), 7.0, 1e-12);
    EXPECT_EQ(depth({-41, 0, 7}), 0.0);  // beyond its roller
    EXPECT_NEAR(depth({0, 0, 39}), 39.0, 1e-12);
    EXPECT_EQ(depth({0, 0, 41}), 0.0);  // above the belt that runs back
    run.width = -1.0;
    EXPECT_THROW(run_fit(run, {}, {}), InputError);
}

TEST(RunFit, TurnsWithThePose) {
    FlatRun run;
    Frame frame = pressing_down();
    frame.linear() = frame.linear() * Eigen::AngleAxisd(0.1, Vec3::UnitX()).toRotationMatrix();
    frame.translation() = Vec3(0, 0, 1);
    const Vec3 point(0, 10, 4);
    const Vec3 at = frame.inverse() * point;
    ASSERT_LT(at.z(), 0.0);
    EXPECT_NEAR(run_fit(run, {frame}, {point})[0], -at.z(), 1e-12);
}

}  // namespace
}  // namespace beltgrinding

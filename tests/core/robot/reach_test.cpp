#include "robot/reach.h"

#include <gtest/gtest.h>

#include "beltgrinding/error.h"
#include "robot/arms.h"
#include "robot/inverse_kinematics.h"

namespace beltgrinding {
namespace {

using testing::degrees;
using testing::kDegree;

PathPose posed(const Frame& frame, bool rapid = false, double feed = 100.0) {
    PathPose pose;
    pose.base_from_tcp = frame;
    pose.rapid = rapid;
    pose.feed = feed;
    return pose;
}

ToolPath path_of(std::vector<PathPose> poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].line = static_cast<int>(10 * (i + 1));
    return ToolPath(std::move(poses), {});
}

std::vector<Event> of_kind(const ReachResult& result, const std::string& kind) {
    std::vector<Event> found;
    for (const Event& event : result.events)
        if (event.kind == kind) found.push_back(event);
    return found;
}

Frame moved(const Frame& frame, const Vec3& by) {
    Frame f = frame;
    f.translation() += by;
    return f;
}

/// A frame with the flange's wrist beside or through the line of axis 4: joints with q5 = 0 there.
struct WristCase {
    RobotArm arm{testing::wrist_arm()};
    Joints aligned = degrees(0, -80, 80, 0, 0, 0);  // q4 = q6 = 0
    /// The flange turned by `tilt` about the flange's y, then by `aside` about its x.
    Frame at(double tilt, double aside) const {
        Frame f = arm.forward(aligned);
        // About the wrist's centre, so that only joints 4 to 6 move.
        const Vec3 centre = f.translation() - 80.0 * f.linear().col(2);
        f.linear() = f.linear() * (Eigen::AngleAxisd(aside, Vec3::UnitX()) *
                                   Eigen::AngleAxisd(tilt, Vec3::UnitY()))
                                      .toRotationMatrix();
        f.translation() = centre + 80.0 * f.linear().col(2);
        return f;
    }
};

TEST(Reach, APathWellInsideHasNoEvents) {
    const RobotArm arm(testing::wrist_arm());
    const Frame start = arm.forward(degrees(10, -70, 80, 20, 50, 30));
    const ToolPath path = path_of(
        {posed(start, true), posed(moved(start, {30, 0, 0})), posed(moved(start, {30, 40, -20}))});
    const ReachResult result = check_reach(path, arm, {});
    EXPECT_TRUE(result.events.empty());
    ASSERT_EQ(result.joints.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const Frame is = arm.forward(result.joints[i]);
        EXPECT_TRUE(is.isApprox(path.poses()[i].base_from_tcp, 1e-9));
    }
    EXPECT_GT(result.checks, 70u);
}

TEST(Reach, ToolAndBaseFramesAreTakenOff) {
    const RobotArm arm(testing::wrist_arm());
    ReachOptions options;
    options.base_from_robot =
        Eigen::Translation3d(1000, -200, 300) * Eigen::AngleAxisd(0.7, Vec3(1, 1, 3).normalized());
    options.flange_from_tcp =
        Eigen::Translation3d(10, 20, 150) * Eigen::AngleAxisd(0.3, Vec3::UnitX());
    const Joints q = degrees(10, -70, 80, 20, 50, 30);
    const Frame start = options.base_from_robot * arm.forward(q) * options.flange_from_tcp;
    options.start = q;
    const ReachResult result = check_reach(path_of({posed(start, true)}), arm, options);
    EXPECT_NEAR((result.joints[0] - q).norm(), 0.0, 1e-9);
}

TEST(Reach, TheStartDecidesTheConfiguration) {
    const RobotArm arm(testing::wrist_arm());
    const Joints q = degrees(10, -70, 80, 20, 50, 30);
    const ToolPath path = path_of({posed(arm.forward(q), true)});
    for (const ArmSolution& s : inverse(arm, arm.forward(q), Joints::Zero())) {
        if (((s.q - arm.lower()).array() < 0.0).any()) continue;
        if (((arm.upper() - s.q).array() < 0.0).any()) continue;
        ReachOptions options;
        options.start = s.q + Joints::Constant(0.01);
        EXPECT_NEAR((check_reach(path, arm, options).joints[0] - s.q).norm(), 0.0, 1e-9);
    }
}

TEST(Reach, OutOfReachNamesThePoseAndTheDistance) {
    const RobotArm arm(testing::wrist_arm());
    const Frame start = arm.forward(degrees(0, -45, 60, 0, 40, 0));
    const ToolPath path = path_of({posed(start, true), posed(moved(start, {600, 0, 0})),
                                   posed(start), posed(moved(start, {0, 5, 0}))});
    const ReachResult result = check_reach(path, arm, {});
    const auto events = of_kind(result, "out_of_reach");
    ASSERT_EQ(events.size(), 1u);  // out and back is one stretch
    EXPECT_EQ(events[0].pose, 1u);
    EXPECT_EQ(events[0].line, 20);
    EXPECT_GT(events[0].value, 100.0);
    EXPECT_GT(events[0].duration, 1.0);
    EXPECT_FALSE(result.joints[1].allFinite());
    EXPECT_TRUE(result.joints[2].allFinite());
    EXPECT_TRUE(of_kind(result, "wrist_flip").empty());
}

TEST(Reach, ALimitIsNamedWithItsJoint) {
    const RobotArm arm(testing::wrist_arm());
    const Joints q = degrees(160, -70, 80, 20, 50, 30);
    const Frame start = arm.forward(q);
    // Around axis 1, which ends at 170 degrees.
    std::vector<PathPose> poses{posed(start, true)};
    for (int k = 1; k <= 20; ++k) {
        Joints on = q;
        on[0] += k * kDegree;
        poses.push_back(posed(arm.forward(on)));
    }
    ReachOptions options;
    options.start = q;
    const auto events = of_kind(check_reach(path_of(poses), arm, options), "joint_limit");
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].pose, 11u);
    EXPECT_NEAR(events[0].value, 10.0, 1e-6);
    EXPECT_NE(events[0].message().find("joint 1"), std::string::npos);
    EXPECT_NE(events[0].message().find("170.0"), std::string::npos);
}

TEST(Reach, WindingUpIsALimitThatAnotherTurnWouldFit) {
    const RobotArm arm(testing::wrist_arm());
    Joints q = degrees(0, -70, 80, 0, 50, 300);
    std::vector<PathPose> poses{posed(arm.forward(q), true)};
    for (int k = 1; k <= 8; ++k) {
        Joints on = q;
        on[5] += 10 * k * kDegree;
        poses.push_back(posed(arm.forward(on)));
    }
    ReachOptions options;
    options.start = q;
    const auto events = of_kind(check_reach(path_of(poses), arm, options), "joint_limit");
    ASSERT_EQ(events.size(), 1u);
    EXPECT_NEAR(events[0].value, 30.0, 1e-6);
    EXPECT_NE(events[0].message().find("would fit at 20.0"), std::string::npos);
    // Without a start given, the turn is chosen that lasts.
    EXPECT_TRUE(check_reach(path_of(poses), arm, {}).events.empty());
}

TEST(Reach, PassingCloseByTheWristSingularityIsAFlip) {
    const WristCase wrist;
    const double aside = 0.05 * kDegree;
    const ToolPath path = path_of(
        {posed(wrist.at(-20 * kDegree, aside), true), posed(wrist.at(20 * kDegree, aside))});
    ReachOptions options;
    options.start = degrees(0, -80, 80, 0, -20, 0);
    const ReachResult result = check_reach(path, wrist.arm, options);
    const auto flips = of_kind(result, "wrist_flip");
    ASSERT_EQ(flips.size(), 1u);
    EXPECT_EQ(flips[0].pose, 1u);
    EXPECT_EQ(flips[0].line, 20);
    EXPECT_GT(flips[0].value, 90.0);
    EXPECT_NE(flips[0].message().find("joint 4"), std::string::npos);
    // The branch is kept: joint 5 has its sign, joints 4 and 6 have turned by half a turn.
    EXPECT_LT(result.joints[1][4], 0.0);
    EXPECT_NEAR(std::abs(result.joints[1][3]), M_PI, 0.01);
    const auto near = of_kind(result, "singularity");
    ASSERT_EQ(near.size(), 1u);
    EXPECT_LT(near[0].value, 0.6);  // half of the way between two checks
    EXPECT_FALSE(of_kind(result, "joint_speed").empty());
}

TEST(Reach, StraightThroughTheWristSingularityIsNone) {
    const WristCase wrist;
    const ToolPath path =
        path_of({posed(wrist.at(-20 * kDegree, 0.0), true), posed(wrist.at(20 * kDegree, 0.0))});
    ReachOptions options;
    options.start = degrees(0, -80, 80, 0, -20, 0);
    const ReachResult result = check_reach(path, wrist.arm, options);
    EXPECT_TRUE(of_kind(result, "wrist_flip").empty());
    EXPECT_NEAR(result.joints[1][4], 20 * kDegree, 1e-6);
    ASSERT_EQ(of_kind(result, "singularity").size(), 1u);
}

TEST(Reach, FarBesideTheWristSingularityTheWristTurnsSlowly) {
    const WristCase wrist;
    const double aside = 15 * kDegree;
    const ToolPath path = path_of({posed(wrist.at(-20 * kDegree, aside), true),
                                   posed(wrist.at(20 * kDegree, aside), false, 1.0)});
    const ReachResult result = check_reach(path, wrist.arm, {});
    EXPECT_TRUE(result.events.empty());
    EXPECT_GT(std::abs(result.joints[1][3] - result.joints[0][3]), 90 * kDegree);
}

TEST(Reach, RapidMotionsChangeTheConfigurationWithoutAFlip) {
    const WristCase wrist;
    std::vector<PathPose> poses{posed(wrist.at(-20 * kDegree, 0.05 * kDegree), true),
                                posed(wrist.at(20 * kDegree, 0.05 * kDegree), true)};
    const ReachResult result = check_reach(path_of(poses), wrist.arm, {});
    EXPECT_TRUE(result.events.empty());
}

TEST(Reach, SpeedIsComparedWithTheFastestOfTheJoint) {
    const RobotArm arm(testing::wrist_arm());
    const Joints q = degrees(0, -70, 80, 0, 50, 0);
    const Frame start = arm.forward(q);
    // The wrist goes 5 mm along the circle about axis 1 at 10 m/s: joint 1 turns at v / r.
    const double radius = arm.placed(q).wrist.head<2>().norm();
    const Frame end = moved(start, {0, 5, 0});
    const double feed = 10'000.0;
    const ReachResult result =
        check_reach(path_of({posed(start, true), posed(end, false, feed)}), arm, {});
    const auto events = of_kind(result, "joint_speed");
    ASSERT_FALSE(events.empty());
    double first = 0.0;
    for (const Event& event : events)
        if (event.message().find("joint 1 ") != std::string::npos) first = event.value;
    EXPECT_NEAR(first, feed / radius / (300 * kDegree), 0.01 * first);
    // At a tenth of the limit, none.
    const double slow = 0.1 * 300 * kDegree * radius;
    EXPECT_TRUE(check_reach(path_of({posed(start, true), posed(end, false, slow)}), arm, {})
                    .events.empty());
}

TEST(Reach, ACalibratedArmIsFollowedNumerically) {
    const RobotArm exact(testing::parallel_arm()), real(testing::calibrated_arm());
    const Joints q = degrees(20, -70, 80, -100, 70, 10);
    const Frame start = exact.forward(q);
    const ToolPath path = path_of({posed(start, true), posed(moved(start, {50, 20, -40}))});
    ReachOptions options;
    options.start = q;
    const ReachResult a = check_reach(path, exact, options);
    const ReachResult b = check_reach(path, real, options);
    EXPECT_TRUE(a.events.empty());
    EXPECT_TRUE(b.events.empty());
    EXPECT_LT((a.joints[1] - b.joints[1]).norm(), 0.1);
    EXPECT_TRUE(real.forward(b.joints[1]).isApprox(path.poses()[1].base_from_tcp, 1e-8));
}

TEST(Reach, EndsWhenCancelled) {
    const RobotArm arm(testing::wrist_arm());
    const RunContext context;
    context.cancel();
    const ToolPath path = path_of({posed(arm.forward(degrees(0, -70, 80, 0, 50, 0)), true)});
    EXPECT_THROW(check_reach(path, arm, {}, context), Cancelled);
    ReachOptions wrong;
    wrong.max_travel = 0.0;
    EXPECT_THROW(check_reach(path, arm, wrong), InputError);
}

}  // namespace
}  // namespace beltgrinding

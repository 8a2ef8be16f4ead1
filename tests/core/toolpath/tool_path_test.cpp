#include "beltgrinding/tool_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

PathPose pose_at(double x, double y, double z, double feed = 10.0, double angle = 0.0) {
    PathPose pose;
    pose.base_from_tcp =
        Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(angle, Vec3(1, 2, 2).normalized());
    pose.feed = feed;
    return pose;
}

TEST(ToolPath, TakesTheProgrammedTime) {
    const ToolPath path({pose_at(0, 0, 0), pose_at(30, 40, 0, 10.0), pose_at(30, 40, 20, 5.0)}, {});
    EXPECT_NEAR(path.duration(), 5.0 + 4.0, 1e-12);
    double sum = 0.0;
    for (const PathStep& step : path.steps({})) sum += step.duration;
    EXPECT_NEAR(sum, path.duration(), 1e-9);
}

TEST(ToolPath, InterpolatesPositionLinearlyAndOrientationBySlerp) {
    const ToolPath path({pose_at(0, 0, 0), pose_at(10, 0, 0, 10.0, 1.0)}, {});
    const auto steps = path.steps({1.0, 0.5, 50.0});
    ASSERT_EQ(steps.size(), 10u);
    for (const PathStep& step : steps) {
        const double t = step.time;  // 1 s in all
        EXPECT_NEAR(step.work_from_contact.translation().x(), 10.0 * t, 1e-9);
        const Eigen::AngleAxisd turned(step.work_from_contact.linear());
        EXPECT_NEAR(turned.angle(), t, 1e-9);
        EXPECT_NEAR(turned.axis().dot(Vec3(1, 2, 2).normalized()), 1.0, 1e-9);
        EXPECT_NEAR(step.feed, 10.0, 1e-9);
    }
}

TEST(ToolPath, AStepTellsHowTheContactMovesFromItsBeginToItsEnd) {
    const ToolPath path({pose_at(0, 0, 0), pose_at(10, 4, 2, 10.0, 0.6)}, {});
    const auto steps = path.steps({2.0, 0.5, 50.0});
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const Frame& middle = steps[k].work_from_contact;
        const Vec3 way = (path.base_from_tcp(1, steps[k].end).translation() -
                          path.base_from_tcp(1, steps[k].begin).translation());
        EXPECT_LT((middle.linear() * steps[k].moved - way).norm(), 1e-12);
        const double angle = 0.6 * (steps[k].end - steps[k].begin);
        EXPECT_LT((steps[k].turned - angle * Vec3(1, 2, 2).normalized()).norm(), 1e-9);
    }
}

TEST(ToolPath, AStepIsCutIntoStepsOfTheSameWayAndTime) {
    for (const auto timing : {TimeLaw::Timing::kConstantFeed, TimeLaw::Timing::kTrapezoidal}) {
        TimeLaw law;
        law.timing = timing;
        const ToolPath path({pose_at(0, 0, 0), pose_at(7, 0, 0, 10.0, 0.3), pose_at(7, 9, 0)}, {},
                            law);
        for (const PathStep& whole : path.steps({3.0, 1.0, 50.0})) {
            std::vector<PathStep> parts = path.cut(whole, 4);
            const std::vector<PathStep> again = path.cut(parts[1], 2);  // a part may be cut again
            parts.erase(parts.begin() + 1);
            parts.insert(parts.begin() + 1, again.begin(), again.end());
            double time = whole.time - 0.5 * whole.duration, share = whole.begin;
            for (const PathStep& part : parts) {
                EXPECT_NEAR(part.time - 0.5 * part.duration, time, 1e-9);
                EXPECT_NEAR(part.begin, share, 1e-12);
                time += part.duration;
                share = part.end;
                EXPECT_EQ(part.pose, whole.pose);
                EXPECT_EQ(part.force, whole.force);
            }
            EXPECT_NEAR(time, whole.time + 0.5 * whole.duration, 1e-9);
            EXPECT_NEAR(share, whole.end, 1e-12);
            // Halves stand on both sides of the whole's place.
            const std::vector<PathStep> halves = path.cut(whole, 2);
            const Vec3 middle = 0.5 * (halves[0].work_from_contact.translation() +
                                       halves[1].work_from_contact.translation());
            EXPECT_LT((middle - whole.work_from_contact.translation()).norm(), 0.05);
        }
    }
}

TEST(ToolPath, StepsAreNeverLongerThanAsked) {
    const ToolPath path({pose_at(0, 0, 0), pose_at(7.3, 0, 0, 10.0, 0.3), pose_at(7.3, 9, 0)}, {});
    const auto steps = path.steps({0.5, 0.01, 50.0});
    for (const PathStep& step : steps) EXPECT_LE(step.feed * step.duration, 0.5 + 1e-9);
    EXPECT_GE(steps.size(), 30u + 30u);  // 0.3 rad each way by 0.01
}

TEST(ToolPath, RapidMotionsGrindNothingButTakeTime) {
    auto poses = std::vector<PathPose>{pose_at(0, 0, 0), pose_at(10, 0, 0), pose_at(20, 0, 0)};
    poses[1].rapid = true;
    const ToolPath path(poses, {});
    for (const PathStep& step : path.steps({})) EXPECT_EQ(step.pose, 2u);
    EXPECT_NEAR(path.duration(), 2.0, 1e-12);
    EXPECT_GT(path.steps({}).front().time, 1.0);
}

TEST(ToolPath, ForceComesFromThePoseOrTheJob) {
    auto poses = std::vector<PathPose>{pose_at(0, 0, 0), pose_at(1, 0, 0), pose_at(2, 0, 0)};
    poses[1].force = 12.0;
    const auto steps = ToolPath(poses, {}).steps({1.0, 1.0, 77.0});
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(steps[0].force, 12.0);
    EXPECT_EQ(steps[1].force, 77.0);
}

// The same relative motion of wheel and work, described once with the tool in hand and once with
// the part in hand, gives the same contact frames.
TEST(CellFrames, ToolInHandAndPartInHandAgree) {
    const Frame work_from_contact =
        Eigen::Translation3d(10, -20, 30) * Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized());
    const Frame base_from_work =
        Eigen::Translation3d(500, 100, 50) * Eigen::AngleAxisd(1.1, Vec3::UnitX());
    const Frame tcp_from_contact =
        Eigen::Translation3d(0, 5, 80) * Eigen::AngleAxisd(-0.4, Vec3::UnitY());
    CellFrames tool;
    tool.base_from_work = base_from_work;
    tool.tcp_from_contact = tcp_from_contact;
    const Frame tool_pose = base_from_work * work_from_contact * tcp_from_contact.inverse();
    EXPECT_TRUE(tool.work_from_contact(tool_pose).isApprox(work_from_contact, 1e-12));

    CellFrames part;
    part.holding = Holding::kPartInHand;
    part.tcp_from_work = base_from_work;
    part.base_from_contact = tcp_from_contact;
    const Frame part_pose =
        tcp_from_contact * work_from_contact.inverse() * base_from_work.inverse();
    EXPECT_TRUE(part.work_from_contact(part_pose).isApprox(work_from_contact, 1e-12));
}

std::string error_of(std::vector<PathPose> poses) {
    try {
        ToolPath(std::move(poses), {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(ToolPath, SaysWhereTheToolIsAtATime) {
    const std::vector<PathPose> poses = {pose_at(0, 0, 0), pose_at(30, 40, 0, 10.0),
                                         pose_at(30, 40, 0, 10.0), pose_at(30, 40, 20, 5.0, 0.5)};
    const ToolPath path(poses, {});
    EXPECT_EQ(path.at(-1.0).pose, 0u);
    EXPECT_TRUE(path.at(0.0).base_from_tcp.isApprox(poses[0].base_from_tcp));
    EXPECT_NEAR(path.at(2.5).base_from_tcp.translation().x(), 15.0, 1e-12);
    EXPECT_EQ(path.at(2.5).pose, 1u);
    EXPECT_NEAR(path.at(6.0).base_from_tcp.translation().z(), 5.0, 1e-12);
    EXPECT_EQ(path.at(6.0).pose, 3u);
    EXPECT_TRUE(path.at(99.0).base_from_tcp.isApprox(poses[3].base_from_tcp));
    EXPECT_EQ(path.at(99.0).pose, 3u);

    TimeLaw law;
    law.timing = TimeLaw::Timing::kTrapezoidal;
    const ToolPath accelerated(poses, {}, law);
    SteppingOptions fine;
    fine.max_travel = 0.5;
    for (const PathStep& step : accelerated.steps(fine)) {
        const double begin = step.time - 0.5 * step.duration;
        const Vec3 a = accelerated.at(begin).base_from_tcp.translation();
        const Vec3 b = accelerated.at(begin + step.duration).base_from_tcp.translation();
        EXPECT_NEAR((b - a).norm(), step.feed * step.duration, 1e-6);
        EXPECT_EQ(accelerated.at(step.time).pose, step.pose);
    }
}

TEST(ToolPath, NamesTheWrongPose) {
    EXPECT_NE(error_of({}).find("no pose"), std::string::npos);
    auto bad = pose_at(0, 0, 0);
    bad.line = 17;
    bad.base_from_tcp.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(error_of({pose_at(0, 0, 0), bad}).find("pose 2 (line 17)"), std::string::npos);
    auto skew = pose_at(0, 0, 0);
    skew.base_from_tcp.linear() *= 1.01;
    EXPECT_NE(error_of({skew}).find("pose 1: the orientation"), std::string::npos);
    EXPECT_NE(error_of({pose_at(0, 0, 0, 0.0)}).find("feed"), std::string::npos);
}

TEST(ToolPath, TimingsAndHoldingsHaveNames) {
    EXPECT_EQ(TimeLaw::timing_named("constant_feed"), TimeLaw::Timing::kConstantFeed);
    EXPECT_EQ(TimeLaw::timing_named("trapezoidal"), TimeLaw::Timing::kTrapezoidal);
    EXPECT_EQ(holding_named("tool_in_hand"), Holding::kToolInHand);
    EXPECT_EQ(holding_named("part_in_hand"), Holding::kPartInHand);
    EXPECT_THROW(TimeLaw::timing_named("fast"), InputError);
    EXPECT_THROW(holding_named("none"), InputError);
}

}  // namespace
}  // namespace beltgrinding

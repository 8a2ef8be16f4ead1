// External axes that move in a pass: what no indexed axis can do, by kinematics of the test's own.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "beltgrinding/error.h"
#include "links/link.h"
#include "posture/posture.h"
#include "robot/arms.h"
#include "support/box.h"

namespace beltgrinding {
namespace {

using testing::degrees;
using testing::kDegree;

const Vec3 kCentre(620, 40, 350);
constexpr double kRadius = 150.0;
constexpr int kPoses = 73;

ExternalAxis table(double limit = 200.0, double speed = 1.0) {
    ExternalAxis one;
    one.carries_part = one.coordinated = true;
    one.point = kCentre;
    one.lower = -limit * kDegree;
    one.upper = limit * kDegree;
    one.max_speed = speed;
    return one;
}

CellFrames tool_in_hand() {
    CellFrames frames;
    frames.tcp_from_contact = Frame(Eigen::Translation3d(0, 0, 150));
    frames.base_from_work = Frame(Eigen::Translation3d(kCentre));
    return frames;
}

CollisionBody post() {
    CollisionBody one;
    one.name = "post";
    one.mesh = testing::box(kCentre + Vec3(60, -220, -60), kCentre + Vec3(100, -180, 60));
    return one;
}

/// A bar on the table, which sweeps the post when the table turns.
CollisionBody bar() {
    CollisionBody one;
    one.name = "bar";
    one.carrier = Carrier::kPart;
    one.mesh = testing::box({-20, -20, -20}, {210, 20, 20});
    return one;
}

ArmScene cell(std::vector<ExternalAxis> axes, std::vector<CollisionBody> bodies = {},
              const Frame& at_zero = Frame::Identity()) {
    return ArmScene({RobotArm(testing::wrist_arm()), at_zero},
                    ExternalAxes(std::move(axes), at_zero), tool_in_hand(), std::move(bodies));
}

/// Once round the rim of a disc on the table, the contact's z towards its axis.
std::vector<PassPose> round_the_rim(const CellFrames& frames) {
    std::vector<PassPose> poses(kPoses);
    for (int k = 0; k < kPoses; ++k) {
        const double a = 2.0 * M_PI * k / (kPoses - 1);
        Frame contact = Frame::Identity();
        contact.linear().col(2) = Vec3(-std::cos(a), -std::sin(a), 0.0);
        contact.linear().col(0) = Vec3(-std::sin(a), std::cos(a), 0.0);
        contact.linear().col(1) = contact.linear().col(2).cross(contact.linear().col(0));
        contact.translation() = kCentre - kRadius * contact.linear().col(2);
        poses[static_cast<std::size_t>(k)] = {contact * frames.tcp_from_contact.inverse(), 0.5,
                                              k == 0};
    }
    return poses;
}

PostureOptions options_for(const ArmScene& scene) {
    PostureOptions options;
    options.speed = scene.max_speed();
    options.home = scene.axes().standing(degrees(0, -90, 90, 0, 60, 0));
    options.acceleration = options.jerk = Coordinates::Zero(scene.size());
    for (std::size_t k = 0; k < scene.axes().count(); ++k) {
        const ExternalAxis& one = scene.axes()[k];
        options.free[kOfContact + k] = {one.upper - one.position, 15.0 * kDegree,
                                        one.lower - one.position};
    }
    return options;
}

struct Seen {
    int cuts = 0, lost = 0;
};

Seen seen(const std::vector<PosturePose>& poses) {
    Seen found;
    for (const PosturePose& one : poses) {
        found.cuts += static_cast<int>(one.cut);
        found.lost += static_cast<int>(!one.reached);
    }
    return found;
}

TEST(Coordinated, ATableTurnsARimThatNoStandingTableLetsTheArmDo) {
    for (double standing = -180.0; standing <= 180.0; standing += 30.0) {
        ExternalAxis fixed = table();
        fixed.coordinated = false;
        fixed.position = standing * kDegree;
        const ArmScene scene = cell({fixed});
        const Seen of =
            seen(find_postures(scene, round_the_rim(scene.frames()), options_for(scene)).poses);
        EXPECT_GT(of.cuts + of.lost, 0) << standing;
    }
    const ArmScene scene = cell({table()});
    const auto poses = round_the_rim(scene.frames());
    const auto found = find_postures(scene, poses, options_for(scene)).poses;
    ASSERT_EQ(found.size(), poses.size());
    EXPECT_EQ(seen(found).cuts + seen(found).lost, 0);
    double turned = 0.0;
    for (std::size_t n = 0; n < found.size(); ++n) {
        ASSERT_EQ(found[n].q.size(), 7);
        const double angle = found[n].q[6];
        EXPECT_LE(std::abs(angle), 200.0 * kDegree + 1e-9);
        // The tool at the pose, seen from the room: the part's frame turned about the table's axis.
        const Frame room_from_part = Eigen::Translation3d(kCentre) *
                                     Eigen::AngleAxisd(angle, Vec3::UnitZ()) *
                                     Eigen::Translation3d(-kCentre);
        const Frame there = scene.arm().forward(found[n].q.head<6>());
        EXPECT_LT(((room_from_part * poses[n].base_from_tcp).matrix() - there.matrix()).norm(),
                  1e-6);
        if (n == 0) continue;
        const Coordinates step = found[n].q - found[n - 1].q;
        EXPECT_LE((step.cwiseAbs().cwiseQuotient(scene.max_speed()) / found[n].duration).maxCoeff(),
                  1.0 + 1e-9);
        EXPECT_LT(std::abs(step[6]), 20.0 * kDegree) << "the table goes smoothly";
        turned += std::abs(step[6]);
        // The straight way between the poses stays in the posture.
        const Straight way =
            straight_way(scene, found[n - 1].q, found[n].base_from_tcp, found[n].q, 1.0, 0.02);
        ASSERT_TRUE(way.whole) << n;
        EXPECT_LT((way.joints.back() - found[n].q).norm(), 1e-6);
    }
    EXPECT_GT(turned, 180.0 * kDegree);
}

TEST(Coordinated, ASlowTableLowersTheFeed) {
    const ArmScene scene = cell({table(200.0, 2.0 * kDegree)});
    const auto poses = round_the_rim(scene.frames());
    PostureOptions options = options_for(scene);
    options.cut = 1e4;  // rather slow than cut
    const auto found = find_postures(scene, poses, options).poses;
    EXPECT_EQ(seen(found).cuts + seen(found).lost, 0);
    double asked = 0.0, taken = 0.0;
    for (std::size_t n = 1; n < found.size(); ++n) {
        asked += poses[n].duration;
        taken += found[n].duration;
        EXPECT_LE(std::abs(found[n].q[6] - found[n - 1].q[6]),
                  2.0 * kDegree * found[n].duration * (1.0 + 1e-9));
    }
    EXPECT_GT(taken, 1.2 * asked);
}

TEST(Coordinated, TwoAxesAndATrackAreWhereTheyShouldBe) {
    ExternalAxis track;
    track.linear = track.coordinated = true;
    track.axis = {0, 2, 0};
    track.lower = -0.5;
    track.upper = 0.5;
    track.position = 0.1;
    ExternalAxis tilt = table();
    tilt.axis = Vec3::UnitX();
    tilt.coordinated = false;
    tilt.position = 0.3;
    const Frame at_zero(Eigen::Translation3d(-30, 20, -10));
    const ArmScene scene = cell({track, tilt, table()}, {}, at_zero);
    ASSERT_EQ(scene.size(), 8);
    Coordinates at = scene.axes().standing(degrees(10, -80, 90, 5, 40, 0));
    EXPECT_DOUBLE_EQ(at[6], 0.1);
    at[6] = 0.25;
    at[7] = 0.7;
    const Frame about(Eigen::Translation3d(kCentre) * Eigen::AngleAxisd(0.3, Vec3::UnitX()) *
                      Eigen::AngleAxisd(0.7, Vec3::UnitZ()) * Eigen::Translation3d(-kCentre));
    const Frame expected = about.inverse() * Eigen::Translation3d(0, 250, 0) * at_zero *
                           scene.arm().forward(at.head<6>());
    EXPECT_LT((scene.base_from_tcp(at).matrix() - expected.matrix()).norm(), 1e-9);
    const Frame back = scene.robot_from_flange(expected, at);
    EXPECT_LT((back.matrix() - scene.arm().forward(at.head<6>()).matrix()).norm(), 1e-9);
}

/// On random ways of joints and axes nothing that meets at a fine step is missed.
TEST(Coordinated, WaysMissNothingThatMeetsOnThem) {
    ExternalAxis track;
    track.linear = track.coordinated = true;
    track.axis = Vec3::UnitY();
    track.lower = -0.4;
    track.upper = 0.4;
    CollisionBody hand;
    hand.name = "hand";
    hand.carrier = Carrier::kTool;
    hand.mesh = testing::box({-30, -30, 0}, {30, 30, 140});
    const ArmScene scene = cell({track, table()}, {post(), bar(), hand});
    std::mt19937 random(5);
    int met = 0, clear = 0;
    for (int n = 0; n < 120; ++n) {
        Coordinates from(8), to(8);
        const auto number = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        for (int j = 0; j < 8; ++j) {
            from[j] = number(scene.lower()[j], scene.upper()[j]);
            to[j] = from[j] + number(-0.6, 0.6);
        }
        bool fine = false;
        for (int k = 0; k <= 400 && !fine; ++k)
            fine = scene.within(from + k / 400.0 * (to - from), 0.0).has_value();
        const bool found = scene.on_way(from, to, 0.0, 0.05).has_value();
        if (fine) {
            EXPECT_TRUE(found) << n;
        }
        ++(found ? met : clear);
    }
    EXPECT_GT(met, 10);
    EXPECT_GT(clear, 10);
}

TEST(Coordinated, ALinkTurnsTheTableOnlyWhereNothingIsInTheWay) {
    const ArmScene scene = cell({table()}, {post(), bar()});
    Coordinates from = scene.axes().standing(degrees(0, -90, 90, 0, 60, 0)), to = from;
    from[6] = -120.0 * kDegree;
    to[6] = -20.0 * kDegree;
    ASSERT_TRUE(scene.on_way(from, to, 1.0, 0.5)) << "the bar sweeps the post";
    LinkOptions options;
    options.iterations = 300;
    const auto link = find_link(scene, from, to, options);
    ASSERT_TRUE(!link || !link->straight);
    if (link) {
        for (std::size_t n = 1; n < link->joints.size(); ++n)
            EXPECT_FALSE(scene.on_way(link->joints[n - 1], link->joints[n], 1.0, 0.5));
    }
    to[6] = -160.0 * kDegree;
    const auto away = find_link(scene, from, to, {});
    ASSERT_TRUE(away);
    EXPECT_TRUE(away->straight);
}

TEST(Coordinated, BadAxesAreRefused) {
    ExternalAxis none = table();
    none.axis = Vec3::Zero();
    EXPECT_THROW(ExternalAxes({none}, Frame::Identity()), InputError);
    EXPECT_THROW(ExternalAxes({table(), table(), table(), table()}, Frame::Identity()), InputError);
}

}  // namespace
}  // namespace beltgrinding

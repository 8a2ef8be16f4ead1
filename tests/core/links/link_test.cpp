// Links between places of the joints, looked at ten times more finely than they are planned.
#include "links/link.h"

#include <gtest/gtest.h>

#include "beltgrinding/error.h"
#include "collision/collision_mesh.h"
#include "robot/arms.h"
#include "support/box.h"

namespace beltgrinding {
namespace {

using testing::degrees;

/// The arm with a box for each link, and a wall between the two sides of it.
ArmScene walled(double top) {
    const RobotArm arm(testing::wrist_arm());
    std::vector<CollisionBody> bodies;
    for (std::size_t k = 1; k <= 6; ++k) {
        const Vec3 begin = arm.point(static_cast<int>(k) - 1);
        const Vec3 end = k == 6 ? Vec3(arm.home().translation()) : arm.point(static_cast<int>(k));
        CollisionBody link;
        link.name = "link " + std::to_string(k);
        link.carrier = Carrier::kLink;
        link.link = k;
        link.mesh = testing::box(begin.cwiseMin(end) - Vec3::Constant(30),
                                 begin.cwiseMax(end) + Vec3::Constant(30));
        bodies.push_back(link);
    }
    CollisionBody wall;
    wall.name = "wall";
    wall.mesh = testing::box({300, -20, 0}, {1200, 20, top});
    bodies.push_back(wall);
    return ArmScene({arm}, {}, bodies);
}

/// The least share of the clearance on a link, at `count` places of each of its motions.
void is_clear(const ArmScene& scene, const Link& link, double clearance, int count) {
    for (std::size_t n = 1; n < link.joints.size(); ++n)
        for (int k = 0; k <= count; ++k) {
            const Joints q = link.joints[n - 1] +
                             static_cast<double>(k) / count * (link.joints[n] - link.joints[n - 1]);
            ASSERT_FALSE(scene.within(q, clearance)) << n << " " << k;
            ASSERT_TRUE((q.array() >= scene.arm().lower().array()).all());
            ASSERT_TRUE((q.array() <= scene.arm().upper().array()).all());
        }
}

const Joints kLeft = degrees(40, -20, 40, 0, 30, 0), kRight = degrees(-40, -20, 40, 0, 30, 0);

TEST(Link, IsStraightWhereThatIsFree) {
    const ArmScene scene = walled(50);
    const auto link = find_link(scene, kLeft, kRight, {});
    ASSERT_TRUE(link);
    EXPECT_TRUE(link->straight);
    EXPECT_EQ(link->joints.size(), 2u);
    EXPECT_EQ(link->clearance, LinkOptions().clearance);
}

TEST(Link, GoesRoundAWallAndKeepsClear) {
    const ArmScene scene = walled(700);
    ASSERT_TRUE(scene.on_way(kLeft, kRight, 0.0, 0.5));
    const auto link = find_link(scene, kLeft, kRight, {});
    ASSERT_TRUE(link);
    EXPECT_FALSE(link->straight);
    EXPECT_EQ(link->joints.front(), kLeft);
    EXPECT_EQ(link->joints.back(), kRight);
    // What the way is proved for less its resolution, at some 0.1 mm from place to place.
    is_clear(scene, *link, LinkOptions().clearance - LinkOptions().resolution, 5000);
}

TEST(Link, IsTheSameForASeedWhateverWasPlannedBefore) {
    const ArmScene scene = walled(700);
    const auto first = find_link(scene, kLeft, kRight, {});
    LinkOptions other;
    other.seed = 7;
    const auto another = find_link(scene, kLeft, kRight, other);
    const auto again = find_link(scene, kLeft, kRight, {});
    ASSERT_TRUE(first && again && another);
    EXPECT_EQ(first->joints, again->joints);
    EXPECT_NE(first->joints, another->joints);
}

TEST(Link, IsNoneFromWithinABody) {
    const ArmScene scene = walled(700);
    EXPECT_FALSE(find_link(scene, degrees(0, -20, 40, 0, 30, 0), kRight, {}));
    LinkOptions options;
    options.clearance = 0.0;
    EXPECT_THROW(find_link(scene, kLeft, kRight, options), InputError);
}

TEST(Link, EndsNearABodyKeepWhatTheyCan) {
    const ArmScene scene = walled(50);
    // Over the wall at 3 mm or so.
    Joints low = kLeft;
    double apart = 0.0;
    for (double angle = -20.0; angle < 40.0; angle += 0.02) {
        const Joints q = degrees(3, angle, 40, 0, 30, 0);
        if (scene.within(q, 3.0)) break;
        low = q;
        apart = 3.0;
    }
    ASSERT_EQ(apart, 3.0);
    ASSERT_TRUE(scene.within(low, 5.0));
    const auto link = find_link(scene, low, kRight, {});
    ASSERT_TRUE(link);
    EXPECT_EQ(link->clearance, 2.5);
}

TEST(Straight, FollowsTheToolAndStopsWhereTheArmDoes) {
    const ArmScene scene = walled(50);
    Frame to = scene.base_from_tcp(kLeft);
    to.translation() += Vec3(-60, 20, 40);
    const Straight way = straight_way(scene, kLeft, to, 1.0, 0.02);
    ASSERT_TRUE(way.whole);
    EXPECT_GT(way.joints.size(), 70u);
    const Frame from = scene.base_from_tcp(kLeft);
    for (std::size_t k = 0; k < way.joints.size(); ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(way.joints.size() - 1);
        const Frame wanted = interpolate(from, to, share);
        EXPECT_LT((scene.base_from_tcp(way.joints[k]).matrix() - wanted.matrix()).norm(), 1e-5);
    }
    to.translation() += Vec3(3000, 0, 0);
    EXPECT_FALSE(straight_way(scene, kLeft, to, 1.0, 0.02).whole);
}

}  // namespace
}  // namespace beltgrinding

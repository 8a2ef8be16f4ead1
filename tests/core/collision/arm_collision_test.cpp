// The links of a robot's arm along a path, against a search by brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "beltgrinding/error.h"
#include "collision/arm_scene.h"
#include "collision/collision_check.h"
#include "collision/collision_mesh.h"
#include "collision/touching_links.h"
#include "support/box.h"

namespace beltgrinding {
namespace {

/// An arm with a spherical wrist, joint 1 upright: column 400 mm, upper arm 450, forearm 420, 80 to
/// the flange.
RobotArm arm() {
    RobotModel model;
    const Vec3 origins[6] = {{0, 0, 400}, {25, 0, 0},  {0, 0, 450},
                             {0, 0, 35},  {420, 0, 0}, {80, 0, 0}};
    const Vec3 axes[6] = {{0, 0, 1}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    for (std::size_t i = 0; i < 6; ++i) {
        model.joints[i].parent_from_joint.translation() = origins[i];
        model.joints[i].axis = axes[i];
    }
    return RobotArm(model);
}

TriangleMesh box(const Vec3& middle, const Vec3& half) {
    return testing::box(middle - half, middle + half);
}

/// A box about the way from each axis to the next, in the robot's base at joint angles 0.
std::vector<CollisionBody> links(const RobotArm& arm) {
    std::vector<CollisionBody> bodies;
    for (std::size_t k = 0; k <= 6; ++k) {
        const Vec3 begin = k == 0 ? Vec3::Zero() : arm.point(static_cast<int>(k) - 1);
        const Vec3 end = k == 6 ? Vec3(arm.home().translation()) : arm.point(static_cast<int>(k));
        const Vec3 half = (0.5 * (end - begin)).cwiseAbs() + Vec3::Constant(20.0);
        bodies.push_back(
            {"link " + std::to_string(k), Carrier::kLink, box(0.5 * (begin + end), half), 0.0, k});
    }
    return bodies;
}

PathPose pose(const Frame& at) {
    PathPose p;
    p.base_from_tcp = at;
    p.feed = 100.0;
    return p;
}

struct Case {
    ArmInCell in_cell;
    ToolPath path;
};

/// Random joint angles, some of the stretches between them not known.
Case random_case(unsigned seed, const CellFrames& cell, double most = 1.2) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> angle(-most, most);
    ArmInCell in_cell{arm(), Frame(Eigen::Translation3d(10, -20, 30)),
                      Frame(Eigen::Translation3d(0, 0, 60))};
    std::vector<PathPose> poses;
    for (std::uint32_t i = 0; i < 6; ++i) {
        Joints q;
        for (int j = 0; j < 6; ++j) q[j] = angle(random);
        in_cell.way.push_back({q, 1.0 * i, i, i > 0 && i != 3});
        poses.push_back(
            pose(in_cell.base_from_robot * in_cell.arm.forward(q) * in_cell.flange_from_tcp));
    }
    return {in_cell, ToolPath(poses, cell)};
}

double brute(const Case& c, const CollisionBody& other, const CollisionMesh& mesh,
             const CollisionBody& link, const CollisionMesh& link_mesh) {
    constexpr int kParts = 400;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < c.in_cell.way.size(); ++i) {
        if (!c.in_cell.way[i + 1].joined) continue;
        for (int k = 0; k <= kParts; ++k) {
            const double u = static_cast<double>(k) / kParts;
            const Joints q = (1.0 - u) * c.in_cell.way[i].q + u * c.in_cell.way[i + 1].q;
            Frame base_from_other = Frame::Identity();
            if (other.carrier == Carrier::kLink)
                base_from_other = c.in_cell.base_from_robot * c.in_cell.arm.links(q)[other.link];
            if (other.carrier == Carrier::kTool) {
                base_from_other = c.in_cell.base_from_robot * c.in_cell.arm.forward(q) *
                                  c.in_cell.flange_from_tcp;
            }
            const Frame base_from_link =
                c.in_cell.base_from_robot * c.in_cell.arm.links(q)[link.link];
            least = std::min(
                least,
                mesh.nearest(link_mesh, base_from_other.inverse() * base_from_link).distance);
        }
    }
    return least;
}

TEST(ArmCollision, LeastDistancesAreThoseOfAFineSearch) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Case c = random_case(seed, {});
        std::vector<CollisionBody> bodies = links(c.in_cell.arm);
        bodies.push_back({"post", Carrier::kBase, box({350, 250, 500}, {20, 20, 300})});
        bodies.push_back({"spindle", Carrier::kTool, box({0, 0, 80}, {40, 150, 30})});
        CollisionOptions options;
        options.clearance = 30.0;
        const auto found = check_collisions(c.path, bodies, options, {}, &c.in_cell);
        std::map<std::pair<std::size_t, std::size_t>, double> least;
        for (const auto& pair : found.pairs) least[{pair.first, pair.second}] = pair.distance;
        std::size_t compared = 0;
        for (std::size_t link = 0; link <= 6; ++link) {
            const CollisionMesh link_mesh(bodies[link].mesh);
            for (const std::size_t other : {std::size_t{7}, std::size_t{8}}) {
                const bool expected = other == 7 ? link > 0 : link < 6;
                ASSERT_EQ(least.count({other, link}), expected ? 1u : 0u) << other << ' ' << link;
                if (!expected) continue;
                const CollisionMesh mesh(bodies[other].mesh);
                const double fine = brute(c, bodies[other], mesh, bodies[link], link_mesh);
                const double told = least[{other, link}];
                // Below the clearance within the resolution; beyond, a quarter of it is sure.
                if (fine < options.clearance - 1.0) {
                    EXPECT_NEAR(told, fine, 0.3) << seed << ' ' << other << ' ' << link;
                } else {
                    EXPECT_GT(told, 0.25 * fine);
                    EXPECT_LT(told, 1.35 * fine + 0.1);
                }
                ++compared;
            }
        }
        EXPECT_EQ(compared, 12u);
        EXPECT_TRUE(found.touching.empty());
        EXPECT_EQ(least.count({7, 8}), 1u);  // as without an arm
    }
}

TEST(ArmCollision, LeastDistancesOfLinksAreThoseOfAFineSearch) {
    std::size_t compared = 0, met = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Case c = random_case(seed, {}, 3.0);
        const std::vector<CollisionBody> bodies = links(c.in_cell.arm);
        const auto left_out = touching_links(c.in_cell.arm, bodies);
        const auto found = check_collisions(c.path, bodies, {30.0}, {}, &c.in_cell);
        std::map<std::pair<std::size_t, std::size_t>, double> least;
        for (const auto& pair : found.pairs) least[{pair.first, pair.second}] = pair.distance;
        for (std::size_t a = 0; a <= 6; ++a) {
            for (std::size_t b = 0; b <= 6; ++b) {
                const std::pair<std::size_t, std::size_t> pair(a, b);
                const bool out = std::count(left_out.begin(), left_out.end(), pair) > 0;
                const bool expected = a + 1 < b && !out;
                ASSERT_EQ(least.count(pair), expected ? 1u : 0u) << a << ' ' << b;
                if (!expected) continue;
                const double fine = brute(c, bodies[a], CollisionMesh(bodies[a].mesh), bodies[b],
                                          CollisionMesh(bodies[b].mesh));
                if (fine <= 0.0) {
                    EXPECT_EQ(least[pair], 0.0) << seed << ' ' << a << ' ' << b;
                    ++met;
                } else {
                    EXPECT_LT(least[pair], 1.35 * fine + 0.1) << seed << ' ' << a << ' ' << b;
                    EXPECT_GT(least[pair], 0.25 * fine - 0.5) << seed << ' ' << a << ' ' << b;
                }
                ++compared;
            }
        }
        for (const Event& event : found.events) {
            EXPECT_LE(event.value, kLinksApart);
        }
    }
    EXPECT_GE(compared, 30u);
    EXPECT_GE(met, 3u);
}

TEST(ArmCollision, LinksThatAlwaysTouchAreLeftOutAndNoOthers) {
    using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
    // Link 3 is short: the boxes of links 2 and 4 meet at the elbow, 40 mm wide, whatever it does.
    const RobotArm one = arm();
    std::vector<CollisionBody> bodies = links(one);
    bodies[0].mesh = box({0, 0, 150}, {20, 20, 150});
    EXPECT_EQ(touching_links(one, bodies), (Pairs{{2, 4}}));
    // A thick foot up to the shoulder's height, which the forearm meets now and then.
    bodies[0].mesh = box({0, 0, 300}, {60, 60, 300});
    EXPECT_EQ(touching_links(one, bodies), (Pairs{{0, 2}, {2, 4}}));
    // A bead within the wrist's box never crosses it.
    bodies[0].mesh = box({0, 0, 150}, {20, 20, 150});
    bodies[6].mesh = box(one.point(5), {5, 5, 5});
    bodies[4].mesh = box(one.point(5), {60, 60, 60});
    EXPECT_EQ(touching_links(one, bodies), (Pairs{{4, 6}}));
    // At joint angles 0 this arm is folded into itself; only an arm that may be there proves that
    // the bodies are rough.
    RobotModel folded = one.model();
    folded.joints[2].parent_from_joint.linear() =
        Eigen::AngleAxisd(2.8, Vec3::UnitY()).toRotationMatrix();
    const RobotArm within(folded);
    const auto all = touching_links(within, links(within));
    EXPECT_GT(all.size(), 1u);
    folded.joints[2].lower = 0.2;
    const RobotArm beyond(folded);
    EXPECT_LT(touching_links(beyond, links(beyond)).size(), all.size());
}

TEST(ArmCollision, LimitsKeepLinksApartThatAreNextButOne) {
    const auto pairs = [](const RobotArm& of) {
        std::vector<CollisionBody> bodies = links(of);
        bodies[2].mesh = box(of.point(1), {5, 5, 5});
        const ArmInCell in_cell{of};
        CellFrames cell;
        cell.holding = Holding::kPartInHand;
        const auto found = pairs_looked_at(&in_cell, cell, bodies, prepared(bodies, true)).pairs;
        return std::set<std::pair<std::size_t, std::size_t>>(found.begin(), found.end());
    };
    RobotModel model = arm().model();
    const auto all = pairs(RobotArm(model));
    EXPECT_EQ(all.count({2, 4}), 1u);
    EXPECT_EQ(all.count({2, 5}), 1u);
    EXPECT_EQ(all.count({2, 3}), 0u);  // neighbours
    EXPECT_EQ(all.count({5, 3}), 0u);  // one way round only
    model.joints[2].upper = 3.0;       // which links 2 and 3 have between them
    const auto limited = pairs(RobotArm(model));
    EXPECT_EQ(limited.count({1, 3}), 0u);
    EXPECT_EQ(limited.count({2, 4}), 0u);
    EXPECT_EQ(limited.size() + 2, all.size());
    EXPECT_EQ(limited.count({3, 6}), 1u);
    model.joints[4].upper = 2.0;  // of the wrist
    const auto bent = pairs(RobotArm(model));
    for (const std::size_t k : {3u, 4u}) EXPECT_EQ(bent.count({k, 6}), 0u);
}

TEST(ArmCollision, ASceneSeesAnArmFoldedIntoItselfAndItsWayThere) {
    const ArmInCell in_cell{arm(), Frame(Eigen::Translation3d(10, -20, 30))};
    const std::vector<CollisionBody> bodies = links(in_cell.arm);
    const ArmScene scene(in_cell, {}, bodies);
    Joints open = Joints::Zero(), folded = open;
    folded[2] = M_PI / 2;  // the forearm lies on the upper arm, and the wrist in the shoulder
    EXPECT_FALSE(scene.within(open, 200.0));
    const auto met = scene.within(folded, 0.0, ArmScene::Pairs::kOfArm);
    ASSERT_TRUE(met);
    EXPECT_EQ(bodies[met->first].carrier, Carrier::kLink);
    EXPECT_EQ(bodies[met->second].carrier, Carrier::kLink);
    const CollisionMesh first(bodies[met->first].mesh), second(bodies[met->second].mesh);
    const auto frames = in_cell.arm.links(folded);
    EXPECT_TRUE(first.within(second, frames[met->first].inverse() * frames[met->second], 0.0));
    // The way there ends where a fine search finds the first touch.
    double begin = 1.0;
    for (int k = 1000; k >= 0; --k) {
        if (scene.within(open + (folded - open) * (k / 1000.0), 0.0)) begin = k / 1000.0;
    }
    Joints before = open + (folded - open) * (begin - 0.01);
    EXPECT_FALSE(scene.on_way(open, before, 0.0, 0.05));
    EXPECT_TRUE(scene.on_way(open, folded, 0.0, 0.05));
    // And through it, both ends free.
    Joints beyond = folded;
    beyond[2] = 2.6;
    ASSERT_FALSE(scene.within(beyond, 0.0));
    EXPECT_TRUE(scene.on_way(open, beyond, 0.0, 0.05));
}

TEST(ArmCollision, OfTheFlangeWhatTouchesTheWristAtHomeBelongsToIt) {
    // Link 5 reaches 60 mm along y beside its axis; a bracket at the flange lies there at q6 = 0.
    using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
    const RobotArm one = arm();
    const Vec3 wrist = one.point(4);
    std::vector<CollisionBody> bodies;
    bodies.push_back({"link 5", Carrier::kLink, box(wrist + Vec3(0, 30, 0), {20, 30, 20}), 0.0, 5});
    bodies.push_back({"link 6", Carrier::kLink, box(wrist + Vec3(80, 0, 0), {20, 20, 20}), 0.0, 6});
    bodies.push_back({"bracket", Carrier::kTool, box({-80, 40, 0}, {30, 5, 5})});
    bodies.push_back({"plate", Carrier::kTool, box({30, 0, 0}, {10, 60, 60})});
    Joints aside = Joints::Zero();
    aside[5] = M_PI / 2;
    ArmInCell in_cell{one};
    in_cell.way = {{aside, 0.0, 0, false}, {Joints::Zero(), 2.0, 1, true}};
    const ToolPath path({pose(one.forward(aside)), pose(one.forward(Joints::Zero()))}, {});
    const auto at_zero = check_collisions(path, bodies, {}, {}, &in_cell);
    EXPECT_EQ(at_zero.touching, (Pairs{{2, 0}}));
    EXPECT_TRUE(at_zero.events.empty());
    ASSERT_EQ(at_zero.pairs.size(), 1u);  // plate and link 5; none with link 6
    EXPECT_EQ(at_zero.pairs[0].first, 3u);
    EXPECT_EQ(at_zero.pairs[0].second, 0u);
    // At another home it stands aside, and its way to link 5 is a collision.
    in_cell.home = aside;
    const auto elsewhere = check_collisions(path, bodies, {}, {}, &in_cell);
    EXPECT_TRUE(elsewhere.touching.empty());
    ASSERT_EQ(elsewhere.events.size(), 1u);
    EXPECT_EQ(elsewhere.events[0].kind, "collision");
    EXPECT_EQ(elsewhere.events[0].bodies, (std::vector<std::string>{"bracket", "link 5"}));
    EXPECT_GT(elsewhere.events[0].time, 1.0);  // near q6 = 0
    // A scene says the same: along joint 6 no other joint decides.
    ArmScene scene(in_cell, {}, bodies);
    EXPECT_TRUE(scene.touching().empty());
    EXPECT_FALSE(scene.within(aside, 5.0));
    EXPECT_TRUE(scene.within(Joints::Zero(), 0.0));
    EXPECT_TRUE(scene.on_way(aside, -aside, 0.5, 0.05));
    in_cell.home = Joints::Zero();
    const ArmScene built(in_cell, {}, bodies);
    EXPECT_EQ(built.touching(), (Pairs{{2, 0}}));
    EXPECT_FALSE(built.within(Joints::Zero(), 0.5));
}

TEST(ArmCollision, TheFootInThePartIsACollisionFromTheStart) {
    const Case c = random_case(1, {});
    std::vector<CollisionBody> bodies = links(c.in_cell.arm);
    bodies.push_back({"part", Carrier::kPart, box({10, -20, 100}, {300, 300, 20})});
    const auto found = check_collisions(c.path, bodies, {}, {}, &c.in_cell);
    const auto hit = std::find_if(found.events.begin(), found.events.end(), [](const Event& event) {
        return event.bodies == std::vector<std::string>{"part", "link 0"};
    });
    ASSERT_NE(hit, found.events.end());
    EXPECT_EQ(hit->kind, "collision");
    EXPECT_EQ(hit->time, 0.0);
    EXPECT_EQ(hit->pose, 0u);
}

TEST(ArmCollision, ABodyIsMetOnTheArcOfTheJointsAtItsTime) {
    // Joint 1 turns by 90 degrees in 2 s: a post at 45 degrees is met before half the time.
    ArmInCell in_cell{arm()};
    Joints q = Joints::Zero(), turned = q;
    turned[0] = M_PI / 2;
    in_cell.way = {{q, 0.0, 0, false}, {turned, 2.0, 1, true}};
    const ToolPath path({pose(in_cell.arm.forward(q)), pose(in_cell.arm.forward(turned))}, {});
    const double x = 350.0 * std::cos(M_PI / 4);
    std::vector<CollisionBody> bodies = links(in_cell.arm);
    bodies.push_back({"post", Carrier::kBase, box({x, x, 885}, {5, 5, 100})});
    const auto found = check_collisions(path, bodies, {}, {}, &in_cell);
    const auto hit = std::find_if(found.events.begin(), found.events.end(), [](const Event& event) {
        return event.bodies == std::vector<std::string>{"post", "link 4"};
    });
    ASSERT_NE(hit, found.events.end());
    EXPECT_EQ(hit->kind, "collision");
    EXPECT_GT(hit->time, 0.8);
    EXPECT_LT(hit->time, 1.0);
    EXPECT_GT(hit->time + hit->duration, 1.0);
    EXPECT_NEAR(hit->point.z(), 885.0, 25.0);
    // As a stretch that is not known, it is not ground for a collision.
    in_cell.way[1].joined = false;
    for (const Event& event : check_collisions(path, bodies, {}, {}, &in_cell).events) {
        EXPECT_NE(event.bodies[0], "post") << event.bodies[1];
    }
}

TEST(ArmCollision, LinksNeedAnArmAndANumber) {
    const Case c = random_case(1, {});
    std::vector<CollisionBody> bodies = links(c.in_cell.arm);
    EXPECT_THROW(check_collisions(c.path, bodies, {}), InputError);
    bodies[6].link = 7;
    EXPECT_THROW(check_collisions(c.path, bodies, {}, {}, &c.in_cell), InputError);
    // Nowhere in reach, nothing is said of the arm.
    bodies[6].link = 6;
    bodies.push_back({"part", Carrier::kPart, box({0, 0, 100}, {300, 300, 20})});
    EXPECT_TRUE(check_collisions(c.path, bodies, {}, {},
                                 std::make_unique<ArmInCell>(ArmInCell{arm()}).get())
                    .pairs.empty());
}

}  // namespace
}  // namespace beltgrinding

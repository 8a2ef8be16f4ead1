// Bodies along a path against cases with a known distance and a known time of impact.
#include "collision/collision_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "base/threads.h"
#include "beltgrinding/error.h"
#include "collision/collision_mesh.h"
#include "support/box.h"

namespace beltgrinding {
namespace {

using testing::box;

constexpr double kFeed = 50.0;  // mm/s
constexpr double kResolution = CollisionOptions().resolution;

/// A sphere of `rings` rings, its vertices on the radius.
TriangleMesh sphere(const Vec3& centre, double radius, int rings) {
    TriangleMesh mesh;
    const int around = 2 * rings;
    for (int i = 0; i <= rings; ++i) {
        for (int k = 0; k < around; ++k) {
            const double polar = M_PI * i / rings, turn = 2.0 * M_PI * k / around;
            mesh.vertices.push_back(
                (centre + radius * Vec3(std::sin(polar) * std::cos(turn),
                                        std::sin(polar) * std::sin(turn), std::cos(polar)))
                    .cast<float>());
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < around; ++k) {
            const auto a = static_cast<std::uint32_t>(i * around + k);
            const auto b = static_cast<std::uint32_t>(i * around + (k + 1) % around);
            const auto down = static_cast<std::uint32_t>(around);
            mesh.triangles.push_back({a, a + down, b});
            mesh.triangles.push_back({b, a + down, b + down});
        }
    }
    return mesh;
}

PathPose pose(const Vec3& position, double turn_about_z = 0.0, bool rapid = false) {
    PathPose p;
    p.base_from_tcp =
        Eigen::Translation3d(position) * Eigen::AngleAxisd(turn_about_z, Vec3::UnitZ());
    p.feed = kFeed;
    p.rapid = rapid;
    return p;
}

CollisionBody body(const char* name, Carrier carrier, TriangleMesh mesh, double margin = 0.0) {
    return {name, carrier, std::move(mesh), margin};
}

const TriangleMesh kCube = box(Vec3(-5, -5, -5), Vec3(5, 5, 5));

TEST(CollisionMesh, DistancesAndNearestPointsOfBoxesAndSpheres) {
    const CollisionMesh a(kCube);
    // Far corner to corner, turned by 45 degrees: an edge towards the face.
    const Frame turned =
        Eigen::Translation3d(30, 0, 0) * Eigen::AngleAxisd(M_PI / 4, Vec3::UnitZ());
    const auto found = a.nearest(a, turned);
    EXPECT_NEAR(found.distance, 25.0 - 5.0 * std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(found.here.x(), 5.0, 1e-6);
    EXPECT_NEAR((turned * found.there).x(), 30.0 - 5.0 * std::sqrt(2.0), 1e-6);
    EXPECT_NEAR((found.here - turned * found.there).norm(), found.distance, 1e-6);
    EXPECT_EQ(a.nearest(a, Frame(Eigen::Translation3d(9, 0, 0))).distance, 0.0);
    // Old points speed the search up and do not change what is found.
    const auto again = a.nearest(a, Frame(Eigen::Translation3d(20, 3, 0)), found);
    EXPECT_NEAR(again.distance, 10.0, 1e-6);
    const double rough = a.nearest(a, Frame(Eigen::Translation3d(20, 3, 0)), found, 0.2).distance;
    EXPECT_GE(rough, 10.0 - 1e-6);
    EXPECT_LE(rough, 12.0);

    // More triangles than one tree takes.
    const CollisionMesh one(sphere(Vec3::Zero(), 10.0, 120)), two(sphere(Vec3(1, 2, 3), 6.0, 30));
    const Vec3 apart(30, 20, -10);
    EXPECT_NEAR(one.nearest(two, Frame(Eigen::Translation3d(apart))).distance,
                (apart + Vec3(1, 2, 3)).norm() - 16.0, 0.04);
    EXPECT_NEAR(two.reach(Vec3(1, 2, 3)), 6.0, 1e-5);
    EXPECT_TRUE(one.contains(Vec3(9, 0, 0)));
    EXPECT_FALSE(one.contains(Vec3(9, 9, 0)));
    TriangleMesh open = kCube;
    open.triangles.pop_back();
    EXPECT_FALSE(CollisionMesh(open).contains(Vec3::Zero()));
    TriangleMesh wrong = kCube;
    wrong.triangles[0][0] = 99;
    EXPECT_THROW(CollisionMesh{wrong}, InputError);
    EXPECT_THROW(CollisionMesh{TriangleMesh()}, InputError);
}

TEST(Collision, ABodyRunsIntoAnotherAtTheTimeThatItsFeedSays) {
    const ToolPath path({pose({0, 0, 0}), pose({100, 0, 0})}, {});
    const auto result =
        check_collisions(path,
                         {body("table", Carrier::kBase, box({60, -50, -50}, {70, 50, 50})),
                          body("gripper", Carrier::kTool, kCube)},
                         {});
    ASSERT_EQ(result.pairs.size(), 1u);
    EXPECT_EQ(result.pairs[0].distance, 0.0);
    ASSERT_EQ(result.events.size(), 1u);
    const Event& event = result.events[0];
    EXPECT_EQ(event.kind, "collision");
    EXPECT_EQ(event.severity, Severity::kError);
    EXPECT_EQ(event.bodies, (std::vector<std::string>{"table", "gripper"}));
    EXPECT_NEAR(event.time, 55.0 / kFeed, 2.0 * kResolution / kFeed);
    EXPECT_NEAR(event.time + event.duration, 75.0 / kFeed, 2.0 * kResolution / kFeed);
    EXPECT_EQ(event.pose, 1u);
    EXPECT_NEAR(event.point.x(), 60.0, 0.1);
}

TEST(Collision, NoMotionIsTooFastForAThinPlate) {
    // Half a millimetre of sheet, half a metre in one rapid motion.
    const CollisionBody sheet =
        body("sheet", Carrier::kBase, box({249.9, -50, -50}, {250.0, 50, 50}));
    const auto run = [&](double y) {
        const ToolPath path({pose({0, y, 0}), pose({500, y, 0}, 0.0, true)}, {});
        return check_collisions(path, {sheet, body("gripper", Carrier::kTool, kCube)}, {});
    };
    const auto hit = run(0.0);
    ASSERT_EQ(hit.events.size(), 1u);
    EXPECT_EQ(hit.events[0].kind, "collision");
    EXPECT_NEAR(hit.events[0].time, 244.9 / kFeed, 2.0 * kResolution / kFeed);
    EXPECT_NE(hit.events[0].message().find("rapid"), std::string::npos);
    // Past its edge, 1.5 mm away: seen, and no collision.
    const auto miss = run(56.5);
    ASSERT_EQ(miss.events.size(), 1u);
    EXPECT_EQ(miss.events[0].kind, "near_miss");
    EXPECT_NEAR(miss.events[0].value, 1.5, kResolution);
    EXPECT_EQ(miss.events[0].limit, 2.0);
    EXPECT_NEAR(miss.pairs[0].distance, 1.5, kResolution);
    EXPECT_GT(miss.pairs[0].time, (244.9 - 5.0) / kFeed);
    EXPECT_LT(miss.pairs[0].time, 255.1 / kFeed);
    const auto far = run(75.0);
    EXPECT_TRUE(far.events.empty());
    EXPECT_NEAR(far.pairs[0].distance, 20.0, 1e-4);
}

TEST(Collision, ATurnSwingsTheFarEndOfABody) {
    // A bar of 300 mm turned by 90 degrees: its side meets the post where sin(angle) says.
    const CollisionBody bar = body("bar", Carrier::kTool, box({0, -1, -5}, {300, 1, 5}));
    const CollisionBody post = body("post", Carrier::kBase, box({199, 150, -20}, {201, 152, 20}));
    const ToolPath path({pose({0, 0, 0}), pose({0, 0, 0}, M_PI / 2)}, {});
    const auto result = check_collisions(path, {post, bar}, {});
    ASSERT_EQ(result.events.size(), 1u);
    // The bar's upper side, 1 mm from its axis, reaches the post's corner (201, 150).
    const double angle = std::atan2(150.0, 201.0) - std::asin(1.0 / std::hypot(201.0, 150.0));
    EXPECT_NEAR(result.events[0].time / path.duration(), angle / (M_PI / 2), 1e-3);
    EXPECT_NEAR(result.events[0].point.x(), 201.0, 0.2);
    EXPECT_NEAR(result.events[0].point.y(), 150.0, 0.2);
}

TEST(Collision, OnlyWhatMovesAgainstEachOtherIsLookedAt) {
    // All in one place: gripper and part go together in the robot's hand, wheel and table stand.
    const std::vector<CollisionBody> bodies{
        body("gripper", Carrier::kTool, kCube), body("part", Carrier::kPart, kCube),
        body("wheel", Carrier::kWheel, kCube), body("table", Carrier::kBase, kCube)};
    CellFrames cell;
    cell.holding = Holding::kPartInHand;
    cell.base_from_contact = Frame(Eigen::Translation3d(0, 200, 0));
    const ToolPath path({pose({100, 0, 0}), pose({100, 200, 0})}, cell);
    const auto result = check_collisions(path, bodies, {});
    ASSERT_EQ(result.pairs.size(), 4u);  // both of the hand with both that stand
    for (const PairClearance& pair : result.pairs) {
        EXPECT_GE(pair.first, 2u);
        EXPECT_LE(pair.second, 1u);
        EXPECT_NEAR(pair.distance, 90.0, 1e-4);
    }
    // The points are in the work frame, which is the hand's here.
    const auto& wheel_part = *std::find_if(
        result.pairs.begin(), result.pairs.end(),
        [](const PairClearance& pair) { return pair.first == 2 && pair.second == 1; });
    EXPECT_NEAR(wheel_part.on_second.x(), -5.0, 1e-6);
    EXPECT_NEAR((wheel_part.on_first - wheel_part.on_second).norm(), wheel_part.distance, 1e-6);
}

TEST(Collision, ToolInHandTheWheelMovesAndTheStockCounts) {
    CellFrames cell;
    cell.base_from_work = Frame(Eigen::Translation3d(0, 0, -5));
    cell.tcp_from_contact = Frame(Eigen::Translation3d(0, 0, 100));
    const ToolPath path({pose({-60, 0, -83}), pose({60, 0, -83})}, cell);
    const std::vector<CollisionBody> plain{body("part", Carrier::kPart, kCube),
                                           body("wheel", Carrier::kWheel, kCube)};
    // The wheel's cube passes at z = 17 over the part's at z = -5: 12 mm between them.
    EXPECT_NEAR(check_collisions(path, plain, {}).pairs[0].distance, 12.0, 1e-4);
    auto thick = plain;
    thick[0].margin = 11.5;
    const auto result = check_collisions(path, thick, {});
    ASSERT_EQ(result.events.size(), 1u);
    EXPECT_EQ(result.events[0].kind, "near_miss");
    EXPECT_NEAR(result.events[0].value, 0.5, kResolution);
    EXPECT_NEAR(result.events[0].point.z(), 5.0, 0.05);  // on the part, in the work frame
}

TEST(Collision, ABodyWithinAnotherCollidesThoughNoSurfacesCross) {
    const CollisionBody block =
        body("block", Carrier::kBase, box({-100, -100, -100}, {100, 100, 100}));
    const CollisionBody gripper = body("gripper", Carrier::kTool, kCube);
    const ToolPath stays({pose({0, 0, 0}), pose({20, 0, 0})}, {});
    const auto inside = check_collisions(stays, {block, gripper}, {});
    ASSERT_EQ(inside.events.size(), 1u);
    EXPECT_EQ(inside.events[0].time, 0.0);
    EXPECT_EQ(inside.pairs[0].distance, 0.0);
    // In and out again is one collision, not two.
    const ToolPath through({pose({-200, 0, 0}), pose({200, 0, 0})}, {});
    const auto crossing = check_collisions(through, {block, gripper}, {});
    ASSERT_EQ(crossing.events.size(), 1u);
    EXPECT_NEAR(crossing.events[0].time, 95.0 / kFeed, 2.0 * kResolution / kFeed);
    EXPECT_NEAR(crossing.events[0].duration, 210.0 / kFeed, 4.0 * kResolution / kFeed);
}

TEST(Collision, ARoundedCornerIsFollowed) {
    // A post beyond the corner, which the rounded way does not reach.
    const CollisionBody post = body("post", Carrier::kBase, box({104, -105, -20}, {106, -104, 20}));
    const CollisionBody gripper = body("gripper", Carrier::kTool, kCube);
    std::vector<PathPose> poses{pose({0, -100, 0}), pose({100, -100, 0}), pose({100, 0, 0}, 0.5)};
    poses[1].zone = 0.0;
    TimeLaw law;
    law.timing = TimeLaw::Timing::kTrapezoidal;
    const auto sharp = check_collisions(ToolPath(poses, {}, law), {post, gripper}, {});
    ASSERT_EQ(sharp.events.size(), 1u);
    EXPECT_EQ(sharp.events[0].kind, "collision");
    poses[1].zone = 40.0;
    const auto round = check_collisions(ToolPath(poses, {}, law), {post, gripper}, {});
    EXPECT_TRUE(round.events.empty());
    EXPECT_GT(round.pairs[0].distance, 5.0);
}

TEST(Collision, ThreadsDoNotMatter) {
    std::vector<PathPose> poses;
    for (int k = 0; k < 40; ++k) {
        poses.push_back(
            pose({40.0 * std::cos(0.7 * k), 40.0 * std::sin(0.9 * k), 8.0 * std::sin(k)},
                 0.3 * std::sin(2.0 * k), k % 5 == 0));
    }
    const ToolPath path(poses, {});
    std::vector<CollisionBody> bodies{body("gripper", Carrier::kTool, sphere({20, 0, 0}, 8, 20))};
    for (int k = 0; k < 5; ++k) {
        bodies.push_back(body("post", Carrier::kBase, sphere({30.0 * k, 50, 0}, 9, 20)));
    }
    const auto run = [&](std::size_t count) {
        set_threads(count);
        return check_collisions(path, bodies, {});
    };
    const auto one = run(1), two = run(2);
    set_threads(0);
    ASSERT_EQ(one.pairs.size(), 5u);
    ASSERT_FALSE(one.events.empty());
    ASSERT_EQ(one.events.size(), two.events.size());
    for (std::size_t i = 0; i < one.events.size(); ++i) {
        EXPECT_EQ(one.events[i].time, two.events[i].time);
        EXPECT_EQ(one.events[i].message(), two.events[i].message());
    }
    for (std::size_t i = 0; i < one.pairs.size(); ++i) {
        EXPECT_EQ(one.pairs[i].distance, two.pairs[i].distance);
        // No denser sampling finds anything nearer.
        const CollisionMesh a(bodies[one.pairs[i].first].mesh), b(bodies[0].mesh);
        double least = 1e9;
        for (double t = 0.0; t < path.duration(); t += 0.05) {
            least = std::min(least, a.nearest(b, path.at(t).base_from_tcp).distance);
        }
        EXPECT_LE(one.pairs[i].distance, least + std::max(kResolution, 0.1 * least));
        EXPECT_GE(one.pairs[i].distance, 0.0);
    }
}

TEST(Collision, EndsSoonAfterACancel) {
    std::vector<PathPose> poses;
    for (int k = 0; k < 20000; ++k) poses.push_back(pose({k % 2 ? 30.0 : -30.0, 0, 0.001 * k}));
    const ToolPath path(poses, {});
    const RunContext context;
    // The processor's time: what else the machine does meanwhile does not count.
    std::clock_t cancelled = 0;
    std::thread stopper([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        cancelled = std::clock();
        context.cancel();
    });
    EXPECT_THROW(check_collisions(path,
                                  {body("part", Carrier::kBase, sphere({0, 25, 0}, 20, 100)),
                                   body("tool", Carrier::kTool, sphere({0, 0, 0}, 5, 60))},
                                  {}, context),
                 Cancelled);
    const std::clock_t ended = std::clock();
    stopper.join();
    EXPECT_LT(static_cast<double>(ended - cancelled) / CLOCKS_PER_SEC, 0.2);
    EXPECT_THROW(check_collisions(path, {}, {-1.0}), InputError);
}

}  // namespace
}  // namespace beltgrinding

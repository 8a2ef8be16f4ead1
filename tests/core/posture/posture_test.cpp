// Postures against a search by brute force over a fine ladder, and what they must keep to.
#include "posture/posture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "beltgrinding/error.h"
#include "cost.h"
#include "joint_pace.h"
#include "ladder.h"
#include "robot/arms.h"
#include "robot/inverse_kinematics.h"
#include "support/box.h"

namespace beltgrinding {
namespace {

using testing::degrees;
using testing::kDegree;

CellFrames tool_in_hand() {
    CellFrames frames;
    frames.tcp_from_contact = Frame(Eigen::Translation3d(0, 0, 150));
    return frames;
}

CellFrames part_in_hand() {
    CellFrames frames;
    frames.holding = Holding::kPartInHand;
    frames.tcp_from_work = Frame(Eigen::Translation3d(0, 0, 120));
    frames.base_from_contact =
        Frame(Eigen::Translation3d(500, 150, 400)) * Eigen::AngleAxisd(0.4, Vec3::UnitZ());
    return frames;
}

/// A pass whose poses lie from one frame to another, an even way of time apart.
std::vector<PassPose> pass(const Frame& from, const Frame& to, std::size_t count,
                           double duration = 0.4) {
    std::vector<PassPose> poses(count);
    for (std::size_t i = 0; i < count; ++i) {
        poses[i].base_from_tcp =
            interpolate(from, to, static_cast<double>(i) / static_cast<double>(count - 1));
        poses[i].duration = i == 0 ? 0.0 : duration;
        poses[i].begins = i == 0;
    }
    return poses;
}

Frame placed(double x, double y, double z, double about_y, double about_z = 0.0) {
    return Frame(Eigen::Translation3d(x, y, z)) * Eigen::AngleAxisd(about_z, Vec3::UnitZ()) *
           Eigen::AngleAxisd(about_y, Vec3::UnitY());
}

PostureOptions options_for(const RobotArm& arm) {
    PostureOptions options;
    options.speed = arm.max_speed();
    options.wheel_radius = 60.0;
    options.chord = 0.05;
    options.clearance = 0.5;
    return options;
}

/// The least cost over all ways through a ladder of fine samples in which no body is near, with the
/// changes of speed counted: dynamic programming over pairs of vertices. `fine` samples to a side.
class BruteForce {
  public:
    BruteForce(const ArmScene& scene, const std::vector<PassPose>& poses,
               const PostureOptions& options, std::array<int, 3> fine)
        : scene_(scene),
          poses_(poses),
          options_(options),
          cost_(scene.arm(), options),
          times_(times_at(poses)),
          bounds_(Ladder(scene, poses, options).bounds()) {
        for (std::size_t i = 0; i < poses.size(); ++i) rungs_.push_back(rung(i, fine));
    }

    double least() const {
        using Pairs = std::map<std::pair<std::size_t, std::size_t>, double>;
        Pairs pairs;
        const auto& first = rungs_[0];
        for (std::size_t a = 0; a < first.size(); ++a) {
            const double begun = cost_.travel(options_.home, first[a].q) + place(0, first[a]);
            for (std::size_t b = 0; b < rungs_[1].size(); ++b) {
                if (joined(first[a], rungs_[1][b], 1))
                    pairs[{a, b}] = begun + edge(first[a], rungs_[1][b], 1);
            }
        }
        for (std::size_t i = 2; i < rungs_.size(); ++i) {
            Pairs next;
            for (const auto& [pair, cost] : pairs) {
                const One &a = rungs_[i - 2][pair.first], &b = rungs_[i - 1][pair.second];
                for (std::size_t k = 0; k < rungs_[i].size(); ++k) {
                    const One& c = rungs_[i][k];
                    if (!joined(b, c, i)) continue;
                    const double sum = cost + edge(b, c, i) +
                                       cost_.acceleration(a.q, b.q, c.q, poses_[i - 1].duration,
                                                          poses_[i].duration);
                    const auto [at, fresh] = next.try_emplace({pair.second, k}, sum);
                    if (!fresh) at->second = std::min(at->second, sum);
                }
            }
            pairs = std::move(next);
        }
        double least = std::numeric_limits<double>::infinity();
        for (const auto& [pair, cost] : pairs)
            least =
                std::min(least, cost + cost_.travel(rungs_.back()[pair.second].q, options_.home));
        return least;
    }

  private:
    struct One {
        Free free;
        Joints q;
    };
    std::vector<One> rung(std::size_t i, const std::array<int, 3>& fine) const {
        std::vector<One> found;
        for (int a = -fine[0]; a <= fine[0]; ++a)
            for (int b = -fine[1]; b <= fine[1]; ++b)
                for (int c = -fine[2]; c <= fine[2]; ++c) {
                    const std::array<int, 3> at = {a, b, c};
                    Free free{};
                    for (std::size_t k = 0; k < 3; ++k)
                        if (fine[k] > 0) free[k] = options_.free[k].most * at[k] / fine[k];
                    const Frame frame =
                        moved(scene_, poses_[i].base_from_tcp, free, options_.wheel_radius);
                    for (const auto& one :
                         inverse(scene_.arm(), scene_.robot_from_flange(frame, options_.home),
                                 options_.home))
                        for (const Joints& q : turns_within(scene_.arm(), one.q, options_.home, 64))
                            if (!scene_.within(q, 3.0 * options_.clearance))
                                found.push_back({free, q});
                }
        return found;
    }
    bool joined(const One& a, const One& b, std::size_t i) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (std::abs(a.free[k] - b.free[k]) > bounds_[i][k] + 1e-12) return false;
        return (a.q - b.q).cwiseAbs().maxCoeff() <= options_.flip;
    }
    double place(std::size_t i, const One& one) const { return times_[i] * cost_.place(one.q); }
    double edge(const One& a, const One& b, std::size_t i) const {
        return cost_.edge(a.q, b.q, poses_[i].duration) + place(i, b);
    }

    const ArmScene& scene_;
    const std::vector<PassPose>& poses_;
    const PostureOptions& options_;
    Cost cost_;
    std::vector<double> times_;
    std::vector<Free> bounds_;
    std::vector<std::vector<One>> rungs_;
};

/// Every joint within its limits, each pose where it was asked, no leap within a run.
void keeps_to(const ArmScene& scene, const std::vector<PassPose>& poses,
              const PostureOptions& options, const PostureResult& found) {
    for (std::size_t n = 0; n < found.poses.size(); ++n) {
        const PosturePose& one = found.poses[n];
        ASSERT_TRUE(one.reached);
        EXPECT_TRUE((one.q.array() >= scene.arm().lower().array()).all());
        EXPECT_TRUE((one.q.array() <= scene.arm().upper().array()).all());
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_LE(std::abs(one.free[k]), options.free[k].most + 1e-12);
        const Frame wanted =
            moved(scene, poses[one.pose].base_from_tcp, one.free, options.wheel_radius);
        EXPECT_LT((scene.base_from_tcp(one.q).matrix() - wanted.matrix()).norm(), 1e-5);
        if (one.link) continue;
        EXPECT_LE((one.q - found.poses[n - 1].q).cwiseAbs().maxCoeff(), options.flip);
        EXPECT_EQ(one.pose, found.poses[n - 1].pose + 1);
    }
}

TEST(Posture, WithinFivePercentOfBruteForceForTheRollOfAToolInHand) {
    const RobotArm arm(testing::wrist_arm());
    const ArmScene scene({arm}, tool_in_hand(), {});
    PostureOptions options = options_for(arm);
    options.home = degrees(0, -90, 90, 0, 20, 0);
    options.free[0] = {30 * kDegree, 10 * kDegree};
    const auto poses = pass(placed(450, -200, 400, 2.7), placed(400, 200, 350, 3.0, 0.3), 8);
    const PostureResult found = find_postures(scene, poses, options);
    keeps_to(scene, poses, options, found);
    const double brute = BruteForce(scene, poses, options, {60, 0, 0}).least();
    EXPECT_LT(found.cost.sum(), 1.05 * brute);
    EXPECT_GT(found.cost.sum(), 0.9 * brute);
    EXPECT_EQ(found.cost.cuts, 0.0);
}

TEST(Posture, WithinFivePercentOfBruteForceForLeanAndShiftOfAPartBesideABody) {
    RobotModel model = testing::parallel_arm();
    for (RobotJoint& joint : model.joints) {  // without whole turns, of which the search knows all
        joint.lower = -M_PI;
        joint.upper = M_PI;
    }
    const RobotArm arm(model);
    // Where the forearm would be with the elbow up.
    std::vector<CollisionBody> bodies(2);
    bodies[0].name = "beam";
    bodies[0].mesh = testing::box({100, -700, 480}, {260, 700, 560});
    bodies[1].name = "forearm";
    bodies[1].carrier = Carrier::kLink;
    bodies[1].link = 3;
    const Vec3 elbow = arm.point(2), wrist = arm.point(3);
    bodies[1].mesh = testing::box(elbow.cwiseMin(wrist) - Vec3::Constant(40),
                                  elbow.cwiseMax(wrist) + Vec3::Constant(40));
    const ArmScene scene({arm}, part_in_hand(), bodies);
    PostureOptions options = options_for(arm);
    options.home = degrees(20, -60, -100, -20, 90, 0);
    options.free[1] = {10 * kDegree, 5 * kDegree};
    options.free[2] = {4.0, 2.0};
    const auto poses = pass(placed(420, 60, 420, 1.8, 0.2), placed(440, 160, 400, 2.2, 0.5), 6);
    const PostureResult found = find_postures(scene, poses, options);
    keeps_to(scene, poses, options, found);
    for (const PosturePose& one : found.poses) {
        EXPECT_FALSE(one.meets);
        EXPECT_FALSE(scene.within(one.q, 0.0));
    }
    const double brute = BruteForce(scene, poses, options, {0, 5, 3}).least();
    EXPECT_LT(found.cost.sum(), 1.05 * brute);
    EXPECT_GT(found.cost.sum(), 0.9 * brute);
    const ArmScene open({arm}, part_in_hand(), {});
    EXPECT_LT(BruteForce(open, poses, options, {0, 5, 3}).least(), 0.95 * brute);
}

TEST(Posture, APassThatWindsTheLastJointUpIsCutOnce) {
    RobotModel model = testing::wrist_arm();
    model.joints[3].lower = -2 * M_PI;
    model.joints[3].upper = 2 * M_PI;
    const RobotArm arm(model);
    const ArmScene scene({arm}, tool_in_hand(), {});
    PostureOptions options = options_for(arm);
    options.home = degrees(0, -90, 90, 0, 20, 0);
    std::vector<PassPose> poses;
    for (int i = 0; i <= 90; ++i) {
        PassPose pose;
        pose.base_from_tcp =
            placed(500, 0, 300, 2.4) * Eigen::AngleAxisd(i * 10 * kDegree, Vec3::UnitZ());
        pose.duration = 0.3;
        pose.begins = i == 0;
        poses.push_back(pose);
    }
    const PostureResult found = find_postures(scene, poses, options);
    keeps_to(scene, poses, options, found);
    int cuts = 0;
    for (std::size_t n = 0; n < found.poses.size(); ++n) {
        if (!found.poses[n].cut) continue;
        ++cuts;
        EXPECT_EQ(found.poses[n].pose, found.poses[n - 1].pose);  // it goes on where it ended
    }
    EXPECT_EQ(cuts, 1);  // 900 degrees of the joint's 700
    EXPECT_EQ(found.poses.size(), poses.size() + 1);
}

TEST(Posture, WhatIsOutOfReachOrBeyondALimitIsTold) {
    RobotModel model = testing::wrist_arm();
    const RobotArm free(model);
    PostureOptions options = options_for(free);
    options.home = degrees(0, -90, 90, 0, 20, 0);
    auto poses = pass(placed(500, 0, 400, 2.4), placed(2500, 0, 400, 2.4), 5);
    const ArmScene scene({free}, tool_in_hand(), {});
    const PostureResult far = find_postures(scene, poses, options);
    EXPECT_TRUE(far.poses.front().reached);
    EXPECT_FALSE(far.poses.back().reached);
    EXPECT_TRUE(far.poses.back().within_limits);
    model.joints[0].lower = -10 * kDegree;
    model.joints[0].upper = 10 * kDegree;
    model.joints[1].upper = -60 * kDegree;
    const ArmScene narrow({RobotArm(model)}, tool_in_hand(), {});
    poses = pass(placed(0, 500, 500, 2.4), placed(0, 450, 500, 2.4), 2);
    const PostureResult limited = find_postures(narrow, poses, options);
    EXPECT_FALSE(limited.poses[0].reached);
    EXPECT_FALSE(limited.poses[0].within_limits);
    options.home = degrees(90, -90, 90, 0, 20, 0);
    EXPECT_THROW(find_postures(narrow, poses, options), InputError);
}

TEST(Posture, AHitThatNothingAvoidsIsTold) {
    const RobotArm arm(testing::wrist_arm());
    std::vector<CollisionBody> bodies(2);
    bodies[0].name = "wall";
    bodies[0].mesh = testing::box({480, -300, 100}, {490, 300, 600});
    bodies[1].name = "tool";
    bodies[1].carrier = Carrier::kTool;
    bodies[1].mesh = testing::box({-20, -20, 0}, {20, 20, 100});
    const ArmScene scene({arm}, tool_in_hand(), bodies);
    PostureOptions options = options_for(arm);
    options.home = degrees(0, -90, 90, 0, 20, 0);
    const auto poses = pass(placed(400, 0, 400, 1.57), placed(460, 0, 400, 1.57), 4);
    const PostureResult found = find_postures(scene, poses, options);
    EXPECT_TRUE(found.poses.back().meets);
    EXPECT_EQ(scene.bodies()[found.poses.back().first].name, "wall");
}

TEST(Posture, AToolThatIsAlwaysNearWindsNothingUp) {
    const RobotArm arm(testing::parallel_arm());  // whole turns of all joints
    std::vector<CollisionBody> bodies(2);
    bodies[0].name = "work";
    bodies[0].mesh = testing::box({300, -200, 90}, {600, 300, 100});
    bodies[1].name = "hub";
    bodies[1].carrier = Carrier::kTool;
    bodies[1].mesh = testing::box({-20, -20, 0}, {20, 20, 100});  // 1 mm above the work
    PostureOptions options = options_for(arm);
    options.home = degrees(0, -90, -90, -90, 90, 0);
    std::vector<PassPose> poses;
    for (int k = 0; k < 8; ++k) {
        const double y = -100.0 + 25.0 * k;
        const auto one = pass(placed(350, y, 201, M_PI, 0.1), placed(500, y, 201, M_PI, 0.1), 5);
        poses.insert(poses.end(), one.begin(), one.end());
    }
    const PostureResult near =
        find_postures(ArmScene({arm}, tool_in_hand(), bodies), poses, options);
    const PostureResult open = find_postures(ArmScene({arm}, tool_in_hand(), {}), poses, options);
    ASSERT_EQ(near.poses.size(), open.poses.size());
    for (std::size_t n = 0; n < near.poses.size(); ++n) {
        EXPECT_FALSE(near.poses[n].meets);
        EXPECT_LT((near.poses[n].q - open.poses[n].q).cwiseAbs().maxCoeff(), 1e-9) << n;
    }
    EXPECT_NEAR(near.cost.travel, open.cost.travel, 1e-9);
}

TEST(Posture, DurationsKeepToSpeedsAndAccelerations) {
    const RobotArm arm(testing::wrist_arm());
    const ArmScene scene({arm}, tool_in_hand(), {});
    PostureOptions options = options_for(arm);
    options.home = degrees(0, -90, 90, 0, 20, 0);
    options.acceleration = Joints::Constant(2.0);
    const auto poses = pass(placed(450, -300, 500, 2.2), placed(450, 300, 500, 2.2), 40, 0.004);
    const auto found = find_postures(scene, poses, options).poses;
    Joints before = Joints::Zero();
    double last = 0.0, most = 0.0, fastest = 0.0, sum = 0.0;
    for (std::size_t n = 1; n < found.size(); ++n) {
        const double time = found[n].duration;
        const Joints speed = (found[n].q - found[n - 1].q) / time;
        fastest = std::max(fastest, speed.cwiseQuotient(arm.max_speed()).cwiseAbs().maxCoeff());
        most = std::max(most, ((speed - before) / (0.5 * (time + last))).cwiseAbs().maxCoeff());
        before = speed;
        last = time;
        sum += time;
    }
    EXPECT_LE(fastest, 1.0 + 1e-9);
    EXPECT_LE(most, 2.0 * 1.01);
    EXPECT_GT(sum, 39 * 0.004);  // the feed asks for more than the joints have
}

/// A joint that swings by amplitude * sin(rate t), sampled at equal steps of time.
std::vector<PosturePose> swing(double amplitude, double rate, double step, std::size_t count) {
    std::vector<PosturePose> way(count);
    for (std::size_t n = 0; n < count; ++n) {
        way[n].link = n == 0;
        way[n].duration = step;
        way[n].q[3] = amplitude * std::sin(rate * step * static_cast<double>(n));
    }
    return way;
}

double whole_time(const std::vector<PosturePose>& way) {
    double sum = 0.0;
    for (std::size_t n = 1; n < way.size(); ++n) sum += way[n].duration;
    return sum;
}

TEST(Posture, JerkIsTheThirdDerivativeAndGoesWithTheCubeOfTheFeed) {
    constexpr double kAmplitude = 0.4, kRate = 5.0, kStep = 0.004;
    const double jerk = kAmplitude * std::pow(kRate, 3);  // of the swing, rad/s3
    PostureOptions options;
    options.speed = Joints::Constant(100.0);
    const auto given = swing(kAmplitude, kRate, kStep, 1000);
    // Above what the swing has, nothing changes.
    options.jerk[3] = 1.001 * jerk;
    auto kept = given;
    keep_pace(options, kept);
    EXPECT_EQ(whole_time(kept), whole_time(given));
    // Just below, something does.
    options.jerk[3] = 0.98 * jerk;
    auto less = given;
    keep_pace(options, less);
    EXPECT_GT(whole_time(less), whole_time(given));
    // An eighth of it: twice the time everywhere would do.
    options.jerk[3] = jerk / 8.0;
    auto slow = given;
    keep_pace(options, slow);
    EXPECT_GT(whole_time(slow), 1.5 * whole_time(given));
    EXPECT_LT(whole_time(slow), 2.1 * whole_time(given));
    for (std::size_t n = 2; n + 1 < slow.size(); ++n) {
        const auto speed = [&](std::size_t k) {
            return (slow[k].q[3] - slow[k - 1].q[3]) / slow[k].duration;
        };
        const auto turn = [&](std::size_t k) {
            return (speed(k + 1) - speed(k)) / (0.5 * (slow[k].duration + slow[k + 1].duration));
        };
        EXPECT_LT(std::abs(turn(n) - turn(n - 1)) / slow[n].duration, 1.005 * jerk / 8.0) << n;
    }
    // A joint without a limit has none.
    options.jerk = Joints::Constant(0.01);
    options.jerk[3] = 0.0;
    auto other = given;
    keep_pace(options, other);
    EXPECT_EQ(whole_time(other), whole_time(given));
}

TEST(Posture, JerkOnACircleIsThatOfAFineSearch) {
    const RobotArm arm(testing::wrist_arm());
    const ArmScene scene({arm}, tool_in_hand(), {});
    PostureOptions options = options_for(arm);
    options.home = degrees(0, -90, 90, 0, 20, 0);
    constexpr double kRadius = 120.0, kStep = 0.01;  // mm, rad from pose to pose
    const auto on_circle = [&](double angle) {
        return placed(450 + kRadius * std::cos(angle), kRadius * std::sin(angle), 500, 2.2);
    };
    std::vector<PassPose> poses;
    for (int k = 0; k < 300; ++k) poses.push_back({on_circle(kStep * k), 0.005, k == 0});
    const auto free = find_postures(scene, poses, options).poses;
    // d3q/dangle3 by a step that is none of the poses', in the configuration that was chosen.
    const auto joints = [&](double angle, const Joints& near) {
        Joints best = near;
        double least = 1.0;
        for (const ArmSolution& one :
             inverse(arm, scene.robot_from_flange(on_circle(angle), options.home), near, false)) {
            const double turned = (one.q - near).cwiseAbs().maxCoeff();
            if (turned < least) {
                least = turned;
                best = one.q;
            }
        }
        return best;
    };
    const auto third = [&](std::size_t n) {
        constexpr double kFine = 0.004;
        const double at = kStep * (static_cast<double>(n) - 0.5);
        const Joints& near = free[n].q;
        return Joints((joints(at + 1.5 * kFine, near) - 3.0 * joints(at + 0.5 * kFine, near) +
                       3.0 * joints(at - 0.5 * kFine, near) - joints(at - 1.5 * kFine, near)) /
                      std::pow(kFine, 3));
    };
    double most = 0.0;
    for (std::size_t n = 2; n + 1 < free.size(); ++n)
        most = std::max(most, third(n).cwiseAbs().maxCoeff() * std::pow(kStep / 0.005, 3));
    // Just more than that is free; a seventh of it takes longer, by no more than the cube root.
    options.jerk = Joints::Constant(1.01 * most);
    EXPECT_NEAR(whole_time(find_postures(scene, poses, options).poses), whole_time(free), 1e-9);
    options.jerk = Joints::Constant(0.97 * most);
    EXPECT_GT(whole_time(find_postures(scene, poses, options).poses), whole_time(free) + 1e-6);
    options.jerk = Joints::Constant(most / 7.0);
    const auto slow = find_postures(scene, poses, options).poses;
    EXPECT_LT(whole_time(slow), 1.05 * std::cbrt(7.0) * whole_time(free));
    double kept = 0.0;
    for (std::size_t n = 2; n + 1 < slow.size(); ++n) {
        const double feed = kStep / slow[n].duration;
        kept = std::max(kept, third(n).cwiseAbs().maxCoeff() * std::pow(feed, 3));
    }
    EXPECT_LT(kept, 1.1 * most / 7.0);
    EXPECT_GT(kept, 0.6 * most / 7.0);
}

}  // namespace
}  // namespace beltgrinding

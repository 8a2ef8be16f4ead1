// The trapezoidal time law: speed profiles and corners against closed forms.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "beltgrinding/error.h"
#include "beltgrinding/tool_path.h"

namespace beltgrinding {
namespace {

constexpr double kAcceleration = 1000.0;  // mm/s2
constexpr double kFeed = 100.0;           // mm/s

TimeLaw law() {
    TimeLaw law;
    law.timing = TimeLaw::Timing::kTrapezoidal;
    law.acceleration = kAcceleration;
    law.angular_acceleration = 2.0;
    law.rotation_speed = 1.0;
    law.default_zone = 0.0;
    return law;
}

PathPose pose_at(double x, double y, double zone, double feed = kFeed, double angle = 0.0) {
    PathPose pose;
    pose.base_from_tcp =
        Eigen::Translation3d(x, y, 0.0) * Eigen::AngleAxisd(angle, Vec3(1, 2, 2).normalized());
    pose.feed = feed;
    pose.zone = zone;
    return pose;
}

double sum_of(const std::vector<PathStep>& steps) {
    double sum = 0.0;
    for (const PathStep& step : steps) sum += step.duration;
    return sum;
}

/// s over `length` from rest to rest.
double from_rest_to_rest(double length, double speed, double acceleration) {
    if (length * acceleration < speed * speed) return 2.0 * std::sqrt(length / acceleration);
    return length / speed + speed / acceleration;
}

TEST(TimeLaw, OneMotionIsATrapezoidOrATriangle) {
    for (const double length : {1e-6, 0.5, 10.0, 10.1, 400.0}) {
        const ToolPath path({pose_at(0, 0, 0), pose_at(length, 0, 0)}, {}, law());
        const double time = from_rest_to_rest(length, kFeed, kAcceleration);
        EXPECT_NEAR(path.duration(), time, 1e-12 * time);
        const auto steps = path.steps({1.0, 1.0, 50.0});
        EXPECT_NEAR(sum_of(steps), time, 1e-12 * time);
        for (const PathStep& step : steps) EXPECT_LE(step.feed, kFeed * (1 + 1e-9));
    }
}

TEST(TimeLaw, StepsFollowTheClosedFormOfTheTrapezoid) {
    const ToolPath path({pose_at(0, 0, 0), pose_at(100, 0, 0)}, {}, law());
    const auto steps = path.steps({1.0, 1.0, 50.0});
    ASSERT_EQ(steps.size(), 100u);
    const double ramp = 5.0;  // mm: v^2 / (2 a)
    const auto time_at = [&](double x) {
        if (x <= ramp) return std::sqrt(2.0 * x / kAcceleration);
        return 0.1 + (x - ramp) / kFeed;
    };
    for (std::size_t k = 0; k < 95; ++k) {
        const double x = static_cast<double>(k);
        EXPECT_NEAR(steps[k].duration, time_at(x + 1.0) - time_at(x), 1e-12);
        EXPECT_NEAR(steps[k].feed, 1.0 / steps[k].duration, 1e-9);
        EXPECT_NEAR(steps[k].time, 0.5 * (time_at(x) + time_at(x + 1.0)), 1e-12);
    }
    for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_NEAR(steps[99 - k].duration, steps[k].duration, 1e-12);
    }
}

TEST(TimeLaw, StandsStillAtAnExactStop) {
    const double one = from_rest_to_rest(50.0, kFeed, kAcceleration);
    for (const double y : {0.0, 50.0}) {  // straight on as well as around a corner
        const ToolPath path({pose_at(0, 0, 0), pose_at(50, 0, 0), pose_at(y > 0 ? 50 : 100, y, 0)},
                            {}, law());
        EXPECT_NEAR(path.duration(), 2.0 * one, 1e-12);
        const auto steps = path.steps({0.01, 1.0, 50.0});
        const PathStep& last = steps[steps.size() / 2 - 1];
        EXPECT_NEAR(last.duration, std::sqrt(2.0 * 0.01 / kAcceleration), 1e-9);
        EXPECT_LT(last.feed, 0.03 * kFeed);
    }
}

TEST(TimeLaw, ZonesOnAStraightLineDoNotSlowDown) {
    std::vector<PathPose> poses;
    for (int k = 0; k <= 1000; ++k) poses.push_back(pose_at(0.1 * k, 0, 1.0));
    const ToolPath path(poses, {}, law());
    EXPECT_NEAR(path.duration(), from_rest_to_rest(100.0, kFeed, kAcceleration), 1e-9);
    for (PathPose& pose : poses) pose.zone = 0.0;
    const ToolPath stops(poses, {}, law());
    EXPECT_NEAR(stops.duration(), 1000.0 * from_rest_to_rest(0.1, kFeed, kAcceleration), 1e-9);
    EXPECT_NEAR(sum_of(stops.steps({})), stops.duration(), 1e-9);
}

TEST(TimeLaw, ACornerIsAParabolaAtTheSpeedThatItsAccelerationAllows) {
    for (const double turn : {0.3, M_PI / 2.0, 2.8}) {
        const double length = 200.0, zone = 2.0;
        const ToolPath path({pose_at(0, 0, 0), pose_at(length, 0, zone),
                             pose_at(length + length * std::cos(turn), length * std::sin(turn), 0)},
                            {}, law());
        // Constant acceleration v^2 |u2 - u1| / (2 d).
        const double bend = 2.0 * std::sin(0.5 * turn);
        const double speed = std::min(kFeed, std::sqrt(kAcceleration * 2.0 * zone / bend));
        const auto steps = path.steps({0.01, 1.0, 50.0});
        double slowest = kFeed, at = 0.0;
        for (const PathStep& step : steps) {
            if (std::abs(step.time - 0.5 * path.duration()) > 0.1) continue;
            if (step.feed < slowest) slowest = step.feed, at = step.time;
        }
        EXPECT_NEAR(slowest, speed * std::cos(0.5 * turn), 2e-3 * speed) << turn;
        EXPECT_NEAR(at, 0.5 * path.duration(), 0.01);
        // At the vertex the way is at the distance d sin(turn / 2) / 2 from the corner.
        double nearest = length;
        for (const PathStep& step : steps) {
            const Vec3 away = step.work_from_contact.translation() - Vec3(length, 0, 0);
            nearest = std::min(nearest, away.norm());
        }
        EXPECT_NEAR(nearest, 0.5 * zone * std::sin(0.5 * turn), 1e-3) << turn;
        // From rest to the corner's speed and back, the corner run through evenly.
        const double ramp = kFeed / kAcceleration + (kFeed - speed) / kAcceleration;
        const double ways = 0.5 * (2.0 * kFeed * kFeed - speed * speed) / kAcceleration;
        const double time = 2.0 * (ramp + (length - zone - ways) / kFeed + zone / speed);
        EXPECT_NEAR(path.duration(), time, 1e-9) << turn;
        EXPECT_NEAR(sum_of(steps), time, 1e-9) << turn;
    }
}

TEST(TimeLaw, AccelerationStaysWithinItsLimitInTheParabola) {
    const ToolPath path({pose_at(0, 0, 0), pose_at(200, 0, 5), pose_at(200, 200, 0)}, {}, law());
    const auto steps = path.steps({0.02, 1.0, 50.0});
    double largest = 0.0;
    for (std::size_t k = 1; k + 1 < steps.size(); ++k) {
        const auto speed = [&](std::size_t i) -> Vec3 {
            return (steps[i + 1].work_from_contact.translation() -
                    steps[i].work_from_contact.translation()) /
                   (steps[i + 1].time - steps[i].time);
        };
        const double mean = 0.5 * (steps[k + 1].time - steps[k - 1].time);
        const double acceleration = (speed(k) - speed(k - 1)).norm() / mean;
        // At the ends of the ramps a step's middle in space is not its middle in time.
        if (std::abs(steps[k].time - 0.5 * path.duration()) < 0.05) {
            largest = std::max(largest, acceleration);
        }
    }
    EXPECT_NEAR(largest, kAcceleration, 0.02 * kAcceleration);
}

TEST(TimeLaw, AZoneReachesNoFurtherThanHalfOfTheWay) {
    const auto duration = [](double zone) {
        return ToolPath({pose_at(0, 0, 0), pose_at(10, 0, zone), pose_at(10, 30, 0)}, {}, law())
            .duration();
    };
    EXPECT_EQ(duration(5.0), duration(500.0));
    EXPECT_LT(duration(5.0), duration(4.0));
}

TEST(TimeLaw, AShareOfTheFeedIsKeptThroughACornerByTheZoneThatItTakes) {
    // At 90 degrees |v - u| = sqrt 2: the zone is share^2 v^2 sqrt 2 / (2 a), 7.07 mm for the whole
    // feed.
    for (const double share : {1.0, 0.5}) {
        const double zone = share * share * kFeed * kFeed * std::sqrt(0.5) / kAcceleration;
        const auto path = [&](double given, double length) {
            return ToolPath(
                {pose_at(0, 0, 0), pose_at(length, 0, given), pose_at(length, length, 0)}, {},
                law());
        };
        EXPECT_NEAR(path(-1.0 - share, 60.0).duration(), path(zone, 60.0).duration(), 1e-9);
        EXPECT_NEAR(path(-1.0 - share, 1.0).duration(), path(0.5, 1.0).duration(), 1e-12);
    }
    // Straight on, nothing slows it down; beside a rapid motion it stops.
    std::vector<PathPose> poses{pose_at(0, 0, 0), pose_at(50, 0, -2), pose_at(100, 0, 0)};
    EXPECT_NEAR(ToolPath(poses, {}, law()).duration(), from_rest_to_rest(100, kFeed, kAcceleration),
                1e-9);
    poses[1].rapid = true;
    EXPECT_NEAR(ToolPath(poses, {}, law()).duration(),
                2.0 * from_rest_to_rest(50, kFeed, kAcceleration), 1e-9);
}

TEST(TimeLaw, ACurveGoesThroughItsPosesWithinTheAccelerations) {
    const double curve = -3.0;
    const std::vector<PathPose> poses{pose_at(0, 0, 0), pose_at(10, 0, curve),
                                      pose_at(14, 1, curve, kFeed, 0.1),
                                      pose_at(20, 5, curve, kFeed, 0.15), pose_at(40, 10, 0)};
    const ToolPath path(poses, {}, law());
    double time = 0.0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        time += path.duration(i);
        const Vec3 place = path.at(time).base_from_tcp.translation();
        EXPECT_NEAR((place - poses[i].base_from_tcp.translation()).norm(), 0.0, 1e-6) << i;
    }
    const double step = 1e-3;
    Vec3 before = Vec3::Zero(), last = path.at(0.0).base_from_tcp.translation();
    double largest = 0.0, slowest = kFeed;
    for (double t = step; t < path.duration(); t += step) {
        const Vec3 place = path.at(t).base_from_tcp.translation(), speed = (place - last) / step;
        if (t > 1.5 * step) largest = std::max(largest, (speed - before).norm() / step);
        if (place.x() > 8.0 && place.x() < 30.0) slowest = std::min(slowest, speed.norm());
        EXPECT_LE(speed.norm(), kFeed * (1.0 + 1e-3));
        before = speed, last = place;
    }
    EXPECT_LE(largest, std::sqrt(2.0) * kAcceleration * 1.01);
    EXPECT_GT(slowest, 1.0);  // it does not stop at its points
}

TEST(TimeLaw, BesideAShortTurnALongMotionOfACurveDoesNotSwingOut) {
    std::vector<PathPose> poses{pose_at(0, 0, 0)};
    for (int k = 1; k <= 8; ++k) poses.push_back(pose_at(0.2 * k, 0, -3.0, 4.0, 0.08 * k));
    poses.push_back(pose_at(6, 0, 0, 12.0, 0.64));
    const ToolPath path(poses, {}, law());
    double most = 0.0;
    for (double t = path.duration() - path.duration(9); t < path.duration(); t += 1e-3) {
        most = std::max(most, angle_between(poses.back().base_from_tcp, path.at(t).base_from_tcp));
    }
    // 4/27 of the shorter motion's length times the change of turning.
    EXPECT_LE(most, 4.0 / 27.0 * 0.2 * 0.4 * 1.1);
}

TEST(TimeLaw, ADenseArcIsRunAtTheSpeedOfItsRadius) {
    // Chords of an arc with zones: v^2 / r <= a.
    const double radius = 5.0;
    std::vector<PathPose> poses;
    for (int k = 0; k <= 2000; ++k) {
        const double turn = 10.0 * M_PI * k / 2000;
        poses.push_back(pose_at(radius * std::cos(turn), radius * std::sin(turn), 1.0));
    }
    const auto steps = ToolPath(poses, {}, law()).steps({});
    const double speed = std::sqrt(kAcceleration * radius);
    EXPECT_NEAR(steps[steps.size() / 2].feed, speed, 1e-3 * speed);
}

TEST(TimeLaw, AFeedThatFallsIsReachedInTimeAndOneThatRisesAfterwards) {
    const std::vector<PathPose> poses{pose_at(0, 0, 0), pose_at(100, 0, 1),
                                      pose_at(200, 0, 1, 20.0), pose_at(300, 0, 0)};
    const ToolPath path(poses, {}, law());
    const double ramp = 0.5 * (kFeed * kFeed - 20.0 * 20.0) / kAcceleration;  // mm
    const double first = 5.0;
    const double outer = 0.1 + (100.0 - first - ramp) / kFeed + (kFeed - 20.0) / kAcceleration;
    EXPECT_NEAR(path.duration(), 2.0 * outer + 100.0 / 20.0, 1e-9);
    for (const PathStep& step : path.steps({})) {
        if (step.pose == 2) {
            EXPECT_NEAR(step.feed, 20.0, 1e-6);
        }
    }
}

TEST(TimeLaw, ReorientationKeepsToItsLimits) {
    // A pure rotation: 1 rad at 1 rad/s and 2 rad/s2.
    const ToolPath turning({pose_at(0, 0, 0), pose_at(0, 0, 0, kFeed, 1.0)}, {}, law());
    EXPECT_NEAR(turning.duration(), from_rest_to_rest(1.0, 1.0, 2.0), 1e-9);
    EXPECT_NEAR(sum_of(turning.steps({1.0, 0.02, 50.0})), turning.duration(), 1e-9);
    // In many parts that need no stop it takes no longer; with stops it does.
    for (const double zone : {1.0, 0.0}) {
        std::vector<PathPose> poses;
        for (int k = 0; k <= 10; ++k) poses.push_back(pose_at(0, 0, zone, kFeed, 0.1 * k));
        const double expected =
            zone > 0.0 ? from_rest_to_rest(1.0, 1.0, 2.0) : 10.0 * from_rest_to_rest(0.1, 1.0, 2.0);
        EXPECT_NEAR(ToolPath(poses, {}, law()).duration(), expected, 1e-7);
    }
    // 1 rad over 10 mm at 100 mm/s would be 10 rad/s.
    const ToolPath both({pose_at(0, 0, 0), pose_at(10, 0, 0, kFeed, 1.0)}, {}, law());
    EXPECT_NEAR(both.duration(), from_rest_to_rest(1.0, 1.0, 2.0), 1e-9);
}

TEST(TimeLaw, OrientationIsBlendedWithThePosition) {
    const auto at = [](double x, double y, double zone, double angle) {
        PathPose pose = pose_at(x, y, zone);
        pose.base_from_tcp.linear() = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
        return pose;
    };
    const ToolPath path({at(0, 0, 0, 0), at(50, 0, 10, 0), at(100, 0, 0, 1.0)}, {}, law());
    double last = 0.0, rate = 0.0;
    for (const PathStep& step : path.steps({0.1, 1.0, 50.0})) {
        const double x = step.work_from_contact.translation().x();
        const double angle = Eigen::AngleAxisd(step.work_from_contact.linear()).angle();
        // A parabola from 0 at 40 mm to 0.2 at 60 mm.
        const double s = std::clamp((x - 40.0) / 20.0, 0.0, 1.0);
        EXPECT_NEAR(angle, x < 60.0 ? 0.2 * s * s : (x - 50.0) / 50.0, 1e-6) << x;
        if (x > 0.2) {
            EXPECT_LE(std::abs((angle - last) - rate), 1e-4);
        }  // no jump of the rate
        rate = angle - last, last = angle;
    }
}

TEST(TimeLaw, RapidMotionsBeginAndEndAtRestUnlessTheyHaveAZone) {
    TimeLaw with_default = law();
    with_default.default_zone = 1.0;
    std::vector<PathPose> poses{pose_at(0, 0, -1), pose_at(50, 0, -1), pose_at(100, 0, -1),
                                pose_at(150, 0, -1)};
    EXPECT_NEAR(ToolPath(poses, {}, with_default).duration(),
                from_rest_to_rest(150.0, kFeed, kAcceleration), 1e-9);
    poses[1].rapid = true;
    const ToolPath path(poses, {}, with_default);
    const double first = from_rest_to_rest(50.0, kFeed, kAcceleration);
    EXPECT_NEAR(path.duration(), first + from_rest_to_rest(100.0, kFeed, kAcceleration), 1e-9);
    const auto steps = path.steps({});
    for (const PathStep& step : steps) EXPECT_GE(step.pose, 2u);
    EXPECT_NEAR(sum_of(steps), path.duration() - first, 1e-9);
    poses[1].zone = 5.0;
    EXPECT_NEAR(ToolPath(poses, {}, with_default).duration(),
                from_rest_to_rest(150.0, kFeed, kAcceleration), 1e-9);
}

TEST(TimeLaw, APoseProgrammedTwiceIsOneWithTheSmallerZone) {
    for (const double zone : {0.0, 2.0}) {
        const ToolPath once({pose_at(0, 0, 0), pose_at(50, 0, zone), pose_at(50, 50, 0)}, {},
                            law());
        const ToolPath twice(
            {pose_at(0, 0, 0), pose_at(50, 0, 8), pose_at(50, 0, zone), pose_at(50, 50, 0)}, {},
            law());
        EXPECT_EQ(once.duration(), twice.duration());
        EXPECT_NEAR(sum_of(twice.steps({})), twice.duration(), 1e-12);
    }
}

TEST(TimeLaw, TheWholeMotionIsTheSumOfItsSteps) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<PathPose> poses;
        for (int k = 0; k < 50; ++k) {
            PathPose pose = pose_at(30 * unit(random), 30 * unit(random), 6 * unit(random) - 2,
                                    5 + 200 * unit(random), unit(random));
            if (k % 7 == 3)
                pose.base_from_tcp.translation() = poses.back().base_from_tcp.translation();
            poses.push_back(pose);
        }
        const ToolPath path(poses, {}, law());
        const auto steps = path.steps({0.7, 0.05, 50.0});
        EXPECT_NEAR(sum_of(steps), path.duration(), 1e-9 * path.duration());
        Vec3 last = steps[0].work_from_contact.translation();
        double time = 0.0;
        for (const PathStep& step : steps) {
            EXPECT_GT(step.duration, 0.0);
            EXPECT_NEAR(step.time, time + 0.5 * step.duration, 1e-9);
            EXPECT_LE((step.work_from_contact.translation() - last).norm(), 0.7 + 1e-9);
            EXPECT_LE(step.feed, poses[step.pose].feed * (1 + 1e-9));
            last = step.work_from_contact.translation();
            time += step.duration;
        }
    }
}

TEST(TimeLaw, PlansAHundredThousandPosesAtOnceAndAlwaysTheSame) {
    std::vector<PathPose> poses;
    for (int k = 0; k < 100'000; ++k) {
        const double x = 0.1 * k;
        poses.push_back(
            pose_at(x, 20.0 * std::sin(0.05 * x), 0.1, kFeed, 0.3 * std::sin(0.01 * x)));
    }
    const auto before = std::chrono::steady_clock::now();
    const ToolPath path(poses, {}, law());
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    EXPECT_LT(seconds, 5.0);  // 0.1 s on an idle machine, optimised
    const ToolPath again(poses, {}, law());
    EXPECT_EQ(path.duration(), again.duration());
    const auto steps = path.steps({}), others = again.steps({});
    ASSERT_EQ(steps.size(), others.size());
    for (std::size_t k = 0; k < steps.size(); ++k) {
        ASSERT_EQ(steps[k].duration, others[k].duration);
        ASSERT_EQ(steps[k].feed, others[k].feed);
    }
    EXPECT_NEAR(sum_of(steps), path.duration(), 1e-9 * path.duration());
}

TEST(TimeLaw, ConstantFeedKnowsNoZonesAndNoAcceleration) {
    const std::vector<PathPose> poses{pose_at(0, 0, 3), pose_at(30, 0, 3, 10.0, 0.2),
                                      pose_at(30, 40, 3, 20.0)};
    const ToolPath path(poses, {});
    EXPECT_EQ(path.duration(), 30.0 / 10.0 + 40.0 / 20.0);
    const auto steps = path.steps({1.0, 1.0, 50.0});
    ASSERT_EQ(steps.size(), 70u);
    for (std::size_t k = 0; k < 70; ++k) {
        // The very same arithmetic as before there were time laws.
        const bool first = k < 30;
        const int part = static_cast<int>(first ? k : k - 30), parts = first ? 30 : 40;
        EXPECT_EQ(steps[k].duration, (first ? 3.0 : 2.0) / parts);
        EXPECT_EQ(steps[k].time, (first ? 0.0 : 3.0) + (part + 0.5) * steps[k].duration);
        const double t = (part + 0.5) / parts;
        EXPECT_EQ(steps[k].work_from_contact.translation().y(), first ? 0.0 : t * 40.0);
    }
}

TEST(TimeLaw, RefusesLimitsThatAreNotPositive) {
    const std::vector<PathPose> poses{pose_at(0, 0, 0), pose_at(1, 0, 0)};
    for (const double wrong : {0.0, -1.0, std::nan("")}) {
        for (double TimeLaw::*member :
             {&TimeLaw::acceleration, &TimeLaw::angular_acceleration, &TimeLaw::rotation_speed}) {
            TimeLaw bad = law();
            bad.*member = wrong;
            EXPECT_THROW(ToolPath(poses, {}, bad), InputError);
        }
    }
    TimeLaw bad = law();
    bad.default_zone = -1.0;
    EXPECT_THROW(ToolPath(poses, {}, bad), InputError);
    auto endless = poses;
    endless[1].zone = std::nan("");
    EXPECT_THROW(ToolPath(endless, {}), InputError);
}

}  // namespace
}  // namespace beltgrinding

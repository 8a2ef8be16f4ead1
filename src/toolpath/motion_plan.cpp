#include "motion_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// Shorter and smaller is the rounding of files and matrices, no motion.
constexpr double kStillTravel = 1e-9;  // mm
constexpr double kStillAngle = 1e-9;   // rad

/// What a motion does per unit of its length, and its limits.
struct Way {
    Vec3 direction = Vec3::Zero();  // mm
    Vec3 turn = Vec3::Zero();       // rad, in the program's frame
    double speed = 0.0;
    double acceleration = 0.0;
};

Way way_of(const PathPose& from, const PathPose& to, const TimeLaw& law, double length,
           double angle, bool turning) {
    Way way;
    if (!turning) {
        way.direction =
            (to.base_from_tcp.translation() - from.base_from_tcp.translation()) / length;
    }
    if (angle > kStillAngle) {
        const Eigen::AngleAxisd turn(to.base_from_tcp.linear() *
                                     from.base_from_tcp.linear().transpose());
        way.turn = turn.axis() * (turn.angle() / length);
    }
    const double rate = way.turn.norm();  // rad per unit of length
    const double far = std::numeric_limits<double>::infinity();
    way.speed = std::min(turning ? far : to.feed, rate > 0.0 ? law.rotation_speed / rate : far);
    way.acceleration = std::min(turning ? far : law.acceleration,
                                rate > 0.0 ? law.angular_acceleration / rate : far);
    return way;
}

/// The speed at which a parabola of the zone `zone` keeps to the accelerations.
double corner_speed(const Way& before, const Way& after, double zone, const TimeLaw& law) {
    const double bend = (after.direction - before.direction).norm() / (2.0 * zone);
    const double swing = (after.turn - before.turn).norm() / (2.0 * zone);
    double square = std::numeric_limits<double>::infinity();
    if (bend > 0.0) square = law.acceleration / bend;
    if (swing > 0.0) square = std::min(square, law.angular_acceleration / swing);
    return std::sqrt(square);
}

}  // namespace

void TimeLaw::validate() const {
    const auto positive = [](double value, const char* code, const char* form) {
        if (!std::isfinite(value) || value <= 0.0) {
            throw InputError(code, form);
        }
    };
    positive(acceleration, "path.acceleration",
             "time law: the path acceleration must be positive and finite");
    positive(angular_acceleration, "path.angular_acceleration",
             "time law: the angular acceleration must be positive and finite");
    positive(rotation_speed, "path.rotation_speed",
             "time law: the rotation speed must be positive and finite");
    if (!std::isfinite(default_zone) || default_zone < 0.0) {
        throw InputError("path.default_zone",
                         "time law: the default zone must be zero (stop) or positive, in mm");
    }
}

MotionPlan::MotionPlan(const std::vector<PathPose>& poses, const TimeLaw& law)
    : motions_(poses.size()) {
    std::vector<Way> ways(poses.size());
    std::vector<std::size_t> moving;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        Motion& motion = motions_[i];
        const double travel =
            (poses[i].base_from_tcp.translation() - poses[i - 1].base_from_tcp.translation())
                .norm();
        const double angle = angle_between(poses[i - 1].base_from_tcp, poses[i].base_from_tcp);
        motion.turning = travel <= kStillTravel;
        motion.length = motion.turning ? angle : travel;
        if (motion.turning && angle <= kStillAngle) {
            motion.length = 0.0;
            continue;
        }
        ways[i] = way_of(poses[i - 1], poses[i], law, motion.length, angle, motion.turning);
        moving.push_back(i);
    }

    std::vector<SpeedLimit> limits;
    limits.reserve(3 * moving.size());
    double speed_before = 0.0;  // limit of the corner at the motion's begin
    for (std::size_t k = 0; k < moving.size(); ++k) {
        Motion& motion = motions_[moving[k]];
        const Way& way = ways[moving[k]];
        motion.stretch = limits.size();
        double speed_after = 0.0;
        bool stop = true;
        if (k + 1 < moving.size()) {
            Motion& next = motions_[moving[k + 1]];
            // Of poses that are programmed twice the smallest zone counts.
            double zone = std::numeric_limits<double>::infinity();
            for (std::size_t i = moving[k]; i < moving[k + 1]; ++i) {
                const bool positioning = poses[i].rapid || poses[i + 1].rapid;
                const double unknown = positioning ? 0.0 : law.default_zone;
                zone = std::min(zone, poses[i].zone < 0.0 ? unknown : poses[i].zone);
            }
            if (zone > 0.0 && motion.turning == next.turning) {
                const double half = 0.5 * std::min(motion.length, next.length);
                zone = motion.turning ? half : std::min(zone, half);
                speed_after = corner_speed(way, ways[moving[k + 1]], zone, law);
                stop = !(speed_after > 0.0);
            }
            if (!stop) {
                motion.after = next.before = zone;
                motion.next = moving[k + 1];
                next.previous = moving[k];
            }
        }
        const auto add = [&](double length, double speed) {
            limits.push_back({length, std::min(speed, way.speed), way.acceleration, false});
        };
        if (motion.before > 0.0) add(motion.before, speed_before);
        add(std::max(0.0, motion.length - motion.before - motion.after), way.speed);
        if (motion.after > 0.0) add(motion.after, speed_after);
        limits.back().stop = stop;
        speed_before = speed_after;
    }
    profile_ = SpeedProfile(limits);
    for (const std::size_t i : moving) {
        Motion& motion = motions_[i];
        const std::size_t count = 1 + (motion.before > 0.0) + (motion.after > 0.0);
        for (std::size_t k = 0; k < count; ++k) {
            motion.duration += profile_.duration(motion.stretch + k);
        }
        duration_ += motion.duration;
    }
}

MotionPlan::Place MotionPlan::place(const Motion& motion, double t) const {
    const double s = std::clamp(t, 0.0, 1.0) * motion.length;
    std::size_t stretch = motion.stretch;
    double begin = 0.0;
    if (motion.before > 0.0) {
        if (s < motion.before) return {stretch, s};
        begin = motion.before;
        ++stretch;
    }
    const double end = motion.length - motion.after;
    if (motion.after > 0.0 && s >= end) return {stretch + 1, s - end};
    return {stretch, s - begin};
}

double MotionPlan::elapsed(std::size_t pose, double t) const {
    const Motion& motion = motions_[pose];
    if (!(motion.length > 0.0)) return 0.0;
    if (t >= 1.0) return motion.duration;
    const Place at = place(motion, t);
    double time = profile_.elapsed(at.stretch, at.length);
    for (std::size_t k = motion.stretch; k < at.stretch; ++k) time += profile_.duration(k);
    return time;
}

double MotionPlan::speed(std::size_t pose, double t) const {
    const Motion& motion = motions_[pose];
    if (!(motion.length > 0.0)) return 0.0;
    const Place at = place(motion, t);
    return profile_.speed(at.stretch, at.length);
}

Frame MotionPlan::corner(const std::vector<PathPose>& poses, std::size_t from, const Motion& before,
                         std::size_t to, const Motion& after, double u) {
    const Frame& pose = poses[from].base_from_tcp;
    const Frame begin =
        interpolate(poses[from - 1].base_from_tcp, pose, 1.0 - before.after / before.length);
    const Frame end = interpolate(poses[to - 1].base_from_tcp, poses[to].base_from_tcp,
                                  after.before / after.length);
    return interpolate(interpolate(begin, pose, u), interpolate(pose, end, u), u);
}

Frame MotionPlan::frame(const std::vector<PathPose>& poses, std::size_t pose, double t) const {
    const Motion& motion = motions_[pose];
    const double s = std::clamp(t, 0.0, 1.0) * motion.length;
    if (s < motion.before) {
        return corner(poses, motion.previous, motions_[motion.previous], pose, motion,
                      0.5 + 0.5 * s / motion.before);
    }
    const double left = motion.length - s;
    if (left < motion.after) {
        return corner(poses, pose, motion, motion.next, motions_[motion.next],
                      0.5 - 0.5 * left / motion.after);
    }
    return interpolate(poses[pose - 1].base_from_tcp, poses[pose].base_from_tcp, t);
}

}  // namespace beltgrinding

#include "motion_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// Shorter and smaller is the rounding of files and matrices, no motion.
constexpr double kStillTravel = 1e-9;     // mm
constexpr double kStillAngle = 1e-9;      // rad
constexpr double kLeastZone = 1e-6;       // mm, of a corner that keeps a share of the feed
constexpr std::size_t kCurveParts = 160;  // of a curved motion, each with limits of its own
constexpr double kFar = std::numeric_limits<double>::infinity();

/// What a motion does per unit of its length, and its limits.
struct Way {
    Vec3 direction = Vec3::Zero();  // mm
    Vec3 turn = Vec3::Zero();       // rad, in the program's frame
    double length = 0.0;
    double feed = 0.0;   // as programmed
    double speed = 0.0;  // no more than that of turning lets it
    double acceleration = 0.0;
    bool turning = false;  // a pure rotation
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
    way.length = length;
    way.turning = turning;
    way.feed = turning ? kFar : to.feed;
    way.speed = std::min(way.feed, rate > 0.0 ? law.rotation_speed / rate : kFar);
    way.acceleration = std::min(turning ? kFar : law.acceleration,
                                rate > 0.0 ? law.angular_acceleration / rate : kFar);
    return way;
}

/// s2/mm: the zone over the square of the speed with which its parabola is run through at the
/// limits of acceleration.
double bend(const Way& before, const Way& after, const TimeLaw& law) {
    return 0.5 * std::max((after.direction - before.direction).norm() / law.acceleration,
                          (after.turn - before.turn).norm() / law.angular_acceleration);
}

/// Where a motion passes into the next one.
struct Corner {
    double zone = 0.0;  // mm; 0: the robot stops
    double speed = 0.0;
    bool curve = false;  // it passes through on a curve
    bool stops() const { return !curve && !(speed > 0.0); }
};

/// The speed at which a parabola of the zone `zone` keeps to the accelerations.
double corner_speed(const Way& before, const Way& after, double zone, const TimeLaw& law) {
    return std::sqrt(zone / bend(before, after, law));
}

/// The zone of a corner through which the robot keeps `share` of the lower of both feeds.
double zone_of_share(const Way& before, const Way& after, double share, const TimeLaw& law) {
    const double speed = share * std::min(before.speed, after.speed);
    return std::max(kLeastZone, bend(before, after, law) * speed * speed);
}

/// The zone of a pose, kFar on a curve; `before` and `after` are the ways beside it.
double zone_at(const PathPose& pose, bool positioning, const Way& before, const Way& after,
               const TimeLaw& law) {
    if (pose.zone >= 0.0) return pose.zone;
    if (positioning) return 0.0;
    if (pose.zone == ZoneCode::kOnCurve) return kFar;
    if (pose.zone < -1.0) return zone_of_share(before, after, ZoneCode::share(pose.zone), law);
    return law.default_zone;
}

/// The tangent where motions pass into each other on a curve, less that of the motion before
/// (`at_end`) or of the one after: their mean, each weighted by its own length, so that beside a
/// short motion that turns sharply a long one does not swing out.
void bend_between(const Way& before, const Way& after, MotionPlan::Bow& bow, bool at_end) {
    const double weight = after.length / (before.length + after.length);
    const Vec3 way = after.direction - before.direction, turn = after.turn - before.turn;
    if (at_end) {
        bow.end = weight * way;
        bow.turn_end = weight * turn;
    } else {
        bow.begin = (weight - 1.0) * way;
        bow.turn_begin = (weight - 1.0) * turn;
    }
}

/// The largest first derivatives of a curve, of place and rotation vector, and its second ones, per
/// mm, from the share t of its way to u.
struct Course {
    double along = 0.0, rate = 0.0, bent = 0.0, swung = 0.0;
};

Course course(const Way& way, const MotionPlan::Bow& bow, double t, double u) {
    Course most;
    for (const double x : {t, 0.5 * (t + u), u}) {
        const double rise = (3.0 * x - 4.0) * x + 1.0, fall = (3.0 * x - 2.0) * x;
        const double first = (6.0 * x - 4.0) / way.length, last = (6.0 * x - 2.0) / way.length;
        const auto more = [](double& value, const Vec3& other) {
            value = std::max(value, other.norm());
        };
        more(most.along, way.direction + rise * bow.begin + fall * bow.end);
        more(most.rate, way.turn + rise * bow.turn_begin + fall * bow.turn_end);
        more(most.bent, first * bow.begin + last * bow.end);
        more(most.swung, first * bow.turn_begin + last * bow.turn_end);
    }
    return most;
}

double over(double most, double by) {
    return by > 0.0 ? most / by : kFar;
}

SpeedLimit limit_of(const Course& most, double length, double feed, const TimeLaw& law) {
    const double square =
        std::min(over(law.acceleration, most.bent), over(law.angular_acceleration, most.swung));
    const double speed =
        std::min({over(feed, most.along), over(law.rotation_speed, most.rate), std::sqrt(square)});
    const double acceleration =
        std::min(over(law.acceleration, most.along), over(law.angular_acceleration, most.rate));
    return {length, speed, acceleration, false};
}

/// Adds the limits of a curved motion's parts: one where only feed and path acceleration limit it.
/// Returns how many.
std::size_t add_curve(const Way& way, const MotionPlan::Bow& bow, const TimeLaw& law,
                      std::vector<SpeedLimit>& limits) {
    const Course whole = course(way, bow, 0.0, 1.0);
    const SpeedLimit one = limit_of(whole, way.length, way.feed, law);
    if (one.speed == over(way.feed, whole.along) &&
        one.acceleration == over(law.acceleration, whole.along)) {
        limits.push_back(one);
        return 1;
    }
    const double parts = static_cast<double>(kCurveParts);
    for (std::size_t k = 0; k < kCurveParts; ++k) {
        const double t = static_cast<double>(k) / parts, u = static_cast<double>(k + 1) / parts;
        limits.push_back(limit_of(course(way, bow, t, u), way.length / parts, way.feed, law));
    }
    return kCurveParts;
}

/// How a motion passes into the next one: `way` into `next`, at the poses from `first` to before
/// `last`.
Corner corner_at(const std::vector<PathPose>& poses, std::size_t first, std::size_t last,
                 const Way& way, const Way& next, const TimeLaw& law) {
    Corner corner{kFar};
    // Of poses that are programmed twice the smallest zone counts.
    for (std::size_t i = first; i < last; ++i) {
        const bool positioning = poses[i].rapid || poses[i + 1].rapid;
        corner.zone = std::min(corner.zone, zone_at(poses[i], positioning, way, next, law));
    }
    const double half = 0.5 * std::min(way.length, next.length);
    if (way.turning != next.turning) corner.zone = 0.0;
    if (way.turning && corner.zone > 0.0) corner.zone = half;
    corner.curve = corner.zone == kFar;
    corner.zone = std::min(corner.zone, half);
    if (corner.zone > 0.0 && !corner.curve) {
        corner.speed = corner_speed(way, next, corner.zone, law);
    }
    return corner;
}

/// The corners at the ends of the motions to the poses `moving`.
std::vector<Corner> corners_of(const std::vector<PathPose>& poses,
                               const std::vector<std::size_t>& moving, const std::vector<Way>& ways,
                               const TimeLaw& law) {
    std::vector<Corner> corners(moving.size());
    for (std::size_t k = 0; k + 1 < moving.size(); ++k) {
        corners[k] =
            corner_at(poses, moving[k], moving[k + 1], ways[moving[k]], ways[moving[k + 1]], law);
    }
    for (std::size_t k = 1; k < corners.size(); ++k) {  // the ends of curves
        if (corners[k - 1].curve && !corners[k].curve) corners[k] = {};
        if (corners[k].curve && !corners[k - 1].curve) corners[k - 1] = {};
    }
    return corners;
}

void add_straight(MotionPlan::Motion& motion, const Way& way, const Corner& before,
                  const Corner& after, std::vector<SpeedLimit>& limits) {
    motion.before = before.stops() ? 0.0 : before.zone;
    motion.after = after.stops() ? 0.0 : after.zone;
    motion.parts = 1 + (motion.before > 0.0) + (motion.after > 0.0);
    const auto add = [&](double length, double speed) {
        limits.push_back({length, std::min(speed, way.speed), way.acceleration, false});
    };
    if (motion.before > 0.0) add(motion.before, before.speed);
    add(std::max(0.0, motion.length - motion.before - motion.after), way.speed);
    if (motion.after > 0.0) add(motion.after, after.speed);
}

void add_curved(MotionPlan::Motion& motion, const std::vector<Way>& ways, std::size_t pose,
                const Corner& before, const Corner& after, const TimeLaw& law,
                std::vector<SpeedLimit>& limits) {
    motion.curved = true;
    if (before.curve) bend_between(ways[motion.previous], ways[pose], motion.bow, false);
    if (after.curve) bend_between(ways[pose], ways[motion.next], motion.bow, true);
    motion.parts = add_curve(ways[pose], motion.bow, law, limits);
}

/// A straight motion's frame at the share t of its way, moved onto its curve.
Frame bowed(Frame frame, const MotionPlan::Bow& bow, double length, double t) {
    const double rise = ((t - 2.0) * t + 1.0) * t * length, fall = (t - 1.0) * t * t * length;
    const Vec3 turn = rise * bow.turn_begin + fall * bow.turn_end;
    frame.translation() += rise * bow.begin + fall * bow.end;
    const double angle = turn.norm();
    if (angle > 0.0) {
        frame.linear() = Eigen::AngleAxisd(angle, turn / angle) * frame.linear();
    }
    return frame;
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

    const std::vector<Corner> corners = corners_of(poses, moving, ways, law);
    std::vector<SpeedLimit> limits;
    limits.reserve(3 * moving.size());
    for (std::size_t k = 0; k < moving.size(); ++k) {
        const Corner before = k > 0 ? corners[k - 1] : Corner{};
        Motion& motion = motions_[moving[k]];
        motion.stretch = limits.size();
        if (k > 0) motion.previous = moving[k - 1];
        if (k + 1 < moving.size()) motion.next = moving[k + 1];
        if (before.curve || corners[k].curve) {
            add_curved(motion, ways, moving[k], before, corners[k], law, limits);
        } else {
            add_straight(motion, ways[moving[k]], before, corners[k], limits);
        }
        limits.back().stop = corners[k].stops();
    }
    profile_ = SpeedProfile(limits);
    for (const std::size_t i : moving) {
        Motion& motion = motions_[i];
        for (std::size_t k = 0; k < motion.parts; ++k) {
            motion.duration += profile_.duration(motion.stretch + k);
        }
        duration_ += motion.duration;
    }
}

MotionPlan::Place MotionPlan::place(const Motion& motion, double t) const {
    const double s = std::clamp(t, 0.0, 1.0) * motion.length;
    if (motion.curved) {
        const double part = motion.length / static_cast<double>(motion.parts);
        const std::size_t k = std::min(static_cast<std::size_t>(s / part), motion.parts - 1);
        return {motion.stretch + k, std::clamp(s - static_cast<double>(k) * part, 0.0, part)};
    }
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
    if (motion.curved) {
        const double u = std::clamp(t, 0.0, 1.0);
        return bowed(interpolate(poses[pose - 1].base_from_tcp, poses[pose].base_from_tcp, u),
                     motion.bow, motion.length, u);
    }
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

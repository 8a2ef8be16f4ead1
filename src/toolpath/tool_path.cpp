#include "beltgrinding/tool_path.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "beltgrinding/error.h"
#include "motion_plan.h"

namespace beltgrinding {
namespace {

constexpr double kRotationFeed = 1.0;          // rad/s, for motions that only turn
constexpr int kHalvings = 40;                  // of a motion's way, to find where it is at a time
constexpr double kRotationTolerance = 1e-6;    // of R^T R from the identity
constexpr std::size_t kMaxSteps = 50'000'000;  // more is a mistake in feed or step, not a job

/// Names the pose before what `error` says of it.
InputError at_pose(const PathPose& pose, std::size_t index, const InputError& error) {
    if (pose.line <= 0)
        return error.within({"path.at_pose", "pose {pose}: ", {{"pose", index + 1}}});
    return error.within({"path.at_line",
                         "pose {pose} (line {line}): ",
                         {{"pose", index + 1}, {"line", pose.line}}});
}

void validate(const PathPose& pose, std::size_t index) {
    const auto matrix = pose.base_from_tcp.matrix();
    if (!matrix.allFinite()) {
        throw at_pose(
            pose, index,
            InputError("path.pose_not_finite", "the pose is not finite; give six real numbers"));
    }
    const Eigen::Matrix3d r = pose.base_from_tcp.linear();
    const double error = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (error > kRotationTolerance || r.determinant() < 0.0) {
        throw at_pose(
            pose, index,
            InputError("path.no_rotation",
                       "the orientation is no rotation (off by {error:f}); give a unit quaternion",
                       {{"error", error}}));
    }
    if (!std::isfinite(pose.feed) || pose.feed <= 0.0) {
        throw at_pose(pose, index,
                      InputError("path.feed", "feed is {feed:f} mm/s; give a positive one",
                                 {{"feed", pose.feed}}));
    }
    if (!std::isfinite(pose.force)) {
        throw at_pose(pose, index, InputError("path.force", "force is not finite; give newtons"));
    }
    if (!std::isfinite(pose.zone)) {
        throw at_pose(pose, index,
                      InputError("path.zone", "the zone is not finite; give millimetres"));
    }
}

double motion_duration(const PathPose& from, const PathPose& to) {
    const double travel =
        (to.base_from_tcp.translation() - from.base_from_tcp.translation()).norm();
    const double angle = angle_between(from.base_from_tcp, to.base_from_tcp);
    return travel > 0.0 ? travel / to.feed : angle / kRotationFeed;
}

}  // namespace

TimeLaw::Timing TimeLaw::timing_named(const std::string& name) {
    if (name == "constant_feed") return Timing::kConstantFeed;
    if (name == "trapezoidal") return Timing::kTrapezoidal;
    throw InputError("call.timing",
                     "time law: there is no timing '{name}'; use constant_feed or trapezoidal",
                     {{"name", name}});
}

Holding holding_named(const std::string& name) {
    if (name == "tool_in_hand") return Holding::kToolInHand;
    if (name == "part_in_hand") return Holding::kPartInHand;
    throw InputError("call.holding", "holding must be tool_in_hand or part_in_hand, not '{name}'",
                     {{"name", name}});
}

Frame CellFrames::work_from_contact(const Frame& base_from_tcp) const {
    if (holding == Holding::kToolInHand) {
        return base_from_work.inverse() * base_from_tcp * tcp_from_contact;
    }
    return (base_from_tcp * tcp_from_work).inverse() * base_from_contact;
}

ToolPath::ToolPath(std::vector<PathPose> poses, CellFrames frames, const TimeLaw& law)
    : poses_(std::move(poses)), frames_(std::move(frames)), law_(law) {
    law_.validate();
    if (poses_.empty()) {
        throw InputError("path.no_pose",
                         "the path has no pose; the program needs at least one Cartesian target");
    }
    for (std::size_t i = 0; i < poses_.size(); ++i) validate(poses_[i], i);
    for (const Frame* f : {&frames_.base_from_work, &frames_.tcp_from_contact,
                           &frames_.tcp_from_work, &frames_.base_from_contact}) {
        if (!f->matrix().allFinite()) {
            throw InputError("path.frame_not_finite",
                             "a frame of the cell is not finite; check the belt machine's set-up");
        }
    }
    if (trapezoidal()) plan_ = std::make_shared<MotionPlan>(poses_, law_);
    ends_.reserve(poses_.size());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
        ends_.push_back((i == 0 ? 0.0 : ends_.back()) + duration(i));
    }
}

double ToolPath::duration() const {
    if (trapezoidal()) return plan_->duration();
    double time = 0.0;
    for (std::size_t i = 1; i < poses_.size(); ++i)
        time += motion_duration(poses_[i - 1], poses_[i]);
    return time;
}

double ToolPath::duration(std::size_t i) const {
    if (i == 0) return 0.0;
    return trapezoidal() ? plan_->duration(i) : motion_duration(poses_[i - 1], poses_[i]);
}

double ToolPath::elapsed(std::size_t i, double t) const {
    return trapezoidal() && i > 0 ? plan_->elapsed(i, t) : t * duration(i);
}

Frame ToolPath::base_from_tcp(std::size_t i, double t) const {
    if (trapezoidal() && i > 0) return plan_->frame(poses_, i, t);
    if (i == 0 || t >= 1.0) return poses_[i].base_from_tcp;
    return interpolate(poses_[i - 1].base_from_tcp, poses_[i].base_from_tcp, t);
}

ToolPath::Moment ToolPath::at(double time) const {
    const auto found = std::lower_bound(ends_.begin(), ends_.end(), time);
    if (found == ends_.end()) return {base_from_tcp(poses_.size() - 1, 1.0), poses_.size() - 1};
    const auto i = static_cast<std::size_t>(found - ends_.begin());
    if (i == 0) return {base_from_tcp(0, 0.0), 0};
    const double since = time - ends_[i - 1], whole = duration(i);
    if (!trapezoidal()) return {base_from_tcp(i, since / whole), i};
    double low = 0.0, high = 1.0;  // of the way
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (elapsed(i, middle) < since ? low : high) = middle;
    }
    return {base_from_tcp(i, high), i};
}

std::vector<PathStep> ToolPath::steps(const SteppingOptions& options) const {
    if (!(options.max_travel > 0.0) || !(options.max_angle > 0.0)) {
        throw InputError("path.step",
                         "the largest step of the simulation must be positive (travel in mm and "
                         "angle in degrees)");
    }
    std::vector<PathStep> steps;
    for (std::size_t i = 1; i < poses_.size(); ++i) {
        const PathPose& from = poses_[i - 1];
        const PathPose& to = poses_[i];
        const double duration = this->duration(i);
        if (!to.rapid && duration > 0.0) {
            const auto frame_at = [&](double t) {
                return trapezoidal() ? plan_->frame(poses_, i, t)
                                     : interpolate(from.base_from_tcp, to.base_from_tcp, t);
            };
            const Frame start =
                frames_.work_from_contact(trapezoidal() ? frame_at(0.0) : from.base_from_tcp);
            const Frame end =
                frames_.work_from_contact(trapezoidal() ? frame_at(1.0) : to.base_from_tcp);
            // With the part in hand the contact's way over the work is no straight line: measure it
            // at the robot's own travel as well as at its ends.
            const double travel = std::max(
                (end.translation() - start.translation()).norm(),
                (to.base_from_tcp.translation() - from.base_from_tcp.translation()).norm());
            const double angle = angle_between(start, end);
            const double wanted = std::max({1.0, std::ceil(travel / options.max_travel),
                                            std::ceil(angle / options.max_angle)});
            if (wanted + static_cast<double>(steps.size()) > static_cast<double>(kMaxSteps)) {
                throw at_pose(to, i,
                              InputError("path.too_many_steps",
                                         "the path needs more than {count} steps; enlarge the step",
                                         {{"count", kMaxSteps}}));
            }
            append_steps(i, 0.0, 1.0, static_cast<int>(wanted),
                         to.force >= 0.0 ? to.force : options.default_force, steps);
        }
    }
    return steps;
}

std::vector<PathStep> ToolPath::cut(const PathStep& step, int parts) const {
    std::vector<PathStep> steps;
    append_steps(step.pose, step.begin, step.end, parts, step.force, steps);
    return steps;
}

void ToolPath::append_steps(std::size_t i, double begin, double end, int parts, double force,
                            std::vector<PathStep>& steps) const {
    const double duration = this->duration(i), time = ends_[i - 1], way = end - begin;
    const auto frame_at = [&](double t) {
        return frames_.work_from_contact(
            trapezoidal() ? plan_->frame(poses_, i, t)
                          : interpolate(poses_[i - 1].base_from_tcp, poses_[i].base_from_tcp, t));
    };
    // At constant feed a motion begins at the pose itself, to the last bit.
    Frame previous = begin > 0.0 || trapezoidal()
                         ? frame_at(begin)
                         : frames_.work_from_contact(poses_[i - 1].base_from_tcp);
    double since = trapezoidal() ? elapsed(i, begin) : 0.0;  // of the step's begin, s
    for (int k = 0; k < parts; ++k) {
        PathStep step;
        step.begin = begin + way * (k / static_cast<double>(parts));
        step.end = begin + way * ((k + 1.0) / parts);
        step.work_from_contact = frame_at(begin + way * ((k + 0.5) / parts));
        const Frame next = frame_at(step.end);
        if (trapezoidal()) {
            const double finish = elapsed(i, step.end);
            step.duration = finish - since;
            step.time = time + 0.5 * (since + finish);
            since = finish;
            if (!(step.duration > 0.0)) continue;
        } else {
            step.duration = way * duration / parts;
            step.time = time + (begin * duration + (k + 0.5) * step.duration);
        }
        const Vec3 moved = next.translation() - previous.translation();
        const double along = std::abs(moved.dot(step.work_from_contact.linear().col(2)));
        step.moved = step.work_from_contact.linear().transpose() * moved;
        const Eigen::AngleAxisd turn(next.linear() * previous.linear().transpose());
        step.turned = step.work_from_contact.linear().transpose() * (turn.axis() * turn.angle());
        step.feed = moved.norm() / step.duration;
        step.plunging = 2.0 * along * along > moved.squaredNorm();
        step.force = force;
        step.pose = static_cast<std::uint32_t>(i);
        steps.push_back(step);
        previous = next;
    }
}

}  // namespace beltgrinding

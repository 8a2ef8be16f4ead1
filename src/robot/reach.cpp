#include "robot/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "beltgrinding/error.h"
#include "configuration.h"
#include "events/event_log.h"

namespace beltgrinding {
namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kSpeedTolerance = 1e-6;  // relative
constexpr double kLimitTolerance = 1e-9;  // rad
constexpr int kWristJoint = 3;            // joints 4 to 6 are the wrist's
constexpr double kFarAngle = 1e-3;        // rad; less is no matter of orientation

class Check {
  public:
    Check(const ToolPath& path, const RobotArm& arm, const ReachOptions& options)
        : path_(path), arm_(arm), options_(options), follower_(path, arm, options), events_(path) {
        result_.least.setConstant(std::numeric_limits<double>::infinity());
        result_.greatest = -result_.least;
    }

    ReachResult run(const RunContext& context) {
        const std::size_t count = path_.poses().size();
        const Joints none = Joints::Constant(std::numeric_limits<double>::quiet_NaN());
        result_.joints.assign(count, none);
        if (options_.start) at_ = ArmSolution{*options_.start, -1};
        for (std::size_t i = 0; i < count; ++i) {
            context.throw_if_cancelled();
            context.report(static_cast<double>(i) / static_cast<double>(count));
            here_ = i > 0 && !path_.poses()[i].rapid && known_ ? linear(i) : rapid(i);
            if (here_) result_.joints[i] = at_->q;
        }
        result_.events = events_.take();
        if (result_.checks == 0 || !result_.least.allFinite()) {
            result_.least = result_.greatest = none;
        }
        return std::move(result_);
    }

  private:
    /// By joint interpolation, where limits hold on the way if they hold at its ends; or to the
    /// first pose of a linear motion that is within reach.
    bool rapid(std::size_t i) {
        const double duration = path_.duration(i);
        const bool by_joints = i == 0 || path_.poses()[i].rapid;
        if (by_joints) ++index_;  // no event lasts over a rapid motion
        time_ += duration;
        step_.pose = static_cast<std::uint32_t>(i);
        share_ = 1.0;
        step_.duration = by_joints ? 0.0 : duration;
        step_.time = time_ - 0.5 * step_.duration;
        const auto& given = path_.poses()[i].joints;
        const auto found = given ? follower_.arrive(i, ArmSolution{*given, -1}, true)
                                 : follower_.arrive(i, at_, i == 0 && options_.start.has_value());
        if (found) {
            const bool joined = by_joints && i > 0 && here_;
            at_ = found;
            known_ = true;
            note_joints();
            result_.way.push_back({at_->q, time_, step_.pose, joined});
        } else {
            note_unreached(follower_.target(i, 1.0));
        }
        ++index_;
        return found.has_value();
    }

    /// In checks; an unreachable stretch is left and entered in the nearest configuration.
    bool linear(std::size_t i) {
        const double turn =
            angle_between(path_.poses()[i - 1].base_from_tcp, path_.poses()[i].base_from_tcp);
        const int parts = follower_.parts(i, options_.max_travel, options_.max_angle);
        step_.pose = static_cast<std::uint32_t>(i);
        double begin = 0.0;
        for (int k = 0; k < parts; ++k) {
            const double end = share_ = (k + 1.0) / parts;
            const double finish = path_.elapsed(i, end);
            step_.duration = finish - begin;
            step_.time = time_ + 0.5 * (begin + finish);
            begin = finish;
            const auto next = follower_.follow(i, static_cast<double>(k) / parts, end, *at_);
            if (next) {
                // Across a stretch out of reach, nothing is known of speeds and turns.
                const Joints turned = next->q - at_->q;
                if (here_) note_motion(turned, turn / parts);
                const bool joined = here_ && turned.cwiseAbs().maxCoeff() <= options_.flip;
                at_ = next;
                result_.way.push_back({at_->q, time_ + finish, step_.pose, joined});
                note_joints();
                note_singularity();
            } else {
                note_unreached(follower_.target(i, end));
            }
            here_ = next.has_value();
            ++index_;
        }
        time_ += path_.duration(i);
        return here_;
    }

    void note(const char* kind, double value, double limit, std::vector<Fact> facts, int part = 0) {
        Event* event = events_.note(kind, index_, step_, value, part);
        if (event == nullptr) return;
        event->limit = limit;
        event->facts = std::move(facts);
        event->point =
            path_.frames().work_from_contact(path_.base_from_tcp(step_.pose, share_)).translation();
    }

    void note_unreached(const Frame& target) {
        ++result_.checks;
        if (!astray_) astray_ = at_ ? at_->q : Joints(0.5 * (arm_.lower() + arm_.upper()));
        const NearestReach end = approach(arm_, target, *astray_);
        astray_ = end.q;
        Fact fact = {"event.out_of_reach",
                     "the robot cannot reach it: {missing:.1f} mm are missing",
                     {{"missing", end.position_error}}};
        if (end.angle_error > kFarAngle) {
            fact = {"event.out_of_reach_turned",
                    "the robot cannot reach it: {missing:.1f} mm are missing and {angle:.1f} deg",
                    {{"missing", end.position_error}, {"angle", kDegrees * end.angle_error}}};
        }
        note("out_of_reach", end.position_error, Event::kNone, {fact});
    }

    void note_joints() {
        ++result_.checks;
        astray_.reset();
        const Joints& q = at_->q;
        result_.least = result_.least.cwiseMin(q);
        result_.greatest = result_.greatest.cwiseMax(q);
        for (int j = 0; j < 6; ++j) {
            const double low = arm_.lower()[j], high = arm_.upper()[j];
            const double beyond = std::max(low - q[j], q[j] - high);
            if (beyond <= kLimitTolerance) continue;
            std::vector<Fact> facts = {{"event.joint_limit",
                                        "joint {joint} at {angle:.1f} deg, {beyond:.1f} deg beyond "
                                        "its limit of {limit:.1f} deg",
                                        {{"joint", j + 1},
                                         {"angle", kDegrees * q[j]},
                                         {"beyond", kDegrees * beyond},
                                         {"limit", kDegrees * (q[j] < low ? low : high)}}}};
            const double back = q[j] + (q[j] < low ? 2.0 : -2.0) * M_PI;
            if (back >= low && back <= high) {
                facts.push_back({"event.wound_up",
                                 "wound up: it would fit at {angle:.1f} deg",
                                 {{"angle", kDegrees * back}}});
            }
            note("joint_limit", kDegrees * beyond, 0.0, std::move(facts), j);
        }
    }

    void note_motion(const Joints& turned, double turn) {
        for (const int first : {0, kWristJoint}) {
            int worst = first;
            for (int j = first; j < first + kWristJoint; ++j)
                if (std::abs(turned[j]) > std::abs(turned[worst])) worst = j;
            if (std::abs(turned[worst]) <= options_.flip) continue;
            const Fact fact = {
                "event.joints_turn",
                "between two checks, joint {first} turns {by_first:.0f} deg, joint {second} turns "
                "{by_second:.0f} deg, joint {third} turns {by_third:.0f} deg",
                {{"first", first + 1},
                 {"by_first", kDegrees * turned[first]},
                 {"second", first + 2},
                 {"by_second", kDegrees * turned[first + 1]},
                 {"third", first + 3},
                 {"by_third", kDegrees * turned[first + 2]}}};
            note(first == 0 ? "arm_flip" : "wrist_flip", kDegrees * std::abs(turned[worst]),
                 kDegrees * options_.flip, {fact});
        }
        const double time = std::max(step_.duration, turn / options_.turn_speed);
        if (time <= 0.0) return;
        for (int j = 0; j < 6; ++j) {
            const double limit = arm_.max_speed()[j];
            const double ratio = limit > 0.0 ? std::abs(turned[j]) / time / limit : 0.0;
            if (ratio <= 1.0 + kSpeedTolerance) continue;
            note("joint_speed", ratio, 1.0,
                 {{"event.joint_speed",
                   "joint {joint} would have to turn at {speed:.0f} deg/s, {ratio:.2f} times its "
                   "greatest speed",
                   {{"joint", j + 1}, {"speed", kDegrees * ratio * limit}, {"ratio", ratio}}},
                  {"event.robot_slower", "the robot will be slower than programmed or stop", {}}},
                 j);
        }
    }

    void note_singularity() {
        const SingularDistance d = singular_distance(arm_, at_->q);
        const struct {
            double angle;
            const char* code;
            const char* form;
        } kinds[] = {{d.wrist, "event.wrist_singularity",
                      "wrist: axes 4 and 6 are {angle:.2f} deg off one line"},
                     {d.elbow, "event.elbow_singularity",
                      "elbow: the arm is {angle:.2f} deg off stretched out"},
                     {d.shoulder, "event.shoulder_singularity",
                      "shoulder: the wrist is {angle:.2f} deg off the plane over axis 1"},
                     {d.general, "event.singularity",
                      "the least singular value of the Jacobian is that of {angle:.2f} deg"}};
        int part = 0;
        for (const auto& kind : kinds) {
            if (kind.angle < options_.singularity) {
                const double angle = kDegrees * kind.angle;
                note("singularity", angle, kDegrees * options_.singularity,
                     {{kind.code, kind.form, {{"angle", angle}}}}, part);
            }
            ++part;
        }
    }

    const ToolPath& path_;
    const RobotArm& arm_;
    const ReachOptions& options_;
    Follower follower_;
    EventLog events_;
    ReachResult result_;
    PathStep step_;
    double share_ = 0.0;  // of the motion's way that is done
    double time_ = 0.0;
    std::size_t index_ = 0;
    std::optional<ArmSolution> at_;  // the last configuration that is known
    std::optional<Joints> astray_;   // where the arm reaches for what it cannot reach
    bool known_ = false;             // it is the path's, not only the start
    bool here_ = false;              // it is the one at the check before
};

}  // namespace

ReachResult check_reach(const ToolPath& path, const RobotArm& arm, const ReachOptions& options,
                        const RunContext& context) {
    if (!(options.max_travel > 0.0) || !(options.max_angle > 0.0) || !(options.flip > 0.0) ||
        !(options.singularity >= 0.0) || !(options.turn_speed > 0.0)) {
        throw InputError(
            "reach.steps",
            "reach: travel and angle between checks, the flip and the speed of turning "
            "must be positive");
    }
    if (options.start && !options.start->allFinite()) {
        throw InputError("reach.start", "reach: the joints at the start are not finite");
    }
    return Check(path, arm, options).run(context);
}

}  // namespace beltgrinding

#include "robot/robot_arm.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr double kAngleTolerance = 1e-6;   // rad, of axes that count as parallel
constexpr double kLengthTolerance = 1e-3;  // mm, of axes that count as meeting
constexpr double kFarthest = 1e6;          // mm; an arm is no longer than this

Frame rotation(const Vec3& axis, double angle) {
    return Frame(Eigen::AngleAxisd(angle, axis));
}

Frame turn_about(const Vec3& axis, const Vec3& point, double angle) {
    Frame f = rotation(axis, angle);
    f.translation() = point - f.linear() * point;
    return f;
}

bool parallel(const Vec3& a, const Vec3& b) {
    return a.cross(b).norm() < kAngleTolerance;
}

struct Meeting {
    Vec3 point;
    double distance;  // mm between the two lines
};

/// The middle of the shortest way between two lines that are not parallel.
Meeting meeting(const Vec3& p, const Vec3& a, const Vec3& q, const Vec3& b) {
    const Vec3 w = p - q;
    const double cosine = a.dot(b);
    const double size = 1.0 - cosine * cosine;
    const double s = (cosine * b.dot(w) - a.dot(w)) / size;
    const double t = (b.dot(w) - cosine * a.dot(w)) / size;
    const Vec3 on_a = p + s * a;
    const Vec3 on_b = q + t * b;
    return {0.5 * (on_a + on_b), (on_a - on_b).norm()};
}

double distance_to_line(const Vec3& point, const Vec3& p, const Vec3& axis) {
    return axis.cross(point - p).norm();
}

/// Without its component along `axis`.
Vec3 across(const Vec3& v, const Vec3& axis) {
    return v - axis * axis.dot(v);
}

/// rad in [0, pi / 2] between the lines along u and v.
double line_angle(const Vec3& u, const Vec3& v) {
    return std::atan2(u.cross(v).norm(), std::abs(u.dot(v)));
}

void check(const RobotJoint& joint, std::size_t i) {
    const Eigen::Matrix3d r = joint.parent_from_joint.linear();
    if (!joint.parent_from_joint.matrix().allFinite() || !(r.transpose() * r).isIdentity(1e-6) ||
        joint.parent_from_joint.translation().norm() > kFarthest) {
        throw InputError(
            "robot.joint_frame",
            "robot: joint {joint}: its frame is no rigid transform of an arm's size in mm",
            {{"joint", i + 1}});
    }
    if (!joint.axis.allFinite() || joint.axis.norm() < 1e-9) {
        throw InputError(
            "robot.joint_axis",
            "robot: joint {joint}: its axis has no direction; give a vector such as 0, 0, 1",
            {{"joint", i + 1}});
    }
    if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper) || joint.lower >= joint.upper) {
        throw InputError("robot.joint_limits",
                         "robot: joint {joint}: its lower limit must lie below its upper one",
                         {{"joint", i + 1}});
    }
    if (!std::isfinite(joint.max_speed) || joint.max_speed < 0.0) {
        throw InputError("robot.joint_speed",
                         "robot: joint {joint}: its greatest speed must not be negative",
                         {{"joint", i + 1}});
    }
}

}  // namespace

RobotModel model_from_dh(const std::array<DhRow, 6>& rows, DhConvention convention) {
    RobotModel model;
    Frame rest = Frame::Identity();  // of the row before, what follows its joint
    for (std::size_t i = 0; i < 6; ++i) {
        const DhRow& row = rows[i];
        if (row.direction != 1.0 && row.direction != -1.0) {
            throw InputError("robot.joint_direction",
                             "robot: joint {joint}: the direction is 1 or -1", {{"joint", i + 1}});
        }
        const Frame link = Eigen::Translation3d(row.a, 0, 0) * rotation(Vec3::UnitX(), row.alpha);
        Frame& at = model.joints[i].parent_from_joint;
        at = convention == DhConvention::kModified ? rest * link : rest;
        at = at * rotation(Vec3::UnitZ(), row.offset);
        model.joints[i].axis = row.direction * Vec3::UnitZ();
        rest = Frame(Eigen::Translation3d(0, 0, row.d));
        if (convention == DhConvention::kStandard) rest = rest * link;
    }
    model.joint6_from_flange = rest;
    return model;
}

RobotArm::RobotArm(const RobotModel& model) : model_(model) {
    if (!model.joint6_from_flange.matrix().allFinite()) {
        throw InputError("robot.flange", "robot: its flange is not finite");
    }
    if (model.coupling != 0.0 && std::abs(model.coupling) != 1.0) {
        throw InputError("robot.coupling",
                         "robot: the coupling of joint 3 with joint 2 is 0, 1 or -1");
    }
    Frame at = Frame::Identity();
    for (std::size_t i = 0; i < 6; ++i) {
        check(model.joints[i], i);
        const RobotJoint& joint = model.joints[i];
        at = at * joint.parent_from_joint;
        axis_[i] = (at.linear() * joint.axis).normalized();
        point_[i] = at.translation();
        const auto k = static_cast<Eigen::Index>(i);
        lower_[k] = joint.lower;
        upper_[k] = joint.upper;
        max_speed_[k] = joint.max_speed;
    }
    home_ = at * model.joint6_from_flange;
    wrist_ = point_[5];
    Vec3 end = wrist_;
    if (!parallel(axis_[4], axis_[5])) {
        const Meeting met = meeting(point_[4], axis_[4], point_[5], axis_[5]);
        const bool meet = met.distance < kLengthTolerance;
        if (meet) wrist_ = end = met.point;
        if (meet && parallel(axis_[1], axis_[2])) {
            if (distance_to_line(wrist_, point_[3], axis_[3]) < kLengthTolerance &&
                !parallel(axis_[3], axis_[4])) {
                structure_ = Structure::kSphericalWrist;
            } else if (parallel(axis_[1], axis_[3])) {
                structure_ = Structure::kParallelElbow;
                end = point_[3];
            }
        }
    }
    length_ =
        across(point_[2] - point_[1], axis_[1]).norm() + across(end - point_[2], axis_[1]).norm();
    if (length_ < kLengthTolerance) {
        throw InputError("robot.no_length",
                         "robot: upper arm and forearm have no length; check the joints' origins");
    }
}

Joints RobotArm::geometric(const Joints& q) const {
    Joints theta = q;
    theta[2] += model_.coupling * q[1];
    return theta;
}

Joints RobotArm::shown(const Joints& theta) const {
    Joints q = theta;
    q[2] -= model_.coupling * theta[1];
    return q;
}

Frame RobotArm::forward(const Joints& q) const {
    const Joints theta = geometric(q);
    Frame f = Frame::Identity();
    for (int i = 0; i < 6; ++i) f = f * turn_about(axis(i), point(i), theta[i]);
    return f * home_;
}

RobotArm::Placed RobotArm::placed(const Joints& q) const {
    const Joints theta = geometric(q);
    Placed now;
    Frame f = Frame::Identity();
    for (int i = 0; i < 6; ++i) {
        const auto k = static_cast<std::size_t>(i);
        now.axis[k] = f.linear() * axis_[k];
        now.point[k] = f * point_[k];
        // All structures have the wrist on axis 5, so that it is where joint 4 took it.
        if (i == 4) now.wrist = f * wrist_;
        if (i == 5 && structure_ == Structure::kGeneral) now.wrist = f * wrist_;
        f = f * turn_about(axis_[k], point_[k], theta[i]);
    }
    now.robot_from_flange = f * home_;
    return now;
}

std::array<Frame, 7> RobotArm::links(const Joints& q) const {
    const Joints theta = geometric(q);
    std::array<Frame, 7> frames;
    frames[0] = Frame::Identity();
    for (int i = 0; i < 6; ++i) {
        const auto k = static_cast<std::size_t>(i);
        frames[k + 1] = frames[k] * turn_about(axis_[k], point_[k], theta[i]);
    }
    return frames;
}

Eigen::Matrix<double, 6, 6> RobotArm::jacobian(const Joints& q) const {
    const Placed now = placed(q);
    const Vec3 tip = now.robot_from_flange.translation();
    Eigen::Matrix<double, 6, 6> j;
    for (std::size_t i = 0; i < 6; ++i) {
        j.col(static_cast<Eigen::Index>(i)) << now.axis[i].cross(tip - now.point[i]), now.axis[i];
    }
    j.col(1) += model_.coupling * j.col(2);
    return j;
}

namespace {

/// Sine of the elbow's turn out of the stretched arm, about axis 3, times lengths.
double bent(const RobotArm::Placed& at) {
    return at.axis[2].dot(across(at.point[2] - at.point[1], at.axis[2])
                              .cross(across(at.wrist - at.point[2], at.axis[2])));
}

}  // namespace

ArmConfiguration configuration_at(const RobotArm& arm, const Joints& q) {
    ArmConfiguration found;
    const RobotArm::Placed now = arm.placed(q);
    const Vec3 forward =
        rotation(arm.axis(0), arm.geometric(q)[0]) * across(Vec3::UnitX(), arm.axis(0));
    found.behind = forward.dot(now.wrist - now.point[0]) < 0.0;
    found.below = bent(now) < 0.0;
    found.flipped = now.axis[4].dot(now.axis[3].cross(now.axis[5])) < 0.0;
    found.back = (bent(now) < 0.0) != (bent(arm.placed(Joints::Zero())) < 0.0);
    return found;
}

SingularDistance singular_distance(const RobotArm& arm, const Joints& q) {
    SingularDistance near;
    if (arm.structure() == RobotArm::Structure::kGeneral) {
        Eigen::Matrix<double, 6, 6> j = arm.jacobian(q);
        j.topRows<3>() /= arm.length();
        near.general = j.jacobiSvd().singularValues()[5];
        return near;
    }
    const RobotArm::Placed now = arm.placed(q);
    const bool spherical = arm.structure() == RobotArm::Structure::kSphericalWrist;
    const Vec3 end = spherical ? now.wrist : now.point[3];
    near.wrist = line_angle(now.axis[3], now.axis[5]);
    near.elbow = line_angle(across(now.point[2] - now.point[1], now.axis[1]),
                            across(end - now.point[2], now.axis[1]));
    // What joint 1 moves the wrist across the plane in which joints 2 and 3 (and 4) move it.
    const Vec3 way = now.axis[0].cross(now.wrist - now.point[0]);
    near.shoulder = std::asin(std::min(1.0, std::abs(now.axis[1].dot(way)) / arm.length()));
    return near;
}

}  // namespace beltgrinding

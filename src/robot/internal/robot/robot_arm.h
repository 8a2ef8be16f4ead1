#pragma once

#include <array>
#include <string>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

using Joints = Eigen::Matrix<double, 6, 1>;  ///< rad, as the controller shows them

/// A revolute joint, as a URDF has it: the child turns about `axis`, which passes through the
/// origin of the joint's frame.
struct RobotJoint {
    Frame parent_from_joint = Frame::Identity();  ///< mm, at joint angle 0
    Vec3 axis = Vec3::UnitZ();                    ///< in the joint's frame; made a unit vector
    double lower = -M_PI;                         ///< rad
    double upper = M_PI;                          ///< rad
    double max_speed = 0.0;                       ///< rad/s; 0: not known
};

/// One row of a Denavit-Hartenberg table: mm, rad. The joint's angle q enters as
/// theta = direction * q + offset.
struct DhRow {
    double a = 0.0;
    double alpha = 0.0;
    double d = 0.0;
    double offset = 0.0;
    double direction = 1.0;  ///< 1 or -1
};

enum class DhConvention {
    kStandard,  ///< Rz(theta) Tz(d) Tx(a) Rx(alpha); a and alpha follow the joint
    kModified,  ///< Rx(alpha) Tx(a) Rz(theta) Tz(d); a and alpha precede the joint (Craig)
};

/// Geometry and limits of a serial arm of six revolute joints.
struct RobotModel {
    std::array<RobotJoint, 6> joints;
    Frame joint6_from_flange = Frame::Identity();
    /// Angle between upper arm and forearm = q3 + coupling * q2. 0: joint 3 is measured from the
    /// upper arm; 1 or -1: from the ground, as controllers of Fanuc and of parallelogram arms show
    /// it.
    double coupling = 0.0;
};

/// Joint frames and flange of a DH table; limits and speeds are left as they are by default.
/// Throws InputError for a direction other than 1 or -1.
RobotModel model_from_dh(const std::array<DhRow, 6>& rows, DhConvention convention);

/// The kinematics of an arm, kept as a product of exponentials: unit axes and points on them in the
/// robot's base frame at all angles 0.
class RobotArm {
  public:
    /// What inverse kinematics can make use of.
    enum class Structure {
        kSphericalWrist,  ///< axes 2, 3 parallel, axes 4, 5, 6 meet in a point
        kParallelElbow,   ///< axes 2, 3, 4 parallel, axes 5, 6 meet (Universal Robots)
        kGeneral,
    };

    /// Throws InputError naming the joint: not finite, no axis, limits the wrong way round.
    explicit RobotArm(const RobotModel& model);

    const RobotModel& model() const { return model_; }
    Structure structure() const { return structure_; }
    const Joints& lower() const { return lower_; }
    const Joints& upper() const { return upper_; }
    const Joints& max_speed() const { return max_speed_; }
    /// At all angles 0, i from 0.
    const Vec3& axis(int i) const { return axis_[static_cast<std::size_t>(i)]; }
    const Vec3& point(int i) const { return point_[static_cast<std::size_t>(i)]; }
    const Frame& home() const { return home_; }
    /// Where the wrist's axes (4, 5, 6 or 5, 6) meet at all angles 0; kGeneral: on axis 6.
    const Vec3& wrist() const { return wrist_; }
    /// mm, from axis 2 to the wrist with the arm stretched.
    double length() const { return length_; }

    /// robot_from_flange.
    Frame forward(const Joints& q) const;
    /// Velocity of the flange's origin (rows 0 to 2, mm) and angular velocity (rows 3 to 5) per
    /// joint speed, in the robot's base.
    Eigen::Matrix<double, 6, 6> jacobian(const Joints& q) const;

    /// Angles about the axes, from what the controller shows, and back.
    Joints geometric(const Joints& q) const;
    Joints shown(const Joints& theta) const;

    /// Axes (unit) and points on them in the robot's base at q.
    struct Placed {
        std::array<Vec3, 6> axis;
        std::array<Vec3, 6> point;
        Vec3 wrist;
        Frame robot_from_flange;
    };
    Placed placed(const Joints& q) const;
    /// robot_from_link of the foot and what each of the six joints carries; at all angles 0 these
    /// are identities, so a link's shape is given where it lies in the robot's base then.
    std::array<Frame, 7> links(const Joints& q) const;

  private:
    RobotModel model_;
    Structure structure_ = Structure::kGeneral;
    Joints lower_, upper_, max_speed_;
    std::array<Vec3, 6> axis_, point_;
    Frame home_;
    Vec3 wrist_;
    double length_ = 0.0;
};

/// How near an arm is to its three classical singularities, rad; 0 is singular.
struct SingularDistance {
    double wrist = M_PI / 2;     ///< between the lines of axes 4 and 6
    double elbow = M_PI / 2;     ///< of the forearm off the line of the upper arm
    double shoulder = M_PI / 2;  ///< of the wrist off the plane of axes 1 and 2, over the length
    /// kGeneral: the least singular value of the Jacobian with lengths over the arm's; the three
    /// others are not set then.
    double general = M_PI / 2;
};

SingularDistance singular_distance(const RobotArm& arm, const Joints& q);

/// Which of the eight configurations an arm with a spherical wrist is in; of others nothing is
/// told.
struct ArmConfiguration {
    bool behind = false;   ///< the wrist is behind axis 1, seen along the base's x turned with it
    bool below = false;    ///< joint 3 is turned less than where the arm is stretched
    bool flipped = false;  ///< joint 5 is turned to less than where axes 4 and 6 are one line
    /// The wrist lies on the side of the upper arm on which it is not at all angles 0.
    bool back = false;
};

ArmConfiguration configuration_at(const RobotArm& arm, const Joints& q);

}  // namespace beltgrinding

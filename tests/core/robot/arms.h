#pragma once

#include <random>

#include "robot/robot_arm.h"

namespace beltgrinding::testing {

constexpr double kDegree = M_PI / 180.0;

inline Joints degrees(double a, double b, double c, double d, double e, double f) {
    Joints q;
    q << a, b, c, d, e, f;
    return q * kDegree;
}

/// A small arm with a spherical wrist, offsets as of common robots: KUKA's zero is the arm
/// stretched out forward.
inline RobotModel wrist_arm() {
    RobotModel model;
    const Vec3 origins[6] = {{0, 0, 400}, {25, 0, 0},  {455, 0, 0},
                             {0, 0, 35},  {420, 0, 0}, {80, 0, 0}};
    const Vec3 axes[6] = {{0, 0, -1}, {0, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    const double limits[6][2] = {{-170, 170}, {-190, 45},  {-120, 156},
                                 {-185, 185}, {-120, 120}, {-350, 350}};
    for (std::size_t i = 0; i < 6; ++i) {
        model.joints[i].parent_from_joint.translation() = origins[i];
        model.joints[i].axis = axes[i];
        model.joints[i].lower = limits[i][0] * kDegree;
        model.joints[i].upper = limits[i][1] * kDegree;
        model.joints[i].max_speed = 300 * kDegree;
    }
    model.joint6_from_flange.linear() =
        Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()).toRotationMatrix();
    return model;
}

/// Universal Robots' UR5e by its published DH table.
inline RobotModel parallel_arm() {
    const double h = M_PI / 2;
    RobotModel model = model_from_dh(
        {{{0, h, 162.5}, {-425, 0, 0}, {-392.2, 0, 0}, {0, h, 133.3}, {0, -h, 99.7}, {0, 0, 99.6}}},
        DhConvention::kStandard);
    for (RobotJoint& joint : model.joints) {
        joint.lower = -2 * M_PI;
        joint.upper = 2 * M_PI;
        joint.max_speed = M_PI;
    }
    return model;
}

/// The same as one leaves the works: no two axes are parallel or meet any more.
inline RobotModel calibrated_arm() {
    RobotModel model = parallel_arm();
    for (std::size_t i = 0; i < 6; ++i) {
        const double k = static_cast<double>(i);
        model.joints[i].parent_from_joint =
            model.joints[i].parent_from_joint * Eigen::Translation3d(0.3 - 0.1 * k, 0.2 * k, 0.25) *
            Eigen::AngleAxisd(0.002 * (k - 2.3), Vec3(1, 2, 0.5).normalized());
    }
    return model;
}

inline Joints random_joints(const RobotArm& arm, std::mt19937& random) {
    Joints q;
    for (int i = 0; i < 6; ++i) {
        q[i] = std::uniform_real_distribution<double>(arm.lower()[i], arm.upper()[i])(random);
    }
    return q;
}

}  // namespace beltgrinding::testing

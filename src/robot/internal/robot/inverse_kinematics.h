#pragma once

#include <optional>
#include <vector>

#include "robot/robot_arm.h"

namespace beltgrinding {

/// Joint angles that put the flange where it is asked.
struct ArmSolution {
    Joints q =
        Joints::Zero();  ///< rad, each within half a turn of the reference; limits not heeded
    int branch = -1;     ///< shoulder, elbow, wrist as bits 2, 1, 0; -1: found numerically
};

/// All solutions (up to 8) that put the flange at `robot_from_flange`, in closed form for arms with
/// structure, else what damped least squares finds from `near` and, with `search`, from many other
/// places. Where a singularity leaves a joint free it stays at `near`. Each reproduces the pose
/// within 1e-6 mm and 1e-7 rad, or it is left out.
std::vector<ArmSolution> inverse(const RobotArm& arm, const Frame& robot_from_flange,
                                 const Joints& near, bool search = true);

/// The nearest that the arm can come, by damped least squares (Levenberg-Marquardt) from `seed`.
struct NearestReach {
    Joints q = Joints::Zero();
    double position_error = 0.0;  ///< mm
    double angle_error = 0.0;     ///< rad
};
NearestReach approach(const RobotArm& arm, const Frame& robot_from_flange, const Joints& seed);

/// `angle` plus whole turns, within half a turn of `near`.
double nearest_turn(double angle, double near);

}  // namespace beltgrinding

#pragma once

#include <optional>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// One programmed pose of the robot.
struct PathPose {
    Frame base_from_tcp = Frame::Identity();  ///< in the frame that the program names
    double feed = 100.0;  ///< mm/s at which the pose is approached from the one before
    double force = -1.0;  ///< N, commanded at and towards this pose; negative: the job's force
    bool rapid = false;   ///< a positioning move (PTP): nothing is ground on the way to this pose
    int line = 0;         ///< line of the source file, from 1; 0: unknown
    /// mm before and after the pose within which the robot rounds the corner; 0: it stands still
    /// there; negative: unknown (the time law's default zone)
    double zone = -1.0;
    /// rad; the robot's joints there, where the program gives them (a joint target)
    std::optional<Eigen::Matrix<double, 6, 1>> joints;
};

/// Linear in position, slerp in orientation, in the program's frame; t in [0, 1].
Frame interpolate(const Frame& a, const Frame& b, double t);

/// rad, within [0, pi]
double angle_between(const Frame& a, const Frame& b);

}  // namespace beltgrinding

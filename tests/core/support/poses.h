#pragma once

#include <numbers>

#include "beltgrinding/tool_path.h"

namespace beltgrinding::testing {

/// A pose at (x, y, z) whose z axis points down, its x axis turned by `turn` rad about the
/// vertical.
inline PathPose pressing_down(double x, double y, double z, double feed, double turn = 0.0) {
    PathPose pose;
    pose.base_from_tcp = Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(turn, Vec3::UnitZ()) *
                         Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX());
    pose.feed = feed;
    return pose;
}

}  // namespace beltgrinding::testing

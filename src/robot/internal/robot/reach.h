#pragma once

#include <optional>
#include <vector>

#include "beltgrinding/event.h"
#include "beltgrinding/run_context.h"
#include "beltgrinding/tool_path.h"
#include "robot/robot_arm.h"

namespace beltgrinding {

struct ReachOptions {
    Frame base_from_robot = Frame::Identity();  ///< the robot's base in the frame of the poses
    Frame flange_from_tcp = Frame::Identity();  ///< the tool's frame (or the held part's)
    std::optional<Joints> start;                ///< rad, where each program begins
    double max_travel = 1.0;   ///< mm of the TCP between two checks of a linear motion
    double max_angle = 0.02;   ///< rad it turns between them
    double singularity = 0.1;  ///< rad, nearer to a singularity is an event
    double flip = 0.8;         ///< rad that a joint may turn between two checks
    double turn_speed = M_PI;  ///< rad/s at which the controller turns the tool at most
};

/// Where the joints are at a moment of the path.
struct ArmMoment {
    Joints q = Joints::Zero();  ///< rad
    double time = 0.0;          ///< s since the program's begin
    std::uint32_t pose = 0;     ///< that the motion leads to, from 0
    /// It is reached by joint interpolation from the moment before it; else the arm was out of
    /// reach, or turned over, in between.
    bool joined = false;
};

/// What the robot's joints do along a path.
struct ReachResult {
    std::vector<Joints> joints;  ///< rad, at each programmed pose; NaN where there is no solution
    /// In order of time. out_of_reach (value: mm that are missing), joint_limit (deg beyond),
    /// singularity (deg from it), wrist_flip and arm_flip (deg that a joint turns between two
    /// checks), joint_speed (times the greatest speed).
    std::vector<Event> events;
    Joints least = Joints::Zero();     ///< rad, over all checks
    Joints greatest = Joints::Zero();  ///< rad
    std::size_t checks = 0;
    std::vector<ArmMoment> way;  ///< every check at which the robot is where the path wants it
};

/// Follows `path` with `arm`: linear motions in small checks, each taking the solution nearest to
/// the one before, refined where a branch ends; rapid motions by joint interpolation to the
/// configuration that gets furthest along the linear motions that follow, without a limit or a
/// flip, and turns the joints least (the first: with the largest margin). Throws InputError for
/// options that are no positive numbers, Cancelled.
ReachResult check_reach(const ToolPath& path, const RobotArm& arm, const ReachOptions& options,
                        const RunContext& context = {});

}  // namespace beltgrinding

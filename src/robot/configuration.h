#pragma once

#include <optional>
#include <vector>

#include "robot/inverse_kinematics.h"
#include "robot/reach.h"

namespace beltgrinding {

/// What the flange does along a path, and which of the arm's configurations take part in it.
class Follower {
  public:
    Follower(const ToolPath& path, const RobotArm& arm, const ReachOptions& options);

    /// robot_from_flange on the way to pose number `pose`, t in (0, 1].
    Frame target(std::size_t pose, double t) const;
    /// Number of equal parts of the motion to `pose` that are no longer than asked.
    int parts(std::size_t pose, double max_travel, double max_angle) const;

    /// The solution at t of the motion to `pose` that continues `from`, where the robot is at
    /// `begin`: refined between the two while a joint jumps or the branch changes. None: out of
    /// reach.
    std::optional<ArmSolution> follow(std::size_t pose, double begin, double end,
                                      const ArmSolution& from) const;

    /// The configuration in which to arrive at `pose` by joint interpolation, from `before` if that
    /// is known: the one that gets furthest along the linear motions that follow, or with `close`
    /// the one closest to `before`. None: out of reach.
    std::optional<ArmSolution> arrive(std::size_t pose, const std::optional<ArmSolution>& before,
                                      bool close) const;

  private:
    struct Score {
        std::size_t lasts = 0;  // checks of this and the linear motions that follow, in limits
        double beyond = 0.0;    // rad past the limits of the joints, together
        double cost = 0.0;      // the less, the better

        bool better_than(const Score& other) const {
            if (lasts != other.lasts) return lasts > other.lasts;
            return beyond != other.beyond ? beyond < other.beyond : cost < other.cost;
        }
    };
    std::optional<ArmSolution> nearest(const Frame& target, const ArmSolution& from) const;
    std::optional<ArmSolution> refine(std::size_t pose, double begin, double end,
                                      const ArmSolution& from, int depth) const;
    std::vector<Joints> ahead(std::size_t pose, const ArmSolution& start) const;
    Score score(const Joints& candidate, const std::vector<Joints>& ahead,
                const std::optional<ArmSolution>& before) const;

    const ToolPath& path_;
    const RobotArm& arm_;
    const ReachOptions& options_;
    Frame robot_from_base_;
    Frame tcp_from_flange_;
};

/// Least distance of a joint to its limits, rad; negative beyond them, by the sum of all joints.
double limit_margin(const RobotArm& arm, const Joints& q);

}  // namespace beltgrinding

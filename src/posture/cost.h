#pragma once

#include <vector>

#include "posture/posture.h"
#include "robot/robot_arm.h"

namespace beltgrinding {

/// What postures cost, s (see `PostureCost`).
class Cost {
  public:
    Cost(const RobotArm& arm, const PostureOptions& options) : arm_(arm), options_(options) {}

    /// Of a link.
    double travel(const Coordinates& a, const Coordinates& b) const {
        return (b - a).cwiseAbs().cwiseQuotient(options_.speed).sum();
    }
    /// s that the joints' speeds take longer than `duration`, weighed.
    double slow(const Coordinates& a, const Coordinates& b, double duration) const;
    double edge(const Coordinates& a, const Coordinates& b, double duration) const {
        return travel(a, b) + slow(a, b, duration);
    }
    /// At the pose between two motions.
    double acceleration(const Coordinates& a, const Coordinates& b, const Coordinates& c,
                        double before, double after) const;
    /// Nearness to limits and singularities, for a second there.
    double place(const Coordinates& at) const;

  private:
    const RobotArm& arm_;
    const PostureOptions& options_;
};

/// s that each pose of a pass counts for: half of the motions beside it.
std::vector<double> times_at(const std::vector<PassPose>& poses);

/// Least s that a body near by costs there in a second, and one that is met, whatever the time.
constexpr double kNearCost = 2.0;
constexpr double kMetCost = 1e4;

}  // namespace beltgrinding

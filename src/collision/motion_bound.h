#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/tool_path.h"

namespace beltgrinding {

/// How far a body carried by the robot can have moved between two places of the path. A place is a
/// number i + u: the share u of the way of the motion to pose i + 1.
class MotionBound {
  public:
    explicit MotionBound(const ToolPath& path);
    std::size_t motions() const { return travel_.size() - 1; }
    /// mm; `reach`: of the body from the tool frame's origin.
    double way(double begin, double end, double reach) const;
    /// The place where half of the way is done.
    double middle(double begin, double end, double reach) const;

  private:
    std::vector<double> travel_, turn_;  ///< sums up to each pose, mm and rad
};

/// Where a place lies on the path.
struct Moment {
    std::size_t motion;  ///< to that pose
    double share;
};

Moment moment_at(double place, std::size_t motions);

}  // namespace beltgrinding

#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/tool_path.h"
#include "collision/collision_check.h"
#include "pair_motion.h"

namespace beltgrinding {

/// The body's frame in the tool's if the robot carries it, else in the base.
Frame holder_from(Carrier carrier, const CellFrames& cell);

/// Whether the robot carries what goes with `carrier`.
bool carried(Carrier carrier, Holding holding);

/// Whether a pair moves against each other so that it is looked at: the first stands still, or the
/// second is a link. Of two links the first has the lower number, and they are no neighbours.
bool meets(const CollisionBody& first, const CollisionBody& second, Holding holding);

/// What all pairs that move along a path share: how far a body carried by the robot can have moved.
class PathTravel {
  public:
    explicit PathTravel(const ToolPath& path);
    const ToolPath& path() const { return path_; }
    std::size_t motions() const { return travel_.size() - 1; }
    /// mm; `reach`: of the body from the tool frame's origin.
    double way(double begin, double end, double reach) const;
    double time(double place) const;
    std::uint32_t pose(double place) const;
    Frame base_from_tcp(double place) const;

  private:
    const ToolPath& path_;
    std::vector<double> travel_, turn_;  ///< sums up to each pose, mm and rad
    std::vector<double> begins_;         ///< s, of the motion to each pose
};

/// One body stands still, the other is carried by the robot, along the path as it goes between its
/// poses.
class PathMotion : public PairMotion {
  public:
    /// `reach`: mm, from the tool frame's origin to the moving body's farthest point. Keeps a
    /// reference to `travel`.
    PathMotion(const PathTravel& travel, Carrier standing, Carrier moving, double reach);

    std::vector<Stretch> stretches() const override;
    double way(double begin, double end) const override;
    Frame first_from_second(double place) const override;
    Frame work_from_first(double place) const override;
    std::uint32_t pose(double place) const override { return travel_.pose(place); }

  private:
    const PathTravel& travel_;
    Frame base_from_first_, tcp_from_second_;
    double reach_;
};

}  // namespace beltgrinding

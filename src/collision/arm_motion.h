#pragma once

#include <array>
#include <vector>

#include "collision/collision_check.h"
#include "pair_motion.h"

namespace beltgrinding {

/// What all pairs with a link of the robot's arm share: how far each joint has turned.
class ArmTravel {
  public:
    /// Keeps references to both.
    ArmTravel(const ToolPath& path, const ArmInCell& arm);
    const ToolPath& path() const { return path_; }
    const ArmInCell& arm() const { return arm_; }
    std::size_t moments() const { return arm_.way.size(); }

    /// rad that the joint (from 0) turns between two places, there and back counted.
    double turn(std::size_t joint, double begin, double end) const;
    /// By joint interpolation; where two moments are not joined, those of the nearer.
    Joints joints(double place) const;
    /// mm along the arm at most from a point of axis `from` (joints from 0; 6: the flange) to one
    /// of axis `to`, whatever the joints are.
    double chain(std::size_t from, std::size_t to) const;

  private:
    const ToolPath& path_;
    const ArmInCell& arm_;
    std::array<std::vector<double>, 6> turned_;  ///< rad, sums up to each moment
};

/// s since the program's begin at a place of the arm's way.
double arm_time(const ArmInCell& arm, double place);

/// A link of the arm against a body that stands still or is carried by the robot; the link is the
/// second.
class ArmMotion : public PairMotion {
  public:
    /// `link`: 0 is the foot. `reach`: mm from the link's axis point (the foot: not used) or, of a
    /// body that is carried, from the flange's origin, to the farthest point of the body that moves
    /// against the other. Keeps a reference to `travel`.
    ArmMotion(const ArmTravel& travel, Carrier other, std::size_t link, double reach);

    std::vector<Stretch> stretches() const override;
    double way(double begin, double end) const override;
    Frame first_from_second(double place) const override;
    Frame work_from_first(double place) const override;
    std::uint32_t pose(double place) const override;

  private:
    Frame base_from_tcp(double place) const;
    Frame base_from_first(double place) const;

    const ArmTravel& travel_;
    bool carried_;
    std::size_t link_;
    Frame holder_from_first_;
    std::array<double, 6> levers_{};  ///< mm; of joints that do not move the pair: 0
};

}  // namespace beltgrinding

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "collision/collision_check.h"
#include "collision/collision_mesh.h"
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

  private:
    const ToolPath& path_;
    const ArmInCell& arm_;
    std::array<std::vector<double>, 6> turned_;  ///< rad, sums up to each moment
};

/// mm by which a radian of each joint moves a body's points at most, whatever the joints are; of
/// joints that do not move it 0. The body goes with link `to`, 7: it is at the flange, and moves
/// against link `from` (0: also what stands still). `reach`: mm, from the link's axis point, or
/// from the flange's origin, to the farthest point of the body that moves.
std::array<double, 6> joint_levers(const RobotArm& arm, std::size_t from, std::size_t to,
                                   double reach);

/// The same of the meshes of two bodies that meet (`meets`).
std::array<double, 6> joint_levers(const ArmInCell& arm, const CellFrames& cell,
                                   const CollisionBody& first, const CollisionMesh& first_mesh,
                                   const CollisionBody& second, const CollisionMesh& second_mesh);

/// s since the program's begin at a place of the arm's way.
double arm_time(const ArmInCell& arm, double place);

/// A link of the arm against a body that stands still or is carried by the robot, or against a link
/// nearer to the foot; the link is the second.
class ArmMotion : public PairMotion {
  public:
    /// `levers`: as `joint_levers` gives them. Keeps a reference to `travel`.
    ArmMotion(const ArmTravel& travel, const CollisionBody& first, std::size_t link,
              const std::array<double, 6>& levers);

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
    std::optional<std::size_t> first_link_;
    std::size_t link_;
    Frame holder_from_first_;
    std::array<double, 6> levers_;  ///< mm; of joints that do not move the pair: 0
};

}  // namespace beltgrinding

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "beltgrinding/run_context.h"
#include "beltgrinding/tool_path.h"
#include "collision/collision_check.h"
#include "collision/collision_mesh.h"

namespace beltgrinding {

/// The bodies of a cell with the robot's arm: what is too near to what at given joint angles. The
/// same pairs as in `check_collisions`; here what the robot carries goes where the joints take it,
/// so that joint motions are followed as they are. Const calls may run on several threads.
class ArmScene {
  public:
    /// Two bodies that are too near, and where on a way: the share in [0, 1].
    struct Meeting {
        std::size_t first = 0, second = 0;  ///< numbers of the bodies
        double share = 0.0;
    };

    /// `cell.way` is not used. Throws InputError (no mesh, a link without number), Cancelled.
    ArmScene(ArmInCell cell, const CellFrames& frames, std::vector<CollisionBody> bodies,
             const RunContext& context = {});

    const RobotArm& arm() const { return cell_.arm; }
    const CellFrames& frames() const { return frames_; }
    const std::vector<CollisionBody>& bodies() const { return bodies_; }

    Frame base_from_tcp(const Joints& q) const;
    /// The flange where the tool frame is at `base_from_tcp`.
    Frame robot_from_flange(const Frame& base_from_tcp) const;

    /// Pairs that are looked at: with a link of the arm, whose place the joint angles decide;
    /// without, which lie alike for all joint angles that hold the tool at the same place.
    enum class Pairs { kAll, kOfArm, kOfTool };

    /// The first pair that is nearer than `distance` mm, margins counted, or crosses.
    std::optional<Meeting> within(const Joints& q, double distance,
                                  Pairs pairs = Pairs::kAll) const;
    /// The first pair of which one lies within the other, without crossing.
    std::optional<Meeting> inside(const Joints& q) const;
    /// The first pair that comes nearer than `clearance` on the straight way of the joints. Between
    /// the places that are looked at a pair can come nearer to each other by no more than joints
    /// times levers: where this cannot be excluded the way is halved, down to `resolution` mm. So
    /// with a clearance above the resolution no collision is missed.
    std::optional<Meeting> on_way(const Joints& from, const Joints& to, double clearance,
                                  double resolution) const;

  private:
    struct Pair {
        std::size_t first, second;
        std::array<double, 6> levers;  // mm
        double margin;                 // mm
    };
    class Placed;
    double clearance_of(const Pair& pair, double asked) const;
    bool near(const Pair& pair, const Placed& placed, double distance) const;
    std::optional<double> pair_on_way(const Pair& pair, const Joints& from, const Joints& step,
                                      double begin, double end, double clearance,
                                      double resolution) const;

    ArmInCell cell_;
    CellFrames frames_;
    Frame robot_from_base_, tcp_from_flange_;
    std::vector<CollisionBody> bodies_;
    std::vector<CollisionMesh> meshes_;
    std::vector<Pair> pairs_;
};

}  // namespace beltgrinding

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "beltgrinding/run_context.h"
#include "beltgrinding/tool_path.h"
#include "collision/collision_check.h"
#include "collision/collision_mesh.h"
#include "robot/external_axes.h"

namespace beltgrinding {

/// The bodies of a cell with the robot's arm: what is too near to what at given joint angles. The
/// same pairs as in `check_collisions`; here what the robot carries goes where the joints take it,
/// so that joint motions are followed as they are. Coordinated external axes move the robot's base,
/// or the part with the frame of the programs; the room then moves against that frame, too. Const
/// calls may run on several threads. Coordinates have as many rows as `axes` says.
class ArmScene {
  public:
    /// Two bodies that are too near, and where on a way: the share in [0, 1].
    struct Meeting {
        std::size_t first = 0, second = 0;  ///< numbers of the bodies
        double share = 0.0;
    };

    /// `cell.way` is not used. Bodies lie as they do with all axes at their positions. Throws
    /// InputError (no mesh, a link without number), Cancelled.
    ArmScene(const ArmInCell& cell, const CellFrames& frames, std::vector<CollisionBody> bodies,
             const RunContext& context = {});
    /// The same with external axes, which say where the robot's base is; that of `cell` is not
    /// used.
    ArmScene(ArmInCell cell, ExternalAxes axes, const CellFrames& frames,
             std::vector<CollisionBody> bodies, const RunContext& context = {});

    const RobotArm& arm() const { return cell_.arm; }
    const ExternalAxes& axes() const { return axes_; }
    Eigen::Index size() const { return 6 + static_cast<Eigen::Index>(axes_.count()); }
    /// Limits of joints and axes, and their greatest speeds, 0: not known.
    const Coordinates& lower() const { return lower_; }
    const Coordinates& upper() const { return upper_; }
    const Coordinates& max_speed() const { return max_speed_; }
    const CellFrames& frames() const { return frames_; }
    const std::vector<CollisionBody>& bodies() const { return bodies_; }
    /// Numbers of bodies at the flange and of link 5 that touch as they are built:
    /// `touching_wrist`.
    const std::vector<std::pair<std::size_t, std::size_t>>& touching() const { return touching_; }

    Frame base_from_tcp(const Coordinates& q) const;
    /// The flange where the tool frame is at `base_from_tcp`; of the coordinates the axes count.
    Frame robot_from_flange(const Frame& base_from_tcp, const Coordinates& at) const;

    /// Pairs that are looked at: with a link of the arm, whose place the joint angles decide;
    /// without, which lie alike for all joint angles that hold the tool at the same place.
    enum class Pairs { kAll, kOfArm, kOfTool };

    /// The first pair that is nearer than `distance` mm, margins counted, or crosses.
    std::optional<Meeting> within(const Coordinates& q, double distance,
                                  Pairs pairs = Pairs::kAll) const;
    /// The first pair of which one lies within the other, without crossing.
    std::optional<Meeting> inside(const Coordinates& q) const;
    /// The first pair that comes nearer than `clearance` on the straight way of the joints. Between
    /// the places that are looked at a pair can come nearer to each other by no more than joints
    /// times levers: where this cannot be excluded the way is halved, down to `resolution` mm. So
    /// with a clearance above the resolution no collision is missed.
    std::optional<Meeting> on_way(const Coordinates& from, const Coordinates& to, double clearance,
                                  double resolution) const;

  private:
    struct Pair {
        std::size_t first, second;
        std::array<double, 6 + kMostExternal> levers;  // mm
        double margin;                                 // mm
    };
    class Placed;
    double clearance_of(const Pair& pair, double asked) const;
    void add_pair(std::size_t first, std::size_t second);
    void add_pairs_of_axes();
    bool near(const Pair& pair, const Placed& placed, double distance) const;
    std::optional<double> pair_on_way(const Pair& pair, const Coordinates& from,
                                      const Coordinates& step, double begin, double end,
                                      double clearance, double resolution) const;

    ArmInCell cell_;
    CellFrames frames_;
    ExternalAxes axes_;
    Coordinates lower_, upper_, max_speed_;
    Frame tcp_from_flange_;
    std::vector<CollisionBody> bodies_;
    std::vector<CollisionMesh> meshes_;
    std::vector<Pair> pairs_;
    std::vector<std::pair<std::size_t, std::size_t>> touching_;
};

}  // namespace beltgrinding

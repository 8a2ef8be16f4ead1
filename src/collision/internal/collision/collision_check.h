#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "beltgrinding/event.h"
#include "beltgrinding/run_context.h"
#include "beltgrinding/tool_path.h"
#include "robot/reach.h"

namespace beltgrinding {

/// What a body of the cell goes with; its mesh is in that frame's coordinates.
enum class Carrier {
    kBase,   ///< it stands still in the cell; the frame of the program's poses
    kTool,   ///< the robot's tool frame: gripper, tool
    kWheel,  ///< the contact frame: housing
    kPart,   ///< the work frame: part, fixture
    kLink    ///< a link of the robot's arm; where it lies in the robot's base at joint angles 0
};

struct CollisionBody {
    std::string name;
    Carrier carrier = Carrier::kBase;
    TriangleMesh mesh;     ///< mm
    double margin = 0.0;   ///< mm by which the body is thicker than its mesh (stock on a part)
    std::size_t link = 0;  ///< kLink: 0 the foot, k what joint k carries, up to 6
};

/// The robot's arm and what it does along the path.
struct ArmInCell {
    RobotArm arm;
    Frame base_from_robot = Frame::Identity();
    Frame flange_from_tcp = Frame::Identity();
    std::vector<ArmMoment> way =
        {};  ///< as check_reach tells it; stretches out of reach are left out
    /// Where what is at the flange and touches link 5 does so as it is built; joint 6 counts.
    Joints home = Joints::Zero();
};

struct CollisionOptions {
    double clearance = 2.0;    ///< mm; nearer is an event
    double resolution = 0.05;  ///< mm; bodies that touch by a shorter way may be missed
};

/// mm that two links of the arm keep from each other at most, whatever the clearance, and link 5
/// from what is at the flange: bodies of arms are rough.
constexpr double kLinksApart = 1.0;

/// How near two bodies come that move against each other; or the arm's foot and what stands still.
struct PairClearance {
    /// Numbers of the bodies; the first stands still, or the second is a link of the arm.
    std::size_t first = 0, second = 0;
    double distance = 0.0;         ///< mm; 0: they touch
    std::uint32_t pose = 0;        ///< that the motion leads to, from 0
    double time = 0.0;             ///< s since the program's begin
    Vec3 on_first = Vec3::Zero();  ///< nearest point, work frame, mm
    Vec3 on_second = Vec3::Zero();
};

/// Where on the way something was found: places of a `PairMotion`, which no feed changes as long as
/// the way itself is the same.
struct CollisionPlaces {
    bool of_arm = false;     ///< on the arm's way, not on the path
    double begin = 0.0;      ///< where the event began
    double last = 0.0;       ///< where it ended
    double worst = 0.0;      ///< where the bodies are nearest
    std::size_t number = 0;  ///< in the order in which the pairs are reported
};

struct CollisionResult {
    std::vector<Event> events;                  ///< collision, near_miss; in order of time
    std::vector<PairClearance> pairs;           ///< every pair that moves against each other
    std::vector<CollisionPlaces> event_places;  ///< of `events`, in their order
    std::vector<CollisionPlaces> pair_places;   ///< of `pairs`, in their order
    std::vector<std::pair<std::size_t, std::size_t>> touching;  ///< `touching_wrist`
};

/// Follows the bodies along the path, rapid motions too, as the path goes between its poses (a
/// straight line in the program's frame, as the controller's own joint interpolation is not known).
///
/// Continuous: between two moments the distance can change by no more than a bound of the motion,
/// the way of the tool's origin plus its turn times the body's reach (conservative advancement,
/// Mirtich 1996; Zhang, Lee, Kim: Interactive continuous collision detection for non-convex
/// polyhedra, 2006). A stretch is halved until that bound proves it clear or it is shorter than the
/// resolution, so no motion is too fast. The least distance of a pair is within the resolution if
/// it is below the clearance; beyond, a quarter of it is proved, and mostly it is exact.
///
/// Links go as `arm` says, by joint interpolation between its moments; each is followed against
/// what stands still, what the robot carries and the other links. Not looked at: the foot against
/// bodies of the base, on which it stands; link 6 against what is at the flange, with which it
/// goes, and `touching_wrist`; neighbouring links; `touching_links`.
///
/// Results do not depend on the number of threads. Throws InputError (no mesh, bad options, links
/// without an arm) and Cancelled.
CollisionResult check_collisions(const ToolPath& path, const std::vector<CollisionBody>& bodies,
                                 const CollisionOptions& options, const RunContext& context = {},
                                 const ArmInCell* arm = nullptr);

/// The result of a check for a path with the same way but other feeds: times, and with them the
/// order of the events, as `check_collisions` would find them there. `arm`: as it goes along that
/// path, with the same number of moments.
void tell_times(CollisionResult& result, const ToolPath& path, const ArmInCell* arm = nullptr);

}  // namespace beltgrinding

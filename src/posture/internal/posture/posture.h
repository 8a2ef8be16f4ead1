#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "beltgrinding/run_context.h"
#include "collision/arm_scene.h"
#include "robot/robot_arm.h"

namespace beltgrinding {

/// What is free at a pose of a pass: contact' = contact * shift * lean * roll in the contact frame.
/// roll, rad, turns the wheel about its axis (along the contact frame's y, the radius behind the
/// contact); lean, rad, about the frame's x; shift, mm, goes along its y. Behind these come the
/// scene's coordinated external axes, rad or m from their positions.
constexpr std::size_t kOfContact = 3, kFreedoms = kOfContact + kMostExternal;
using Free = std::array<double, kFreedoms>;

/// How far one of these may go to both sides, and how far apart the ladder's first samples are.
struct FreeRange {
    double most = 0.0;
    double spacing = 1.0;
    std::optional<double> least = std::nullopt;  ///< else -most

    double low() const { return least.value_or(-most); }
    bool any() const { return most > 0.0 || low() < 0.0; }
};

/// A pose of a pass, as it is programmed.
struct PassPose {
    Frame base_from_tcp = Frame::Identity();
    double duration = 0.0;  ///< s from the pose before, as its feed has it; the first: not used
    bool begins = false;    ///< the first of a pass: a link leads to it
};

struct PostureOptions {
    std::array<FreeRange, kFreedoms> free;  ///< roll, lean, shift, external axes
    double wheel_radius = 100.0;            ///< mm
    double chord = 0.02;                 ///< mm that the way between two poses may leave the pass
    double flip = 0.8;                   ///< rad that a joint may turn from pose to pose
    double singularity = 0.1;            ///< rad, nearer to a singularity costs
    double clearance = 2.0;              ///< mm, nearer costs
    Coordinates home = Joints::Zero();   ///< where the program begins and ends
    Coordinates speed = Joints::Ones();  ///< rad/s, m/s, greatest; scales all costs
    Coordinates acceleration = Joints::Zero();  ///< rad/s2, m/s2, greatest; 0: not limited
    Coordinates jerk = Joints::Zero();          ///< rad/s3, m/s3, the same
    double cut = 10.0;                          ///< s, what the cut of a pass costs besides its way
};

/// Where the robot is at a pose.
struct PosturePose {
    std::size_t pose = 0;  ///< its number among those that were given
    /// A link leads to it: the first of a pass, or where a pass is cut, which is then twice here.
    bool link = false;
    bool cut = false;     ///< the pass is cut here
    bool torn = false;    ///< the pass has no way here from the pose before, which is not repeated
    bool reached = true;  ///< else the arm is out of reach there, or beyond a joint's limit
    bool within_limits = true;  ///< not reached: joint angles would do it beyond the limits only
    /// A body meets another there; its numbers.
    bool meets = false;
    std::size_t first = 0, second = 0;
    Free free{};
    Frame base_from_tcp = Frame::Identity();
    Coordinates q = Joints::Zero();
    double duration = 0.0;  ///< s from the pose before that speeds, accelerations and jerks leave
};

/// What a run of poses costs, s.
struct PostureCost {
    double travel = 0.0;        ///< turns of the joints over their speeds
    double acceleration = 0.0;  ///< changes of their speeds, squared
    double places = 0.0;        ///< nearness to limits, singularities, bodies
    double slow = 0.0;          ///< what the joints' speeds take longer than the feed
    double cuts = 0.0;
    double sum() const { return travel + acceleration + places + slow + cuts; }
};

struct PostureResult {
    std::vector<PosturePose> poses;
    PostureCost cost;
};

/// Chooses joint angles along passes: all solutions of inverse kinematics over samples of what is
/// free at every pose, external axes among it, are the rungs of a ladder graph (descartes: De Maria
/// et al.; ROS-Industrial's descartes_light), the cheapest way through it by dynamic programming,
/// over all passes at once, from home to home. Samples are refined round that way three times, then
/// moved on their own. Bodies are looked at only where the way goes, and it is searched again until
/// nothing new is met. A pass keeps one configuration of the arm, or is cut where that is cheapest.
///
/// Throws InputError for options out of their ranges, Cancelled.
PostureResult find_postures(const ArmScene& scene, const std::vector<PassPose>& poses,
                            const PostureOptions& options, const RunContext& context = {});

/// The cost of joint angles along passes, as `find_postures` counts it, without bodies.
PostureCost posture_cost(const ArmScene& scene, const std::vector<PosturePose>& way,
                         const std::vector<PassPose>& poses, const PostureOptions& options);

/// base_from_tcp of a pose with what is free moved, external axes left out.
Frame moved(const ArmScene& scene, const Frame& base_from_tcp, const Free& free,
            double wheel_radius);

}  // namespace beltgrinding

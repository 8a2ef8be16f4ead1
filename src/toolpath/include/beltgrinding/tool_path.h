#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

class MotionPlan;

/// One programmed pose of the robot.
struct PathPose {
    Frame base_from_tcp = Frame::Identity();  ///< in the frame that the program names
    double feed = 100.0;  ///< mm/s at which the pose is approached from the one before
    double force = -1.0;  ///< N, commanded at and towards this pose; negative: the job's force
    bool rapid = false;   ///< a positioning move (PTP): nothing is ground on the way to this pose
    int line = 0;         ///< line of the source file, from 1; 0: unknown
    /// mm before and after the pose within which the robot rounds the corner; 0: it stands still
    /// there; -1: unknown (the time law's default zone); less: by ZoneCode (motion_plan.h)
    double zone = -1.0;
    /// rad; the robot's joints there, where the program gives them (a joint target)
    std::optional<Eigen::Matrix<double, 6, 1>> joints = {};
};

/// Linear in position, slerp in orientation, in the program's frame; t in [0, 1].
Frame interpolate(const Frame& a, const Frame& b, double t);

/// rad, within [0, pi]
double angle_between(const Frame& a, const Frame& b);

/// The contact frame at `point` (mm): z runs `into` the work, x follows `along`, the belt's travel,
/// as far as it lies across z, and y is the wheel's axle. Neither need be a unit vector. Throws
/// InputError if a number is not finite, `into` has no length, or `along` is parallel to it.
Frame contact_frame(const Vec3& point, const Vec3& into, const Vec3& along);

/// How the robot's speed goes along the path.
struct TimeLaw {
    /// How time passes along the path.
    enum class Timing {
        kConstantFeed,  ///< the programmed feed everywhere, sharp corners, zones without meaning
        kTrapezoidal    ///< speeds up and slows down at the accelerations, rounds corners in zones
    };
    /// By its name: constant_feed or trapezoidal. Throws InputError for another.
    static Timing timing_named(const std::string& name);

    Timing timing = Timing::kConstantFeed;  ///< how time passes along the path
    double acceleration = 1200.0;           ///< mm/s2, along the path and across it in a zone
    double angular_acceleration = 2.0;      ///< rad/s2
    double rotation_speed = 3.5;            ///< rad/s, largest speed of reorientation
    double default_zone = 1.0;              ///< mm, of poses whose zone is unknown

    /// Throws InputError naming what is not positive (the zone: negative).
    void validate() const;
};

/// Who holds what.
enum class Holding { kToolInHand, kPartInHand };

/// By its name: tool_in_hand or part_in_hand. Throws InputError for another.
Holding holding_named(const std::string& name);

/// The cell's frames. Tool in hand: work_from_contact = base_from_work^-1 base_from_tcp
/// tcp_from_contact. Part in hand: work_from_contact = (base_from_tcp tcp_from_work)^-1
/// base_from_contact.
struct CellFrames {
    Holding holding = Holding::kToolInHand;       ///< who holds what
    Frame base_from_work = Frame::Identity();     ///< tool in hand
    Frame tcp_from_contact = Frame::Identity();   ///< tool in hand
    Frame tcp_from_work = Frame::Identity();      ///< part in hand
    Frame base_from_contact = Frame::Identity();  ///< part in hand

    /// Where the contact frame lies in the work when the tool is there.
    Frame work_from_contact(const Frame& base_from_tcp) const;
};

/// A step of the simulation: the contact wheel stands at `work_from_contact` for `duration`.
struct PathStep {
    Frame work_from_contact = Frame::Identity();  ///< of the wheel, undeformed
    double time = 0.0;       ///< s since the start of the program, at the step's middle
    double duration = 0.0;   ///< s
    double feed = 0.0;       ///< mm/s, infeed speed of the contact point over the work
    double force = 0.0;      ///< N
    std::uint32_t pose = 0;  ///< index of the programmed pose that the step leads to
    bool plunging = false;   ///< the contact point moves more along its z than across: it comes to
                             ///< the surface, or leaves it
    double begin = 0.0;      ///< share of the motion's way at which the step begins, [0, 1]
    double end = 1.0;        ///< share of the motion's way at which it ends
    Vec3 moved = Vec3::Zero();   ///< mm, from the step's begin to its end, in the contact's frame
    Vec3 turned = Vec3::Zero();  ///< rad, the same
};

/// How finely a path is stepped through.
struct SteppingOptions {
    double max_travel = 1.0;    ///< mm, how far the contact point may move in a step
    double max_angle = 0.02;    ///< rad, how far the wheel may turn against the work in a step
    double default_force = 50;  ///< N, where a pose has none
};

/// A robot path: programmed poses, linear in position and spherical-linear (slerp) in orientation
/// between them, in the frame that the program names; run through by a time law, which may round
/// the corners.
class ToolPath {
  public:
    /// Throws InputError naming pose (from 1) and source line: no pose, NaN, a rotation that is not
    /// one, feed not positive; or a time law's limit that is not positive.
    ToolPath(std::vector<PathPose> poses, CellFrames frames, const TimeLaw& law = {});

    /// The programmed poses.
    const std::vector<PathPose>& poses() const { return poses_; }
    /// The cell's frames.
    const CellFrames& frames() const { return frames_; }
    /// How the speed goes along the path.
    const TimeLaw& time_law() const { return law_; }
    /// s that the program takes. At constant feed a pure rotation, which takes no time at a linear
    /// feed, is run at `kRotationFeed` rad/s.
    double duration() const;
    /// s that the motion to pose `i` takes; 0 for the first.
    double duration(std::size_t i) const;
    /// s since that motion began, t in [0, 1] of its way.
    double elapsed(std::size_t i, double t) const;
    /// Where the tool is then, in the frame that the program names; the first pose for i = 0. With
    /// a zone at the pose the motion ends half way round the corner.
    Frame base_from_tcp(std::size_t i, double t) const;
    /// The tool at a time.
    struct Moment {
        Frame base_from_tcp = Frame::Identity();  ///< in the frame that the program names
        std::size_t pose = 0;                     ///< that the motion leads to
    };
    /// Where the tool is `time` s after the program's begin, and on the way to which pose; before
    /// and after the program, at its ends.
    Moment at(double time) const;
    /// Steps at the middles of equal parts of each motion's way, in program order; rapid motions
    /// give none. Their durations are the time that the robot takes from part to part, and with
    /// the rapid motions' add up to `duration()`.
    std::vector<PathStep> steps(const SteppingOptions& options) const;
    /// A step of `steps`, or of `cut`, as `parts` steps of equal ways.
    std::vector<PathStep> cut(const PathStep& step, int parts) const;

  private:
    /// Appends the steps of the motion to pose `i` between two shares of its way.
    void append_steps(std::size_t i, double begin, double end, int parts, double force,
                      std::vector<PathStep>& steps) const;
    bool trapezoidal() const { return law_.timing == TimeLaw::Timing::kTrapezoidal; }

    std::vector<PathPose> poses_;
    CellFrames frames_;
    TimeLaw law_;
    std::shared_ptr<const MotionPlan> plan_;  // of the trapezoidal law; else null
    std::vector<double> ends_;  // s since the program's begin, of the motion to each pose
};

}  // namespace beltgrinding

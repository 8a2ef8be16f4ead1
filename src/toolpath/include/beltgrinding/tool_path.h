#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/motion_plan.h"
#include "beltgrinding/path_pose.h"

namespace beltgrinding {

/// Who holds what.
enum class Holding { kToolInHand, kPartInHand };

/// The cell's frames. Tool in hand: work_from_contact = base_from_work^-1 base_from_tcp
/// tcp_from_contact. Part in hand: work_from_contact = (base_from_tcp tcp_from_work)^-1
/// base_from_contact.
struct CellFrames {
    Holding holding = Holding::kToolInHand;
    Frame base_from_work = Frame::Identity();     ///< tool in hand
    Frame tcp_from_contact = Frame::Identity();   ///< tool in hand
    Frame tcp_from_work = Frame::Identity();      ///< part in hand
    Frame base_from_contact = Frame::Identity();  ///< part in hand

    Frame work_from_contact(const Frame& base_from_tcp) const;
};

/// A step of the simulation: the contact wheel stands at `work_from_contact` for `duration`.
struct PathStep {
    Frame work_from_contact = Frame::Identity();
    double time = 0.0;       ///< s since the start of the program, at the step's middle
    double duration = 0.0;   ///< s
    double feed = 0.0;       ///< mm/s, infeed speed of the contact point over the work
    double force = 0.0;      ///< N
    std::uint32_t pose = 0;  ///< index of the programmed pose that the step leads to
    bool plunging = false;   ///< the contact point moves more along its z than across: it comes to
                             ///< the surface, or leaves it
};

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

    const std::vector<PathPose>& poses() const { return poses_; }
    const CellFrames& frames() const { return frames_; }
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
    struct Moment {
        Frame base_from_tcp = Frame::Identity();
        std::size_t pose = 0;  ///< that the motion leads to
    };
    /// Where the tool is `time` s after the program's begin, and on the way to which pose; before
    /// and after the program, at its ends.
    Moment at(double time) const;
    /// Steps at the middles of equal parts of each motion's way, in program order; rapid motions
    /// give none. Their durations are the time that the robot takes from part to part, and with
    /// the rapid motions' add up to `duration()`.
    std::vector<PathStep> steps(const SteppingOptions& options) const;

  private:
    bool trapezoidal() const { return law_.timing == TimeLaw::Timing::kTrapezoidal; }

    std::vector<PathPose> poses_;
    CellFrames frames_;
    TimeLaw law_;
    MotionPlan plan_;           // of the trapezoidal law
    std::vector<double> ends_;  // s since the program's begin, of the motion to each pose
};

}  // namespace beltgrinding

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"

namespace beltgrinding {

/// One programmed pose of the robot.
struct PathPose {
    Frame base_from_tcp = Frame::Identity();  ///< in the frame that the program names
    double feed = 100.0;  ///< mm/s at which the pose is approached from the one before
    double force = -1.0;  ///< N, commanded at and towards this pose; negative: the job's force
    bool rapid = false;   ///< a positioning move (PTP): nothing is ground on the way to this pose
    int line = 0;         ///< line of the source file, from 1; 0: unknown
    /// rad; the robot's joints there, where the program gives them (a joint target)
    std::optional<Eigen::Matrix<double, 6, 1>> joints;
};

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

/// On the way from `a` to `b`, t in [0, 1]: linear in position, slerp in orientation.
Frame interpolate(const Frame& a, const Frame& b, double t);
/// rad, how far `b` is turned against `a`.
double angle_between(const Frame& a, const Frame& b);

/// A robot path: programmed poses, linear in position and spherical-linear (slerp) in orientation
/// between them, in the frame that the program names.
class ToolPath {
  public:
    /// Throws InputError naming pose (from 1) and source line: no pose, NaN, a rotation that is not
    /// one, feed not positive.
    ToolPath(std::vector<PathPose> poses, CellFrames frames);

    const std::vector<PathPose>& poses() const { return poses_; }
    const CellFrames& frames() const { return frames_; }
    /// s that the program takes at the programmed feeds (a pure rotation takes no time at a linear
    /// feed: `kRotationFeed` rad/s is used).
    double duration() const;
    /// s that the motion to pose `i` takes; 0 for the first.
    double duration(std::size_t i) const;
    /// s since that motion began, t in [0, 1] of its way.
    double elapsed(std::size_t i, double t) const;
    /// Where the tool is then, in the frame that the program names; the first pose for i = 0.
    Frame base_from_tcp(std::size_t i, double t) const;
    /// Steps at the middles of equal parts of each motion, in program order; rapid motions give
    /// none.
    std::vector<PathStep> steps(const SteppingOptions& options) const;

  private:
    std::vector<PathPose> poses_;
    CellFrames frames_;
};

}  // namespace beltgrinding

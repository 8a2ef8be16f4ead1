#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/tool_path.h"
#include "speed_profile.h"

namespace beltgrinding {

/// What a pose's zone says below -1, which is unknown.
struct ZoneCode {
    /// The robot passes through on a smooth curve, as at a spline's points.
    static constexpr double kOnCurve = -3.0;
    /// From -2 to -1: the share of the feed that the robot keeps through the corner, which it
    /// rounds as far as that takes (Fanuc's CNT).
    static double share(double zone) { return -1.0 - zone; }
};

/// The robot's motion under a trapezoidal time law: where it is and when.
///
/// In the zone of a pose (at most half of the way to its neighbours) the corner is a parabola:
/// the quadratic Bezier curve over the zone's begin, the pose and the zone's end, with the
/// orientation by the same construction on the sphere (Shoemake, SIGGRAPH 1985), so that
/// velocity is continuous. It is run through evenly, as a linear segment with parabolic blend
/// (Biagiotti, Melchiorri 2008): s counts along the programmed polygon, and with the directions u
/// and v before and after the corner and the zone d the acceleration is s'^2 |v - u| / (2 d). Where
/// it would exceed the limit, s' is lower; at the parabola's vertex that is speed^2 / radius <=
/// acceleration. Along the path s' keeps to the feed, to the rotation speed and to both
/// accelerations (see SpeedProfile); the limits along and across the path are held separately.
///
/// A corner that keeps a share of the feed has the zone that its speed takes by the same formula.
///
/// Through a pose on a curve the robot passes without a corner: each motion beside it is a cubic of
/// Hermite, for place and rotation vector (Farin, Curves and Surfaces for CAGD, 5th edition, 2002,
/// section 7.5). The tangent at the pose is the mean of both directions, each weighted by its own
/// motion's length: no motion swings further out than the shorter one beside it lets it. The limits
/// hold in each of up to kCurveParts parts of a motion. A motion has no rounded corner at its other
/// end: the robot stops there, as controllers do at a spline's ends.
///
/// At zone 0, and between a motion and a pure rotation, the robot stands still. A pose of unknown
/// zone beside a rapid motion has zone 0.
class MotionPlan {
  public:
    MotionPlan() = default;
    MotionPlan(const std::vector<PathPose>& poses, const TimeLaw& law);

    /// s that the whole path takes.
    double duration() const { return duration_; }
    /// s that the motion to the pose number `pose` (from 1) takes, from half the corner at the
    /// pose before to half the corner at the pose.
    double duration(std::size_t pose) const { return motions_[pose].duration; }
    /// s from the motion's begin to the share t in [0, 1] of its way.
    double elapsed(std::size_t pose, double t) const;
    /// mm/s at which s grows there (rad/s in a pure rotation). The robot's speed is the same, less
    /// in a corner.
    double speed(std::size_t pose, double t) const;
    /// base_from_tcp there.
    Frame frame(const std::vector<PathPose>& poses, std::size_t pose, double t) const;

    /// How a curved motion departs from the straight one: tangents less the straight one's, at its
    /// begin and its end, of place (mm) and rotation vector (rad) per mm.
    struct Bow {
        Vec3 begin = Vec3::Zero(), end = Vec3::Zero();
        Vec3 turn_begin = Vec3::Zero(), turn_end = Vec3::Zero();
    };

    /// The motion to a pose; its way is `length`, of which `before` and `after` lie in corners.
    struct Motion {
        double length = 0.0;       ///< mm; rad in a pure rotation; 0: there is no motion
        double before = 0.0;       ///< within the corner at its begin
        double after = 0.0;        ///< within the corner at its end
        double duration = 0.0;     ///< s
        std::size_t stretch = 0;   ///< first one in the profile
        std::size_t previous = 0;  ///< the motion before, 0: none
        std::size_t next = 0;      ///< the motion after, 0: none
        std::size_t parts = 1;     ///< stretches of it
        bool turning = false;      ///< a pure rotation
        bool curved = false;       ///< on a curve at one end at least
        Bow bow{};                 ///< of a curved one
    };

  private:
    struct Place {
        std::size_t stretch;
        double length;
    };
    Place place(const Motion& motion, double t) const;
    static Frame corner(const std::vector<PathPose>& poses, std::size_t from, const Motion& before,
                        std::size_t to, const Motion& after, double u);

    std::vector<Motion> motions_;  // by pose; the first is none
    SpeedProfile profile_{{}};
    double duration_ = 0.0;
};

}  // namespace beltgrinding

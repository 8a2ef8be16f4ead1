#pragma once

#include <cstddef>
#include <vector>

namespace beltgrinding {

/// A stretch of a path with one limit of speed and one of acceleration.
struct SpeedLimit {
    double length = 0.0;        ///< mm (or rad)
    double speed = 0.0;         ///< mm/s, > 0
    double acceleration = 0.0;  ///< mm/s2, > 0, of speeding up as of slowing down
    bool stop = false;          ///< the path stands still at the stretch's end
};

/// The fastest speed along a path that keeps to its limits and is trapezoidal in each stretch: from
/// rest to rest, by a pass forward (what can be reached by speeding up) and one backward (what can
/// still be slowed down from), as trapezoidal velocity planning with look-ahead does (Biagiotti,
/// Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008, section 3.2; the two
/// passes as Kunz, Stilman, Robotics: Science and Systems 2012). Time and memory are linear in the
/// number of stretches.
class SpeedProfile {
  public:
    explicit SpeedProfile(const std::vector<SpeedLimit>& limits);

    std::size_t size() const { return stretches_.size(); }
    /// s that the stretch takes.
    double duration(std::size_t stretch) const { return stretches_[stretch].duration; }
    /// s from the stretch's begin to `length` from there, within [0, the stretch's length].
    double elapsed(std::size_t stretch, double length) const;
    /// mm/s there.
    double speed(std::size_t stretch, double length) const;

  private:
    struct Stretch {
        double length, acceleration;
        double begin, peak, end;  // mm/s
        double rise, fall;        // mm, of speeding up and of slowing down
        double duration;          // s
    };
    std::vector<Stretch> stretches_;
};

}  // namespace beltgrinding

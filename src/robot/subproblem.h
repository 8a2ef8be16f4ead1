#pragma once

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// The canonical subproblems of inverse kinematics: angles of rotations about given unit axes.
/// After R. M. Murray, Z. Li, S. S. Sastry, A Mathematical Introduction to Robotic Manipulation
/// (1994), section 3.2, and A. J. Elias, J. T. Wen, IK-Geo (2022), arXiv 2211.05737.

/// Up to two angles, rad.
struct Angles {
    int count = 0;  ///< 0: there is no solution
    double angle[2] = {0.0, 0.0};
    bool free = false;  ///< any angle solves it; angle[0] is 0
};

/// `v` turned by `angle` about the unit axis `k`.
Vec3 rotated(const Vec3& k, double angle, const Vec3& v);

/// The angle about `k` that turns `p` to `q` (or as near as it can).
Angles turn_to(const Vec3& k, const Vec3& p, const Vec3& q);

/// The angles about `k` after which `p` has the component `d` along the unit vector `h`. The first
/// is the greater by less than half a turn, so that each index is one branch as `d` changes.
Angles turn_to_plane(const Vec3& k, const Vec3& p, const Vec3& h, double d);

/// The angles about `k` after which `p` has the distance `d` from `q`.
Angles turn_to_distance(const Vec3& k, const Vec3& p, const Vec3& q, double d);

}  // namespace beltgrinding

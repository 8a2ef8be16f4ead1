#include "subproblem.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

// Of the lengths of the vectors: below it, a vector lies along the axis.
constexpr double kParallel = 1e-9;
// Beyond the end of a range by rounding: what is accepted is checked against the whole pose later.
constexpr double kBeyond = 1e-7;

/// A cos + B sin = C.
Angles solve(double a, double b, double c, double scale) {
    Angles found;
    const double radius = std::hypot(a, b);
    if (radius <= kParallel * scale) {
        found.free = std::abs(c) <= kBeyond * scale;
        found.count = found.free ? 1 : 0;
        return found;
    }
    const double cosine = c / radius;
    if (std::abs(cosine) > 1.0 + kBeyond) return found;
    const double middle = std::atan2(b, a);
    const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
    found.count = 2;
    found.angle[0] = middle + half;
    found.angle[1] = middle - half;
    return found;
}

}  // namespace

Vec3 rotated(const Vec3& k, double angle, const Vec3& v) {
    const Vec3 along = k * k.dot(v);
    return along + std::cos(angle) * (v - along) + std::sin(angle) * k.cross(v);
}

Angles turn_to(const Vec3& k, const Vec3& p, const Vec3& q) {
    const Vec3 u = p - k * k.dot(p);
    const Vec3 v = q - k * k.dot(q);
    Angles found;
    found.count = 1;
    const double scale = std::max(p.norm(), q.norm());
    found.free = u.norm() <= kParallel * scale || v.norm() <= kParallel * scale;
    if (!found.free) found.angle[0] = std::atan2(k.dot(u.cross(v)), u.dot(v));
    return found;
}

Angles turn_to_plane(const Vec3& k, const Vec3& p, const Vec3& h, double d) {
    const Vec3 along = k * k.dot(p);
    return solve(h.dot(p - along), h.dot(k.cross(p)), d - h.dot(along),
                 std::max(p.norm(), std::abs(d)));
}

Angles turn_to_distance(const Vec3& k, const Vec3& p, const Vec3& q, double d) {
    const double length = q.norm();
    if (length == 0.0) {
        Angles found;
        found.free = std::abs(p.norm() - d) <= kBeyond * std::max(p.norm(), d);
        found.count = found.free ? 1 : 0;
        return found;
    }
    return turn_to_plane(k, p, q / length,
                         (p.squaredNorm() + q.squaredNorm() - d * d) / (2.0 * length));
}

}  // namespace beltgrinding

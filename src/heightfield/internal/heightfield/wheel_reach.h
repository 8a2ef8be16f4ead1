#pragma once

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// What the wheel can reach at a pose: a solid of revolution about an axis, in work coordinates.
/// All points within `radius` of the axis and within `half_width` of `centre` along it; optionally
/// only those on the side `(x - centre) . direction >= min_along`.
struct WheelReach {
    Vec3 centre = Vec3::Zero();      ///< wheel's centre, mm, work frame
    Vec3 axis = Vec3::UnitY();       ///< unit
    Vec3 direction = Vec3::UnitZ();  ///< unit, perpendicular to axis: from centre to the contact
    double radius = 0.0;             ///< mm
    double half_width = 0.0;         ///< mm
    double min_along = 0.0;          ///< mm; e.g. 0 keeps the half that faces the work

    /// Has what this one has and whatever lies up to `margin` mm beside that.
    WheelReach widened(double margin) const {
        WheelReach wider = *this;
        wider.radius += margin;
        wider.half_width += margin;
        wider.min_along -= margin;
        return wider;
    }
    /// Upper bound of the way in mm that a point fixed in this reach would move to be at the same
    /// place in the other, whatever the sizes of the two.
    double way_to(const WheelReach& other) const {
        const double turn = (other.direction - direction).norm(), tilt = (other.axis - axis).norm();
        return (other.centre - centre).norm() + other.half_width * tilt +
               other.radius * (2.0 * turn + tilt);
    }
    /// All of the other one lies within this one.
    bool holds(const WheelReach& other) const {
        const double way = way_to(other);
        return other.radius + way <= radius && other.half_width + way <= half_width &&
               other.min_along - way >= min_along;
    }
};

}  // namespace beltgrinding

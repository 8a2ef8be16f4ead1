#pragma once

#include <Eigen/Core>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// A contact wheel with its belt: outer surface of revolution about the y axis of the contact frame
/// (origin on the belt's outer surface at the nominal contact, z into the workpiece, x along the
/// belt's travel, y along the axis; the wheel's centre is at z = -radius). Lengths in mm.
struct ContactWheel {
    double radius = 100.0;      ///< outer radius at mid-width, belt included, mm
    double width = 50.0;        ///< mm
    double crown_radius = 0.0;  ///< radius of the rim's profile in the y-z plane, mm; 0: cylinder

    /// Points (y, drop), mm, y ascending across the whole width, straight lines between them: a rim
    /// turned to a profile. Added to the crown; empty: none.
    std::vector<Eigen::Vector2d> profile = {};

    /// How much smaller than `radius` the wheel is at axial position y (|y| <= width/2), mm.
    double drop(double y) const;
    /// d drop / d y.
    double drop_slope(double y) const;
    /// Throws InputError if a dimension is not positive and finite, or the crown is impossible.
    void validate() const;
};

}  // namespace beltgrinding

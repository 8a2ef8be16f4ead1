#pragma once

#include <Eigen/Core>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// How the wheel goes over the surface in a step: a cell at the step's middle lies under others
/// before and after.
struct Sweep {
    Vec3 moved = Vec3::Zero();   ///< mm, the contact point, in the contact's frame
    Vec3 turned = Vec3::Zero();  ///< rad, the same

    /// mm along s and y by which the wheel passes the place (s, y) of a wheel of `radius`.
    Eigen::Vector2d way(double s, double y, double radius) const;
    /// The mean over the step of `values` (one per cell), which are carried with the wheel, at
    /// what lies under each cell at its middle. Near edges of the surface, from which pressure does
    /// not move on with the wheel, what holds at the middle. `coverage`: as `Coverage::share`.
    Eigen::ArrayXd mean(const ContactGrid& grid, double radius, const Eigen::ArrayXd& coverage,
                        const Eigen::ArrayXd& values) const;
};

}  // namespace beltgrinding

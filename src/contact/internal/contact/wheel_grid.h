#pragma once

#include <Eigen/Core>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/contact_wheel.h"

namespace beltgrinding {

/// `ContactProblem::drop` of a wheel.
Eigen::ArrayXd profile_drop(const ContactWheel& wheel, const ContactGrid& grid);

/// By how much a gap (mm, by cell) grows with an approach along the contact frame's z beyond
/// growing less by just that, mm per mm, to first order: a surface point under a wheel of radius R
/// at the arc length s comes nearer by cos(s / R) and moves along by sin(s / R). 0 where there is
/// no gap.
Eigen::ArrayXd tilt_by_approach(const ContactWheel& wheel, const ContactGrid& grid,
                                const Eigen::ArrayXd& gap);

/// Carries a pressure field from one grid to another of the same cells and another length (both are
/// centred); cells without a counterpart get 0.
Eigen::ArrayXd recentre(const Eigen::ArrayXd& values, const ContactGrid& from,
                        const ContactGrid& to);

}  // namespace beltgrinding

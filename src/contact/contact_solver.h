#pragma once

#include <Eigen/Core>

#include "contact/compliance.h"

namespace beltgrinding {

/// The unilateral (Signorini) contact of the wheel with a rigid surface on the wheel's grid:
/// find p >= 0 with g + C p - delta >= 0 and p (g + C p - delta) = 0.
struct ContactProblem {
    ContactGrid grid;
    Eigen::ArrayXd gap;       ///< mm, undeformed wheel to surface, per cell; +inf: nothing there
    Eigen::ArrayXd coverage;  ///< share of the cell that the workpiece covers, [0, 1]
    bool force_control = true;
    double force = 0.0;     ///< N, commanded (force control)
    double approach = 0.0;  ///< mm, commanded (position control)
    /// mm/N by which the robot gives way under the contact's force (position control); 0: rigid
    double robot_compliance = 0.0;
    double tolerance = 1e-4;  ///< relative error of the pressure field, L1
    int max_iterations = 500;
};

struct ContactSolution {
    Eigen::ArrayXd pressure;     ///< MPa per cell
    double force = 0.0;          ///< N, sum of pressure x coverage x cell area
    double approach = 0.0;       ///< mm, delta; what the robot gave way is not in it
    double area = 0.0;           ///< mm2 of cells with pressure, coverage counted
    double peak_pressure = 0.0;  ///< MPa
    int iterations = 0;
    bool converged = false;
};

/// Solves by constrained conjugate gradients: Polonsky and Keer, A numerical method for solving
/// rough contact problems based on the multi-level multi-summation and conjugate gradient
/// techniques, Wear 231 (1999). `start`, if not null and of the right size, is the pressure to
/// start from. Throws InputError on arrays of the wrong size, NaN, or a negative force.
ContactSolution solve_contact(const ContactProblem& problem, const ComplianceOperator& compliance,
                              const Eigen::ArrayXd* start = nullptr);

}  // namespace beltgrinding

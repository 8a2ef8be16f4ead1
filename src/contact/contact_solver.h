#pragma once

#include "beltgrinding/compliance.h"

namespace beltgrinding {

/// Solves by constrained conjugate gradients: Polonsky and Keer, A numerical method for solving
/// rough contact problems based on the multi-level multi-summation and conjugate gradient
/// techniques, Wear 231 (1999). `start`, if not null and of the right size, is the pressure to
/// start from. Throws InputError on arrays of the wrong size, NaN, or a negative force.
ContactSolution solve_contact(const ContactProblem& problem, const ComplianceOperator& compliance,
                              const Eigen::ArrayXd* start = nullptr);

}  // namespace beltgrinding

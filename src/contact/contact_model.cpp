#include "beltgrinding/contact_model.h"

#include <cmath>

#include "beltgrinding/error.h"

namespace beltgrinding {

void ContactProblem::validate() const {
    const Eigen::Index n = grid.cells();
    if (n <= 0 || gap.size() != n || coverage.size() != n) {
        throw InputError("contact: gap and coverage must have one value per cell of the grid");
    }
    if (gap.isNaN().any() || !coverage.isFinite().all()) {
        throw InputError("contact: the gap or the coverage holds a value that is not a number");
    }
    if (force_control && (!std::isfinite(force) || force < 0.0)) {
        throw InputError("contact: the commanded force must be zero or positive, in newtons");
    }
    if (!(robot_compliance >= 0.0) || !std::isfinite(robot_compliance)) {
        throw InputError("contact: the robot's compliance must be zero or positive, in mm/N");
    }
    if (!force_control && !std::isfinite(approach)) {
        throw InputError("contact: the commanded approach must be finite, in millimetres");
    }
}

ContactSolution Geometric::solve(const ContactProblem& problem, const Eigen::ArrayXd*) const {
    problem.validate();
    if (problem.force_control) throw InputError("contact: a rigid tool has no force to command");
    ContactSolution solution;
    solution.pressure = Eigen::ArrayXd::Zero(problem.gap.size());
    solution.approach = problem.approach;
    solution.area = (problem.gap < problem.approach).select(problem.coverage, 0.0).sum() *
                    problem.grid.cell_area();
    solution.converged = true;
    return solution;
}

}  // namespace beltgrinding

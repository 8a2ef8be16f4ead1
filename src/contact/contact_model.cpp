#include "beltgrinding/contact_model.h"

#include <cmath>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr int kMostCells = 1 << 26;  // of a grid: its transforms take some 2 GB

/// Cells whose surface the undeformed tool reaches.
class PreparedGeometric final : public PreparedContact {
  public:
    PreparedGeometric(const ContactGrid& grid, std::string description)
        : PreparedContact(grid, std::move(description)) {}

  private:
    ContactSolution do_solve(const ContactProblem& problem, const Eigen::ArrayXd*) override {
        if (problem.force_control)
            throw InputError("contact.rigid_force",
                             "contact: a rigid tool has no force to command");
        ContactSolution solution;
        solution.pressure = Eigen::ArrayXd::Zero(problem.gap.size());
        solution.approach = problem.approach;
        solution.area = (problem.gap < problem.approach).select(problem.coverage, 0.0).sum() *
                        grid().cell_area();
        solution.converged = true;
        return solution;
    }
};

}  // namespace

void ContactGrid::validate() const {
    const bool sides = std::isfinite(ds) && std::isfinite(dy) && ds > 0.0 && dy > 0.0;
    if (nx <= 0 || ny <= 0 || nx > kMostCells / ny || !sides) {
        throw InputError(
            "contact.grid",
            "contact: the grid needs cells of positive sides, in millimetres, at most {most}",
            {{"most", kMostCells}});
    }
}

void ContactProblem::validate(const ContactGrid& grid) const {
    const Eigen::Index n = grid.cells();
    if (gap.size() != n || coverage.size() != n) {
        throw InputError("contact.cells",
                         "contact: gap and coverage must have one value per cell of the grid");
    }
    if (drop.size() != 0 && (drop.size() != grid.ny || !drop.isFinite().all())) {
        throw InputError("contact.rows",
                         "contact: the wheel's profile must have one value per row of the grid");
    }
    if (gap.isNaN().any() || !coverage.isFinite().all()) {
        throw InputError("contact.not_a_number",
                         "contact: the gap or the coverage holds a value that is not a number");
    }
    if (force_control && (!std::isfinite(force) || force < 0.0)) {
        throw InputError("contact.force",
                         "contact: the commanded force must be zero or positive, in newtons");
    }
    if (!(robot_compliance >= 0.0) || !std::isfinite(robot_compliance)) {
        throw InputError("contact.robot_compliance",
                         "contact: the robot's compliance must be zero or positive, in mm/N");
    }
    if (!(recession >= 0.0) || !std::isfinite(recession)) {
        throw InputError("contact.recession",
                         "contact: what the surface recedes by under pressure must be zero or "
                         "positive, in mm/MPa");
    }
    if (!force_control && !std::isfinite(approach)) {
        throw InputError("contact.approach",
                         "contact: the commanded approach must be finite, in millimetres");
    }
}

PreparedContact::PreparedContact(const ContactGrid& grid, std::string description)
    : grid_(grid), description_(std::move(description)) {
    grid_.validate();
}

ContactSolution PreparedContact::solve(const ContactProblem& problem, const Eigen::ArrayXd* start) {
    problem.validate(grid_);
    if (start != nullptr && start->size() != grid_.cells()) {
        throw InputError("contact.start",
                         "contact: the pressure to start from must have one value per cell");
    }
    return do_solve(problem, start);
}

std::unique_ptr<PreparedContact> ContactModel::prepare(const ContactGrid& grid) const {
    grid.validate();
    return do_prepare(grid);
}

std::unique_ptr<PreparedContact> Geometric::do_prepare(const ContactGrid& grid) const {
    return std::make_unique<PreparedGeometric>(grid, describe());
}

}  // namespace beltgrinding

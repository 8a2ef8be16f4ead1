#include "contact/contact_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace beltgrinding {
namespace {

using Mask = Eigen::Array<bool, Eigen::Dynamic, 1>;

void validate(const ContactProblem& problem) {
    const Eigen::Index n = problem.grid.cells();
    if (n <= 0 || problem.gap.size() != n || problem.coverage.size() != n) {
        throw InputError("contact: gap and coverage must have one value per cell of the grid");
    }
    if (problem.gap.isNaN().any() || !problem.coverage.isFinite().all()) {
        throw InputError("contact: the gap or the coverage holds a value that is not a number");
    }
    if (problem.force_control && (!std::isfinite(problem.force) || problem.force < 0.0)) {
        throw InputError("contact: the commanded force must be zero or positive, in newtons");
    }
    if (!problem.force_control && !std::isfinite(problem.approach)) {
        throw InputError("contact: the commanded approach must be finite, in millimetres");
    }
}

/// The state of one solve. Residual t = g + C p - delta; inner products are weighted by coverage,
/// in which C is symmetric.
class ConstrainedConjugateGradients {
  public:
    ConstrainedConjugateGradients(const ContactProblem& problem,
                                  const ComplianceOperator& compliance)
        : problem_(problem),
          compliance_(compliance),
          weight_(problem.coverage * problem.grid.cell_area()),
          reachable_(problem.gap.isFinite() && problem.coverage > 0.0),
          gap_(reachable_.select(problem.gap, 0.0)) {}

    ContactSolution solve(const Eigen::ArrayXd* start);

  private:
    double total(const Eigen::ArrayXd& a) const { return (weight_ * a).sum(); }
    double dot(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) const {
        return (weight_ * a * b).sum();
    }
    void start_from(const Eigen::ArrayXd* start);
    void scale_to_force();
    /// Sets residual and, under force control, delta: the mean that leaves the contact's residual
    /// 0.
    void update_residual();
    bool step(bool reset);

    const ContactProblem& problem_;
    const ComplianceOperator& compliance_;
    Eigen::ArrayXd weight_;
    Mask reachable_;
    Eigen::ArrayXd gap_;
    Eigen::ArrayXd pressure_, residual_, direction_, image_, displacement_;
    double delta_ = 0.0;
    double last_norm_ = 1.0;
};

void ConstrainedConjugateGradients::start_from(const Eigen::ArrayXd* start) {
    const Eigen::Index n = gap_.size();
    if (start != nullptr && start->size() == n && start->isFinite().all()) {
        pressure_ = reachable_.select(start->max(0.0), 0.0);
    } else {
        pressure_ = Eigen::ArrayXd::Zero(n);
    }
    if (total(pressure_) > 0.0) return;
    if (!problem_.force_control) {
        // Every cell as a spring of its own: exact for a foundation, a fair guess otherwise.
        pressure_ =
            reachable_.select((problem_.approach - gap_).max(0.0) / compliance_.diagonal(), 0.0);
        return;
    }
    // Force control: the foundation's own solution, delta by bisection of a monotone function.
    const double infinity = std::numeric_limits<double>::infinity();
    const double lowest = reachable_.select(gap_, infinity).minCoeff();
    const double covered = (reachable_.select(weight_, 0.0)).sum();
    double low = lowest;
    double high = reachable_.select(gap_, -infinity).maxCoeff() +
                  problem_.force * compliance_.diagonal() / covered;
    for (int i = 0; i < 60; ++i) {
        delta_ = 0.5 * (low + high);
        pressure_ = reachable_.select((delta_ - gap_).max(0.0) / compliance_.diagonal(), 0.0);
        (total(pressure_) < problem_.force ? low : high) = delta_;
    }
}

void ConstrainedConjugateGradients::scale_to_force() {
    if (!problem_.force_control) return;
    const double force = total(pressure_);
    if (force > 0.0) pressure_ *= problem_.force / force;
}

void ConstrainedConjugateGradients::update_residual() {
    compliance_.apply(pressure_, problem_.coverage, displacement_);
    residual_ = gap_ + displacement_;
    if (problem_.force_control) {
        const Eigen::ArrayXd in_contact = (pressure_ > 0.0).select(weight_, 0.0);
        delta_ = (in_contact * residual_).sum() / in_contact.sum();
    } else {
        delta_ = problem_.approach;
    }
    residual_ -= delta_;
}

bool ConstrainedConjugateGradients::step(bool reset) {
    const Mask contact = pressure_ > 0.0;
    const Eigen::ArrayXd r = contact.select(residual_, 0.0);
    const double norm = dot(r, r);
    if (reset) {
        direction_ = r;
    } else {
        direction_ = contact.select(r + (norm / last_norm_) * direction_, 0.0);
    }
    last_norm_ = norm > 0.0 ? norm : 1.0;

    compliance_.apply(direction_, problem_.coverage, image_);
    if (problem_.force_control) {
        const Eigen::ArrayXd in_contact = contact.select(weight_, 0.0);
        image_ -= (in_contact * image_).sum() / in_contact.sum();
    }
    const double curvature = dot(contact.select(image_, 0.0), direction_);
    bool contact_changed = false;
    double length = 0.0;
    if (curvature > 0.0) {
        length = dot(r, direction_) / curvature;
        pressure_ -= length * direction_;
        const Mask lost = contact && pressure_ <= 0.0;
        contact_changed = lost.any();
        pressure_ = pressure_.max(0.0);
    }
    // Cells that overlap without pressure come into contact.
    const Mask overlap = reachable_ && pressure_ <= 0.0 && residual_ < 0.0;
    if (overlap.any()) {
        contact_changed = true;
        const double scale = length > 0.0 ? length : 1.0 / compliance_.diagonal();
        pressure_ = overlap.select(-scale * residual_, pressure_);
    }
    return contact_changed;
}

ContactSolution ConstrainedConjugateGradients::solve(const Eigen::ArrayXd* start) {
    ContactSolution solution;
    const Eigen::Index n = gap_.size();
    solution.pressure = Eigen::ArrayXd::Zero(n);
    if (!reachable_.any() || (problem_.force_control && problem_.force == 0.0)) {
        solution.converged = !problem_.force_control || problem_.force == 0.0;
        solution.approach = problem_.force_control ? 0.0 : problem_.approach;
        return solution;
    }
    start_from(start);
    scale_to_force();

    bool reset = true;
    const double diagonal = compliance_.diagonal();
    for (solution.iterations = 0; solution.iterations < problem_.max_iterations;
         ++solution.iterations) {
        update_residual();
        // Error of the pressure field: the pressure that would close each cell's own residual.
        const Eigen::ArrayXd error =
            (reachable_ && (pressure_ > 0.0 || residual_ < 0.0)).select(residual_.abs(), 0.0);
        const double scale = std::max(total(pressure_), 1e-300);
        const double wrong = total(error) / diagonal;
        if (wrong <= problem_.tolerance * scale || wrong == 0.0) {
            solution.converged = true;
            break;
        }
        reset = step(reset);
        scale_to_force();
    }
    solution.pressure = pressure_;
    solution.force = total(pressure_);
    solution.approach = delta_;
    solution.area = (pressure_ > 0.0).select(weight_, 0.0).sum();
    solution.peak_pressure = pressure_.maxCoeff();
    return solution;
}

}  // namespace

ContactSolution solve_contact(const ContactProblem& problem, const ComplianceOperator& compliance,
                              const Eigen::ArrayXd* start) {
    validate(problem);
    return ConstrainedConjugateGradients(problem, compliance).solve(start);
}

}  // namespace beltgrinding

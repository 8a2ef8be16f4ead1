// Polonsky and Keer's constrained conjugate gradients; see
// beltgrinding/compliance.h.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/compliance.h"

namespace beltgrinding {
namespace {

constexpr double kPi = std::numbers::pi;

/// The state of one solve. Residual t = g + C p - delta; inner products are weighted by coverage,
/// in which C is symmetric.
class ConstrainedConjugateGradients {
  public:
    ConstrainedConjugateGradients(const ContactProblem& problem, ComplianceOperator& compliance)
        : problem_(problem),
          compliance_(compliance),
          weight_(problem.coverage * compliance.grid().cell_area()),
          reachable_((problem.gap.isFinite() && problem.coverage > 0.0).cast<double>()),
          gap_((reachable_ > 0.0).select(problem.gap, 0.0)) {}

    ContactSolution solve(const Eigen::ArrayXd* start);

  private:
    double total(const Eigen::ArrayXd& a) const { return (weight_ * a).sum(); }
    double dot(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) const {
        return (weight_ * a * b).sum();
    }
    void start_from(const Eigen::ArrayXd* start);
    /// Force control: the pressure of cells that are springs of their own, of `springs` mm/MPa.
    void press_foundation(double springs);
    void scale_to_force();
    /// Sets residual and, under force control, delta: the mean that leaves the contact's residual
    /// 0.
    void update_residual();
    /// One step along the conjugate direction, then what contact demands: no tension, pressure
    /// where cells overlap.
    void step();
    /// Share of the pressure field (L1) that is wrong, by what the next step would change: the
    /// preconditioned residual times the last step's length.
    double error();
    /// About the inverse of C on the contact, to a factor. `r` is zero beside the contact.
    void precondition(const Eigen::ArrayXd& r, Eigen::ArrayXd& z) const;

    const ContactProblem& problem_;
    ComplianceOperator& compliance_;
    Eigen::ArrayXd weight_;
    Eigen::ArrayXd reachable_, contact_;  // 1 for the cells, else 0: quicker than logical arrays
    Eigen::ArrayXd gap_;
    Eigen::ArrayXd pressure_, residual_, direction_, image_, displacement_, last_residual_;
    Eigen::ArrayXd steepest_, ones_;  // preconditioned residual; and of a constant one
    Eigen::ArrayXd held_;             // residual of the contact, 0 beside it
    Eigen::Index cells_ = -1;         // in contact
    double area_ = 0.0;               // of the contact, mm2
    double ones_total_ = 1.0;
    double length_ = 0.0;  // of the last step, MPa/mm
    double delta_ = 0.0;
    double last_norm_ = 1.0;
    bool restart_ = true;  // cells came into contact: the old direction is of no use
    bool stale_ = true;    // the pressure was corrected: the residual must be computed anew
};

void ConstrainedConjugateGradients::start_from(const Eigen::ArrayXd* start) {
    const Eigen::Index n = gap_.size();
    if (start != nullptr && start->isFinite().all()) {
        pressure_ = reachable_ * start->max(0.0);
    } else {
        pressure_ = Eigen::ArrayXd::Zero(n);
    }
    if (total(pressure_) > 0.0) return;
    if (!problem_.force_control) {
        // Every cell as a spring of its own: exact for a foundation and a rigid robot, a fair guess
        // otherwise.
        pressure_ = reachable_ * (problem_.approach - gap_).max(0.0) / compliance_.diagonal();
        return;
    }
    press_foundation(compliance_.diagonal());
    if (compliance_.local()) return;
    // The cells press on one another: once more with springs as soft as they are together.
    compliance_.apply(pressure_, problem_.coverage, displacement_);
    press_foundation(dot(pressure_, displacement_) / dot(pressure_, pressure_));
}

void ConstrainedConjugateGradients::press_foundation(double springs) {
    // Newton's method on a convex, increasing function of delta, from above: the cells in contact
    // only become fewer.
    contact_ = reachable_;
    for (double before = -1.0, count = contact_.sum(); count != before;) {
        delta_ = (problem_.force * springs + (contact_ * weight_ * gap_).sum()) /
                 (contact_ * weight_).sum();
        before = count;
        contact_ *= (gap_ < delta_).cast<double>();
        count = contact_.sum();
    }
    pressure_ = contact_ * (delta_ - gap_) / springs;
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
        contact_ = (pressure_ > 0.0).cast<double>() * weight_;
        delta_ = (contact_ * residual_).sum() / contact_.sum();
    } else {
        delta_ = problem_.approach - problem_.robot_compliance * total(pressure_);
    }
    residual_ -= delta_;
}

void ConstrainedConjugateGradients::precondition(const Eigen::ArrayXd& r, Eigen::ArrayXd& z) const {
    z = r;
    if (compliance_.local()) return;
    // The compliance falls with the wavenumber k like 1 / k between the contact's size and the
    // cell's; a + b k^2, a five-point star, levels that out. Beside the contact r is zero.
    const ContactGrid& grid = compliance_.grid();
    const double cell = std::sqrt(grid.cell_area());
    const double b = std::sqrt(area_) * cell / (kPi * std::sqrt(8.0));
    const double across = b / (grid.ds * grid.ds), along = b / (grid.dy * grid.dy);
    for (int j = 0; j < grid.ny; ++j) {
        const double* row = r.data() + static_cast<std::ptrdiff_t>(j) * grid.nx;
        double* to = z.data() + static_cast<std::ptrdiff_t>(j) * grid.nx;
        for (int i = 0; i < grid.nx; ++i) {
            const double before = i > 0 ? row[i - 1] : 0.0;
            const double after = i + 1 < grid.nx ? row[i + 1] : 0.0;
            to[i] += across * (2.0 * row[i] - before - after);
        }
        // The wheel's side faces are no border of the pressure.
        for (const int step : {-1, 1}) {
            if (j + step < 0 || j + step >= grid.ny) continue;
            const double* beside = row + static_cast<std::ptrdiff_t>(step) * grid.nx;
            for (int i = 0; i < grid.nx; ++i) to[i] += along * (row[i] - beside[i]);
        }
    }
    z *= contact_;
}

double ConstrainedConjugateGradients::error() {
    contact_ = (pressure_ > 0.0).cast<double>();
    const auto cells = static_cast<Eigen::Index>(contact_.sum());
    // While no cell comes in, the contact only loses cells: as many are the same ones.
    const bool same = cells == cells_ && !restart_;
    cells_ = cells;
    area_ = total(contact_);
    held_ = contact_ * residual_;
    precondition(held_, steepest_);
    if (problem_.force_control) {  // a direction that leaves the force as it is
        if (!same) {
            precondition(contact_, ones_);
            ones_total_ = total(ones_);
        }
        steepest_ -= total(steepest_) / ones_total_ * ones_;
    }
    const double overlap = -(weight_ * (reachable_ - contact_) * residual_.min(0.0)).sum();
    const double length = length_ > 0.0 ? length_ : 1.0 / compliance_.diagonal();
    return length * (total(steepest_.abs()) + overlap) / std::max(total(pressure_), 1e-300);
}

void ConstrainedConjugateGradients::step() {
    const double norm = dot(held_, steepest_);
    if (restart_) {
        direction_ = steepest_;
    } else {
        // Polak and Ribiere's factor, which forgets what the contact's changes have spoilt.
        const double factor = std::max(0.0, (norm - dot(last_residual_, steepest_)) / last_norm_);
        direction_ = contact_ * (steepest_ + factor * direction_);
        if (problem_.force_control) direction_ -= total(direction_) / area_ * contact_;
    }
    last_norm_ = norm > 0.0 ? norm : 1.0;
    last_residual_ = held_;

    compliance_.apply(direction_, problem_.coverage, image_);
    double mean = 0.0;
    if (problem_.force_control) {
        mean = dot(contact_, image_) / area_;
        image_ -= mean;
    } else if (problem_.robot_compliance > 0.0) {
        mean = -problem_.robot_compliance * total(direction_);
        image_ -= mean;
    }
    const double curvature = dot(image_, direction_);
    stale_ = restart_ = false;
    double length = 0.0;
    if (curvature > 0.0) {
        length_ = length = dot(held_, direction_) / curvature;
        pressure_ = (pressure_ - length * direction_).max(0.0);
        stale_ = (pressure_ > 0.0).count() < cells_;
    }
    // Cells that overlap without pressure come into contact.
    const Eigen::ArrayXd overlap = (reachable_ - contact_) * residual_.min(0.0);
    if (overlap.minCoeff() < 0.0) {
        stale_ = restart_ = true;
        pressure_ -= (length > 0.0 ? length : 1.0 / compliance_.diagonal()) * overlap;
    }
    if (!stale_) {
        residual_ -= length * image_;
        delta_ -= length * mean;
    }
}

ContactSolution ConstrainedConjugateGradients::solve(const Eigen::ArrayXd* start) {
    ContactSolution solution;
    const Eigen::Index n = gap_.size();
    solution.pressure = Eigen::ArrayXd::Zero(n);
    if (reachable_.sum() == 0.0 || (problem_.force_control && problem_.force == 0.0)) {
        solution.converged = !problem_.force_control || problem_.force == 0.0;
        solution.approach = problem_.force_control ? 0.0 : problem_.approach;
        return solution;
    }
    start_from(start);

    for (solution.iterations = 0; solution.iterations < problem_.max_iterations;
         ++solution.iterations) {
        if (stale_) {
            scale_to_force();
            update_residual();
        }
        if (error() <= problem_.tolerance) {
            solution.converged = true;
            break;
        }
        step();
    }
    scale_to_force();
    solution.pressure = pressure_;
    solution.force = total(pressure_);
    solution.approach = delta_;
    solution.area = (pressure_ > 0.0).select(weight_, 0.0).sum();
    solution.peak_pressure = pressure_.maxCoeff();
    return solution;
}

}  // namespace

ContactSolution ComplianceOperator::do_solve(const ContactProblem& problem,
                                             const Eigen::ArrayXd* start) {
    return ConstrainedConjugateGradients(problem, *this).solve(start);
}

}  // namespace beltgrinding

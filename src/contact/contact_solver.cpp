#include "contact/contact_solver.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace beltgrinding {
namespace {

constexpr double kPi = std::numbers::pi;

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
    /// Force control: the pressure of cells that are springs of their own, of `springs` mm/MPa.
    void press_foundation(double springs);
    void scale_to_force();
    /// Sets residual and, under force control, delta: the mean that leaves the contact's residual
    /// 0.
    void update_residual();
    /// One step along the conjugate direction, then what contact demands: no tension, pressure where
    /// cells overlap.
    void step();
    /// Share of the pressure field (L1) that is wrong, by what the next step would change: the
    /// preconditioned residual times the last step's length.
    double error();
    /// About the inverse of C on the contact, to a factor; `area` of the contact in mm2.
    Eigen::ArrayXd precondition(const Eigen::ArrayXd& r, const Mask& contact, double area) const;

    const ContactProblem& problem_;
    const ComplianceOperator& compliance_;
    Eigen::ArrayXd weight_;
    Mask reachable_;
    Eigen::ArrayXd gap_;
    Eigen::ArrayXd pressure_, residual_, direction_, image_, displacement_, last_residual_;
    Eigen::ArrayXd steepest_, ones_;  // preconditioned residual; and of a constant one
    Mask contact_;
    double ones_total_ = 1.0;
    double length_ = 0.0;  // of the last step, MPa/mm
    double delta_ = 0.0;
    double last_norm_ = 1.0;
    bool restart_ = true;  // cells came into contact: the old direction is of no use
    bool stale_ = true;    // the pressure was corrected: the residual must be computed anew
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
    press_foundation(compliance_.diagonal());
    if (compliance_.local()) return;
    // The cells press on one another: once more with springs as soft as they are together.
    compliance_.apply(pressure_, problem_.coverage, displacement_);
    press_foundation(dot(pressure_, displacement_) / dot(pressure_, pressure_));
}

void ConstrainedConjugateGradients::press_foundation(double springs) {
    // Newton's method on a convex, increasing function of delta, from above: the cells in contact
    // only become fewer.
    Mask contact = reachable_;
    for (Eigen::Index before = -1, count = contact.count(); count != before;) {
        const Eigen::ArrayXd weight = contact.select(weight_, 0.0);
        delta_ = (problem_.force * springs + (weight * gap_).sum()) / weight.sum();
        before = count;
        contact = contact && gap_ < delta_;
        count = contact.count();
    }
    pressure_ = contact.select((delta_ - gap_) / springs, 0.0);
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

Eigen::ArrayXd ConstrainedConjugateGradients::precondition(const Eigen::ArrayXd& r,
                                                           const Mask& contact,
                                                           double area) const {
    if (compliance_.local()) return r;
    // The compliance falls with the wavenumber k like 1 / k between the contact's size and the
    // cell's; a + b k^2, a five-point star, levels that out. Beside the contact r is zero.
    const ContactGrid& grid = problem_.grid;
    const double cell = std::sqrt(grid.cell_area());
    const double b = std::sqrt(area) * cell / (kPi * std::sqrt(8.0));
    const double across = b / (grid.ds * grid.ds), along = b / (grid.dy * grid.dy);
    Eigen::ArrayXd z = r;
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
    return contact.select(z, 0.0);
}

double ConstrainedConjugateGradients::error() {
    const Mask contact = pressure_ > 0.0;
    const bool same = contact_.size() == contact.size() && (contact_ == contact).all();
    contact_ = contact;
    const double area = contact_.select(weight_, 0.0).sum();
    const Eigen::ArrayXd r = contact_.select(residual_, 0.0);
    steepest_ = precondition(r, contact_, area);
    if (problem_.force_control) {  // a direction that leaves the force as it is
        if (!same) {
            ones_ = precondition(contact_.cast<double>(), contact_, area);
            ones_total_ = total(ones_);
        }
        steepest_ -= total(steepest_) / ones_total_ * ones_;
    }
    const double overlap = (reachable_ && !contact_).select(weight_ * -residual_.min(0.0), 0.0).sum();
    const double length = length_ > 0.0 ? length_ : 1.0 / compliance_.diagonal();
    return length * (total(steepest_.abs()) + overlap) / std::max(total(pressure_), 1e-300);
}

void ConstrainedConjugateGradients::step() {
    const Mask& contact = contact_;
    const Eigen::ArrayXd in_contact = contact.select(weight_, 0.0);
    const double area = in_contact.sum();
    const double norm = dot(residual_, steepest_);
    if (restart_) {
        direction_ = steepest_;
    } else {
        // Polak and Ribiere's factor, which forgets what the contact's changes have spoilt.
        const double factor = std::max(0.0, (norm - dot(last_residual_, steepest_)) / last_norm_);
        direction_ = contact.select(steepest_ + factor * direction_, 0.0);
        if (problem_.force_control) {
            direction_ = contact.select(direction_ - total(direction_) / area, 0.0);
        }
    }
    last_norm_ = norm > 0.0 ? norm : 1.0;
    last_residual_ = residual_;

    compliance_.apply(direction_, problem_.coverage, image_);
    double mean = 0.0;
    if (problem_.force_control) {
        mean = (in_contact * image_).sum() / area;
        image_ -= mean;
    }
    const double curvature = dot(contact.select(image_, 0.0), direction_);
    stale_ = restart_ = false;
    double length = 0.0;
    if (curvature > 0.0) {
        length = dot(contact.select(residual_, 0.0), direction_) / curvature;
        length_ = length;
        pressure_ -= length * direction_;
        const Mask lost = contact && pressure_ <= 0.0;
        stale_ = lost.any();
        pressure_ = pressure_.max(0.0);
    }
    // Cells that overlap without pressure come into contact.
    const Mask overlap = reachable_ && pressure_ <= 0.0 && residual_ < 0.0;
    if (overlap.any()) {
        stale_ = restart_ = true;
        const double scale = length > 0.0 ? length : 1.0 / compliance_.diagonal();
        pressure_ = overlap.select(-scale * residual_, pressure_);
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
    if (!reachable_.any() || (problem_.force_control && problem_.force == 0.0)) {
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

ContactSolution solve_contact(const ContactProblem& problem, const ComplianceOperator& compliance,
                              const Eigen::ArrayXd* start) {
    validate(problem);
    return ConstrainedConjugateGradients(problem, compliance).solve(start);
}

}  // namespace beltgrinding

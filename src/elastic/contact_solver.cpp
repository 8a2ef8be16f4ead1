// Polonsky and Keer's constrained conjugate gradients; see
// beltgrinding/compliance.h.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "contact/peak_pressure.h"
#include "elastic/compliance.h"

namespace beltgrinding {
namespace {

constexpr double kPi = std::numbers::pi;
// Of the tolerance: a start that is no better is not kept as it is. Else the pressure of one step
// stood still for many, and its error added up in what they remove.
constexpr double kUntouched = 0.1;
constexpr double kRough = 0.1;  // tolerance of a first look at where the contact is

// What every cell needs is done in few passes over the arrays, two cells at a time: most of a
// solution's time is theirs and the operator's. A sum has the same order on every machine.
using Two = double __attribute__((vector_size(16)));
struct Pair {
    Eigen::Index cell;
};
Two at(const Eigen::ArrayXd& a, Pair i) {
    Two v;
    std::memcpy(&v, a.data() + i.cell, sizeof(v));
    return v;
}
void put(Eigen::ArrayXd& a, Pair i, Two v) {
    std::memcpy(a.data() + i.cell, &v, sizeof(v));
}
Two below_zero(Two v) {
    return v < 0.0 ? v : Two{};
}
Two above_zero(Two v) {
    return v > 0.0 ? v : Two{};
}
Two is_above_zero(Two v) {
    return v > 0.0 ? Two{1.0, 1.0} : Two{};
}
double at(const Eigen::ArrayXd& a, Eigen::Index i) {
    return a[i];
}
void put(Eigen::ArrayXd& a, Eigen::Index i, double v) {
    a[i] = v;
}
double below_zero(double v) {
    return v < 0.0 ? v : 0.0;
}
double above_zero(double v) {
    return v > 0.0 ? v : 0.0;
}
double is_above_zero(double v) {
    return v > 0.0 ? 1.0 : 0.0;
}

class Sum {
  public:
    void operator+=(Two v) { pairs_ += v; }
    void operator+=(double v) { last_ += v; }
    operator double() const { return pairs_[0] + pairs_[1] + last_; }

  private:
    Two pairs_{};
    double last_ = 0.0;
};

/// Visits all cells from `first` on, in pairs and the last one alone.
template <class Visit>
void for_cells(Eigen::Index first, Eigen::Index end, Visit visit) {
    Eigen::Index i = first;
    for (; i + 2 <= end; i += 2) visit(Pair{i});
    if (i < end) visit(i);
}

/// The state of one solve. Residual t = g + C p - delta; inner products are weighted by coverage,
/// in which C is symmetric.
class ConstrainedConjugateGradients {
  public:
    /// The problem is of `grid`, on which the operator works.
    ConstrainedConjugateGradients(const ContactProblem& problem, const ContactGrid& grid,
                                  ComplianceOperator& compliance)
        : problem_(problem),
          grid_(grid),
          compliance_(compliance),
          weight_(problem.coverage * grid.cell_area()),
          reachable_((problem.gap.isFinite() && problem.coverage > 0.0).cast<double>()),
          gap_((reachable_ > 0.0).select(problem.gap, 0.0)) {}

    /// A pressure to start from; 0 where there is no contact at all.
    Eigen::ArrayXd first();
    ContactSolution solve(const Eigen::ArrayXd* start);

  private:
    template <class Visit>
    void for_all(Visit visit) const {
        for_cells(0, gap_.size(), visit);
    }
    double total(const Eigen::ArrayXd& a) const { return (weight_ * a).sum(); }
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
    /// About the inverse of C on the contact, to a factor. `r` is zero beside the contact. The
    /// total of z.
    double precondition(const Eigen::ArrayXd& r, Eigen::ArrayXd& z) const;

    const ContactProblem& problem_;
    const ContactGrid& grid_;
    ComplianceOperator& compliance_;
    Eigen::ArrayXd weight_;
    Eigen::ArrayXd reachable_, contact_;  // 1 for the cells, else 0: quicker than logical arrays
    Eigen::ArrayXd gap_;
    Eigen::ArrayXd pressure_, residual_, direction_, image_, displacement_, last_residual_;
    Eigen::ArrayXd steepest_, ones_;  // preconditioned residual; and of a constant one
    Eigen::ArrayXd held_;             // residual of the contact, 0 beside it
    Eigen::Index cells_ = -1;         // in contact
    double area_ = 0.0;               // of the contact, mm2
    double overlap_ = 0.0;            // of cells beside the contact, mm3
    double ones_total_ = 1.0;
    double norm_ = 0.0, along_last_ = 0.0;  // steepest times the residual, and the last one
    double length_ = 0.0;                   // of the last step, MPa/mm
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
        pressure_ = reachable_ * (problem_.approach - gap_).max(0.0) / compliance_.softness();
        return;
    }
    press_foundation(compliance_.softness());
    if (compliance_.local()) return;
    // The cells press on one another: once more with springs as soft as they are together.
    compliance_.apply_covered(pressure_, problem_.coverage, displacement_);
    press_foundation((weight_ * pressure_ * displacement_).sum() /
                     (weight_ * pressure_.square()).sum());
}

void ConstrainedConjugateGradients::press_foundation(double springs) {
    // Newton's method on a convex, increasing function of delta, from above: the cells in contact
    // only become fewer.
    contact_ = reachable_;
    for (double before = -1.0, count = contact_.sum(); count != before;) {
        Sum area, gap;
        for_all([&](auto i) {
            const auto held = at(contact_, i) * at(weight_, i);
            area += held;
            gap += held * at(gap_, i);
        });
        delta_ = (problem_.force * springs + gap) / area;
        before = count;
        Sum cells;
        for_all([&](auto i) {
            const auto held = at(contact_, i) * is_above_zero(delta_ - at(gap_, i));
            put(contact_, i, held);
            cells += held;
        });
        count = cells;
    }
    pressure_ = contact_ * (delta_ - gap_) / springs;
}

void ConstrainedConjugateGradients::scale_to_force() {
    if (!problem_.force_control) return;
    const double force = total(pressure_);
    if (force > 0.0) pressure_ *= problem_.force / force;
}

void ConstrainedConjugateGradients::update_residual() {
    compliance_.apply_covered(pressure_, problem_.coverage, displacement_);
    residual_.resize(gap_.size());
    if (problem_.force_control) {
        Sum area, total;
        for_all([&](auto i) {
            const auto held = is_above_zero(at(pressure_, i)) * at(weight_, i);
            const auto residual = at(gap_, i) + at(displacement_, i);
            put(residual_, i, residual);
            area += held;
            total += held * residual;
        });
        delta_ = total / area;
    } else {
        residual_ = gap_ + displacement_;
        delta_ = problem_.approach - problem_.robot_compliance * total(pressure_);
    }
    residual_ -= delta_;
}

double ConstrainedConjugateGradients::precondition(const Eigen::ArrayXd& r,
                                                   Eigen::ArrayXd& z) const {
    if (compliance_.local()) {
        z = r;
        return total(z);
    }
    // The compliance falls with the wavenumber k like 1 / k between the contact's size and the
    // cell's; a + b k^2, a five-point star, levels that out. Beside the contact r is zero.
    z.resize(r.size());
    const int nx = grid_.nx;
    const double cell = std::sqrt(grid_.cell_area());
    const double b = std::sqrt(area_) * cell / (kPi * std::sqrt(8.0));
    const double across = b / (grid_.ds * grid_.ds), along = b / (grid_.dy * grid_.dy);
    const Eigen::ArrayXd nothing = Eigen::ArrayXd::Zero(nx);
    for (int j = 0; j < grid_.ny; ++j) {
        // The wheel's side faces are no border of the pressure.
        const bool last = j + 1 == grid_.ny;
        const double own = 1.0 + 2.0 * across + along * ((j > 0 ? 1.0 : 0.0) + (last ? 0.0 : 1.0));
        const double* row = r.data() + static_cast<std::ptrdiff_t>(j) * nx;
        const double* before = j > 0 ? row - nx : nothing.data();
        const double* after = last ? nothing.data() : row + nx;
        const double* held = contact_.data() + static_cast<std::ptrdiff_t>(j) * nx;
        double* to = z.data() + static_cast<std::ptrdiff_t>(j) * nx;
        const auto star = [&](int i, double left, double right) {
            to[i] =
                held[i] * (own * row[i] - across * (left + right) - along * (before[i] + after[i]));
        };
        for (int i = 1; i + 1 < nx; ++i) star(i, row[i - 1], row[i + 1]);
        star(0, 0.0, nx > 1 ? row[1] : 0.0);
        if (nx > 1) star(nx - 1, row[nx - 2], 0.0);
    }
    return total(z);
}

double ConstrainedConjugateGradients::error() {
    contact_.resize(gap_.size());
    held_.resize(gap_.size());
    Sum cells_now, area, overlap, force;
    for_all([&](auto i) {
        const auto held = is_above_zero(at(pressure_, i)), weight = at(weight_, i);
        const auto residual = at(residual_, i);
        put(contact_, i, held);
        put(held_, i, held * residual);
        cells_now += held;
        area += held * weight;
        force += weight * at(pressure_, i);
        overlap += weight * (at(reachable_, i) - held) * below_zero(residual);
    });
    const auto cells = static_cast<Eigen::Index>(static_cast<double>(cells_now));
    // While no cell comes in, the contact only loses cells: as many are the same ones.
    const bool same = cells == cells_ && !restart_;
    cells_ = cells;
    area_ = area;
    overlap_ = -overlap;
    double shift = 0.0;
    const double steepest_total = precondition(held_, steepest_);
    if (problem_.force_control) {  // a direction that leaves the force as it is
        if (!same) ones_total_ = precondition(contact_, ones_);
        shift = steepest_total / ones_total_;
    } else if (ones_.size() == 0) {
        ones_ = contact_;
    }
    if (restart_) last_residual_ = held_;
    Sum off, norm, along_last;
    for_all([&](auto i) {
        const auto steepest = at(steepest_, i) - shift * at(ones_, i);
        const auto weighted = at(weight_, i) * steepest;
        put(steepest_, i, steepest);
        off += above_zero(weighted) - below_zero(weighted);
        norm += weighted * at(held_, i);
        along_last += weighted * at(last_residual_, i);
    });
    norm_ = norm;
    along_last_ = along_last;
    const double length = length_ > 0.0 ? length_ : 1.0 / compliance_.softness();
    return length * (off + overlap_) / std::max<double>(force, 1e-300);
}

void ConstrainedConjugateGradients::step() {
    if (restart_) {
        direction_ = steepest_;
    } else {
        // Polak and Ribiere's factor, which forgets what the contact's changes have spoilt.
        const double factor = std::max(0.0, (norm_ - along_last_) / last_norm_);
        Sum sum;
        for_all([&](auto i) {
            const auto direction =
                at(contact_, i) * (at(steepest_, i) + factor * at(direction_, i));
            put(direction_, i, direction);
            sum += at(weight_, i) * direction;
        });
        if (problem_.force_control) direction_ -= sum / area_ * contact_;
    }
    last_norm_ = norm_ > 0.0 ? norm_ : 1.0;
    std::swap(last_residual_, held_);  // the contact's residual, until the next error()

    compliance_.apply_covered(direction_, problem_.coverage, image_);
    Sum pressed, curved, along, change;
    for_all([&](auto i) {
        const auto weight = at(weight_, i), direction = at(direction_, i), image = at(image_, i);
        pressed += weight * at(contact_, i) * image;
        curved += weight * direction * image;
        along += weight * direction * at(last_residual_, i);
        change += weight * direction;
    });
    double mean = 0.0;
    if (problem_.force_control) {
        mean = pressed / area_;
    } else if (problem_.robot_compliance > 0.0) {
        mean = -problem_.robot_compliance * change;
    }
    const double curvature = curved - mean * change;
    stale_ = restart_ = false;
    double length = 0.0;
    if (curvature > 0.0) {
        length_ = length = along / curvature;
        Sum cells;
        for_all([&](auto i) {
            const auto pressure = above_zero(at(pressure_, i) - length * at(direction_, i));
            put(pressure_, i, pressure);
            cells += is_above_zero(pressure);
        });
        stale_ = cells < static_cast<double>(cells_);
    }
    // Cells that overlap without pressure come into contact.
    if (overlap_ > 0.0) {
        stale_ = restart_ = true;
        const double softness = length > 0.0 ? length : 1.0 / compliance_.softness();
        for_all([&](auto i) {
            const auto beside = at(reachable_, i) - at(contact_, i);
            put(pressure_, i, at(pressure_, i) - softness * beside * below_zero(at(residual_, i)));
        });
    }
    if (!stale_) {
        residual_ -= length * (image_ - mean);
        delta_ -= length * mean;
    }
}

Eigen::ArrayXd ConstrainedConjugateGradients::first() {
    const bool pressed = !problem_.force_control || problem_.force > 0.0;
    if (!pressed || reachable_.sum() == 0.0) return Eigen::ArrayXd::Zero(gap_.size());
    start_from(nullptr);
    return pressure_;
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
        problem_.context.throw_if_cancelled();
        if (stale_) {
            scale_to_force();
            update_residual();
        }
        const double good = solution.iterations == 0 ? kUntouched : 1.0;
        if (error() <= good * problem_.tolerance) {
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
    solution.peak_pressure = peak_pressure(grid_, pressure_, problem_.coverage);
    return solution;
}

/// Some columns of a grid.
struct Columns {
    int first, last;

    int count() const { return last - first + 1; }
    /// The columns of pressed cells; all, if there are none.
    static Columns pressed(const ContactGrid& grid, const Eigen::ArrayXd& pressure) {
        Columns found{grid.nx, -1};
        for (int j = 0; j < grid.ny; ++j) {
            const double* row = pressure.data() + static_cast<std::ptrdiff_t>(j) * grid.nx;
            for (int i = 0; i < found.first; ++i)
                if (row[i] > 0.0) found.first = i;
            for (int i = grid.nx - 1; i > found.last; --i)
                if (row[i] > 0.0) found.last = i;
        }
        return found.last < 0 ? Columns{0, grid.nx - 1} : found;
    }
    /// These with some beside them, of a number that many contacts share; all where that saves
    /// little.
    Columns with_margin(int nx) const {
        int some = 8;
        for (int step = 2; some < count() + 2 * kMargin; some += step)
            if (some == 8 * step) step *= 2;
        if (some > kWorthwhile * nx) return {0, nx - 1};
        const int begin = std::clamp((first + last + 1 - some) / 2, 0, nx - some);
        return {begin, begin + some - 1};
    }
    Eigen::ArrayXd of(const ContactGrid& grid, const Eigen::ArrayXd& values) const {
        return Cells(values.data(), grid.nx, grid.ny).middleRows(first, count()).reshaped();
    }
    Eigen::ArrayXd spread(const ContactGrid& grid, const Eigen::ArrayXd& values) const {
        Eigen::ArrayXXd all = Eigen::ArrayXXd::Zero(grid.nx, grid.ny);
        all.middleRows(first, count()) = Cells(values.data(), count(), grid.ny);
        return all.reshaped();
    }

  private:
    using Cells = Eigen::Map<const Eigen::ArrayXXd>;  // a column of the grid is a row
    static constexpr int kMargin = 3;
    static constexpr double kWorthwhile = 0.8;  // of the grid
};

/// While it lives, a recession is another one.
class Receding {
  public:
    Receding(double& recession, double now) : recession_(recession) { recession = now; }
    ~Receding() { recession_ = 0.0; }
    Receding(const Receding&) = delete;
    Receding& operator=(const Receding&) = delete;

  private:
    double& recession_;
};

}  // namespace

ContactSolution ComplianceOperator::solve_columns(const ContactProblem& problem,
                                                  const Eigen::ArrayXd& start, int first, int last,
                                                  double tolerance) {
    const Columns columns{first, last};
    ContactProblem part;
    part.drop = problem.drop;
    part.force_control = problem.force_control;
    part.force = problem.force;
    part.approach = problem.approach;
    part.robot_compliance = problem.robot_compliance;
    part.tolerance = tolerance;
    part.max_iterations = problem.max_iterations;
    part.context = problem.context;
    part.gap = columns.of(grid(), problem.gap);
    part.coverage = columns.of(grid(), problem.coverage);
    const Eigen::ArrayXd pressure = columns.of(grid(), start);
    work_on_columns(columns.count());
    set_surface(part);
    set_coverage(part.coverage);
    ContactSolution solution =
        ConstrainedConjugateGradients(part, working_, *this).solve(&pressure);
    solution.pressure = columns.spread(grid(), solution.pressure);
    return solution;
}

bool ComplianceOperator::goes_on_beyond(const ContactProblem& problem,
                                        const ContactSolution& solution, int first, int last) {
    const int nx = grid().nx;
    const Columns pressed = Columns::pressed(grid(), solution.pressure);
    if ((pressed.first == first && first > 0) || (pressed.last == last && last + 1 < nx))
        return true;
    work_on_columns(nx);
    set_surface(problem);
    apply(solution.pressure, problem.coverage, displacement_);
    const auto overlaps = [&](int cell) {
        return problem.gap[cell] + displacement_[cell] < solution.approach &&
               problem.coverage[cell] > 0.0;
    };
    for (int j = 0; j < grid().ny; ++j) {
        for (int i = 0; i < first; ++i)
            if (overlaps(j * nx + i)) return true;
        for (int i = last + 1; i < nx; ++i)
            if (overlaps(j * nx + i)) return true;
    }
    return false;
}

ContactSolution ComplianceOperator::do_solve(const ContactProblem& problem,
                                             const Eigen::ArrayXd* start) {
    const Receding receding(recession_, problem.recession);
    if (local()) return ConstrainedConjugateGradients(problem, grid(), *this).solve(start);
    const int nx = grid().nx;
    Eigen::ArrayXd pressure;
    if (start != nullptr && start->isFinite().all())
        pressure = (problem.gap.isFinite() && problem.coverage > 0.0).select(start->max(0.0), 0.0);
    int iterations = 0;
    if (pressure.size() == 0 || !(pressure.maxCoeff() > 0.0)) {
        work_on_columns(nx);
        set_surface(problem);
        set_coverage(problem.coverage);
        pressure = ConstrainedConjugateGradients(problem, grid(), *this).first();
        if (by_columns()) {
            // The guess is wide; a rough solution tells better where the contact is.
            const Columns wide = Columns::pressed(grid(), pressure).with_margin(nx);
            const ContactSolution rough = solve_columns(problem, pressure, wide.first, wide.last,
                                                        std::max(kRough, problem.tolerance));
            iterations = rough.iterations;
            if (rough.force > 0.0) pressure = rough.pressure;
        }
    }
    Columns seen{0, nx - 1};
    if (by_columns()) seen = Columns::pressed(grid(), pressure).with_margin(nx);
    ContactSolution solution;
    while (true) {
        solution = solve_columns(problem, pressure, seen.first, seen.last, problem.tolerance);
        solution.iterations = iterations += solution.iterations;
        if (seen.count() == nx || !goes_on_beyond(problem, solution, seen.first, seen.last)) break;
        seen = {0, nx - 1};
        pressure = solution.pressure;
    }
    if (solution.force > 0.0) {
        load_ = problem.coverage * solution.pressure;
        solution.axial = side_displacement(load_);
    }
    clear_surface();
    return solution;
}

}  // namespace beltgrinding

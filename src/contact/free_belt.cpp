#include "contact/free_belt.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "belt_path.h"
#include "belt_plate.h"
#include "belt_spline.h"
#include "block_banded.h"
#include "contact/peak_pressure.h"
#include "surface_under_belt.h"

namespace beltgrinding {
namespace {

constexpr double kInterval = 2.0;     // cells, of the splines across the belt
constexpr double kAtEdge = 1.0;       // cells, the same at its side edges
constexpr double kMargin = 2.0;       // bending lengths beside the contact with fine columns
constexpr double kMarginCells = 5.0;  // the same at least, in cells
constexpr int kMostPaths = 6;         // until the path that is linearised about is the belt's
constexpr int kWarmUp = 2;            // solutions before the belt's stress is followed
constexpr double kFollow = 0.7;       // share of a change of the stress that is taken
constexpr double kSamePath = 0.004;   // rad that a free run may turn from the path's
constexpr int kSearch = 40;           // halvings, for a first guess of the depth

/// The belt over the work on one grid.
class PreparedFreeBelt final : public PreparedContact {
  public:
    PreparedFreeBelt(const ContactGrid& grid, std::string description, const AbrasiveBelt& belt,
                     const BeltRun& run)
        : PreparedContact(grid, std::move(description)),
          belt_(belt),
          run_(run),
          rows_(rows_under_belt(grid, belt.width)),
          spline_(belt.width, getenv("KI")?atof(getenv("KI")):2.0, getenv("KE")?atof(getenv("KE")):1.0),
          plate_(belt_, spline_) {
        for (const BeltRow& row : rows_) locals_.push_back(spline_.at(row.y));
    }

  private:
    using Matrix = Eigen::MatrixXd;
    /// The belt about a path: what it deflects, what pulls it, where it touches.
    struct State {
        BeltPath path;
        BeltGap gap;
        Matrix deflection;       // (splines, columns), mm
        double depth = 0.0;      // mm, what the work has been lifted by
        double pull = 0.0;       // N/mm along the belt
        double lean = 0.0;       // N/mm
        Eigen::ArrayXXd load;    // N a cell of the path, along its normal
        int iterations = 0;
        bool converged = false;
    };

    ContactSolution do_solve(const ContactProblem& problem, const Eigen::ArrayXd* start) override;
    double first_depth(const ContactProblem& problem,
                       const std::vector<RidgePoint>& ridge) const;
    State solve_about(const ContactProblem& problem, BeltPath path, const SurfaceUnderBelt& surface,
                      double depth, const Eigen::ArrayXd* start);
    /// Where the start has pressure; empty: nowhere.
    std::vector<std::uint8_t> pressed(const BeltPath& path, const Eigen::ArrayXd& start) const;
    double deflection_at(const Matrix& c, std::size_t row, int column) const {
        const BeltSpline::Local& b = locals_[row];
        double sum = 0.0;
        for (int r = 0; r < BeltSpline::kLocal; ++r)
            sum += b.value[static_cast<std::size_t>(r)] * c(b.first + r, column);
        return sum;
    }
    /// The pull of a belt that is as long as `elongated` mm more than the path, N/mm.
    double pull_of(const BeltPath& path, double elongated) const;
    ContactSolution on_grid(const ContactProblem& problem, const State& state) const;

    AbrasiveBelt belt_;
    BeltRun run_;
    std::vector<BeltRow> rows_;
    BeltSpline spline_;
    BeltPlate plate_;
    std::vector<BeltSpline::Local> locals_;  // by row
    BlockBanded matrix_;
};

double PreparedFreeBelt::pull_of(const BeltPath& path, double elongated) const {
    if (run_.rollers == BeltRun::Rollers::kTensioned) {
        // Of the roller's carriage, which moves along x.
        return 2.0 * belt_.tension / (std::cos(path.left_angle) + std::cos(path.right_angle));
    }
    const double unloaded = run_.length / (1.0 + belt_.tension / belt_.membrane());
    return belt_.membrane() * (path.length + elongated - unloaded) / unloaded;
}

double PreparedFreeBelt::first_depth(const ContactProblem& problem,
                                     const std::vector<RidgePoint>& ridge) const {
    double highest = -std::numeric_limits<double>::infinity();
    for (const RidgePoint& p : ridge) highest = std::max(highest, p.z);
    if (!std::isfinite(highest)) return 0.0;
    // Of a string over the ridge, whose force rises with the depth.
    BeltPathRequest request;
    request.obstacle = ridge;
    const auto force = [&](double depth) {
        request.lift = depth;
        const BeltPath path = belt_path(run_, request);
        if (path.columns.count() == 0) return 0.0;
        return pull_of(path, 0.0) * belt_.width *
               (std::sin(path.left_angle) + std::sin(path.right_angle));
    };
    double low = -highest, high = low + 0.5 * run_.length;
    for (int k = 0; k < kSearch && high - low > 1e-3; ++k) {
        const double middle = 0.5 * (low + high);
        (force(middle) < problem.force ? low : high) = middle;
    }
    return high;
}

std::vector<std::uint8_t> PreparedFreeBelt::pressed(const BeltPath& path,
                                                    const Eigen::ArrayXd& start) const {
    const std::size_t rows = rows_.size();
    std::vector<std::uint8_t> result(rows * path.x.size(), 0);
    bool any = false;
    for (std::size_t i = 0; i < path.x.size(); ++i) {
        const auto column =
            std::lround(path.x[i] / grid().ds + 0.5 * (grid().nx - 1));
        if (column < 0 || column >= grid().nx) continue;
        for (std::size_t k = 0; k < rows; ++k) {
            const bool here = start[rows_[k].row * grid().nx + column] > 0.0;
            result[i * rows + k] = here ? 1 : 0;
            any = any || here;
        }
    }
    if (!any) result.clear();
    return result;
}

PreparedFreeBelt::State PreparedFreeBelt::solve_about(const ContactProblem& problem, BeltPath path,
                                                      const SurfaceUnderBelt& surface, double depth,
                                                      const Eigen::ArrayXd* start) {
    State state;
    state.path = std::move(path);
    state.depth = depth;
    const BeltColumns& columns = state.path.columns;
    const int n = columns.count(), m = spline_.count();
    state.gap = surface.seen_from(state.path, depth);
    const BeltStress stress(belt_, spline_, state.path);
    Matrix function = Matrix::Zero(BeltStress::kTerms, n);
    state.deflection = Matrix::Zero(m, n);
    state.pull = pull_of(state.path, 0.0);
    if (matrix_.count() != n || matrix_.size() != m) matrix_ = BlockBanded(n, m);

    const auto rows = rows_.size();
    std::vector<std::uint8_t> active;
    if (start != nullptr) active = pressed(state.path, *start);
    const auto cell_of = [rows](int i, std::size_t k) {
        return static_cast<std::size_t>(i) * rows + k;
    };
    if (active.empty()) {
        active.assign(rows * static_cast<std::size_t>(n), 0);
        double deepest = state.gap.reach.maxCoeff();
        static const double kFirstTouch = getenv("FT") ? atof(getenv("FT")) : 0.5;
        if (deepest<0) deepest*=2;
        for (int i = 0; i < n; ++i)
            for (std::size_t k = 0; k < rows; ++k)
                active[cell_of(i, k)] =
                    state.gap.reach(static_cast<Eigen::Index>(k), i) > kFirstTouch * deepest;
    }
    const double face = belt_.face();
    const auto spring = [&](int i, std::size_t k) {
        return face * state.gap.cover(static_cast<Eigen::Index>(k), i) * rows_[k].width *
               columns.width[static_cast<std::size_t>(i)];
    };
    const auto places = static_cast<double>(spline_.places().size());
    (void)places;
    const Eigen::Map<const Eigen::ArrayXd> weights(spline_.weights().data(),
                                                   static_cast<Eigen::Index>(spline_.places().size()));
    const Eigen::Map<const Eigen::ArrayXd> y(spline_.places().data(), weights.size());
    state.load.setZero(static_cast<Eigen::Index>(rows), n);
    double lifted = 0.0;
    Matrix right(static_cast<Eigen::Index>(m) * n, 2);
    for (state.iterations = 1; state.iterations <= problem.max_iterations; ++state.iterations) {
        const BeltForces forces = stress.forces(function, state.pull, state.lean);
        plate_.stiffness(columns, forces, matrix_);
        Matrix load = plate_.path_load(state.path, forces), lift = Matrix::Zero(m, n);
        bool any = false;
        for (int i = 0; i < n; ++i) {
            const double cosine = std::cos(state.path.angle[static_cast<std::size_t>(i)]);
            auto own = matrix_.block(i, 0);
            for (std::size_t k = 0; k < rows; ++k) {
                if (active[cell_of(i, k)] == 0) continue;
                const double reach = state.gap.reach(static_cast<Eigen::Index>(k), i);
                if (!std::isfinite(reach)) continue;
                any = true;
                const BeltSpline::Local& b = locals_[k];
                const double w = spring(i, k);
                for (int r = 0; r < BeltSpline::kLocal; ++r) {
                    const double wr = w * b.value[static_cast<std::size_t>(r)];
                    load(b.first + r, i) += wr * reach;
                    lift(b.first + r, i) += wr * cosine;
                    for (int s = 0; s <= r; ++s)
                        own(b.first + r, b.first + s) += wr * b.value[static_cast<std::size_t>(s)];
                }
            }
        }
        if (!any && problem.force_control) break;
        if (!matrix_.factorise()) {
            // The sides would buckle under a stress that is not yet theirs.
            function *= 0.5;
            continue;
        }
        right.col(0) = Eigen::Map<Eigen::VectorXd>(load.data(), load.size());
        right.col(1) = Eigen::Map<Eigen::VectorXd>(lift.data(), lift.size());
        matrix_.solve(right);
        const Eigen::Map<Matrix> still(right.data(), m, n);
        const Eigen::Map<Matrix> by_lift(right.col(1).data(), m, n);
        if (problem.force_control) {
            double force = 0.0, rise = 0.0;
            for (int i = 0; i < n; ++i) {
                const double cosine = std::cos(state.path.angle[static_cast<std::size_t>(i)]);
                for (std::size_t k = 0; k < rows; ++k) {
                    const double reach = state.gap.reach(static_cast<Eigen::Index>(k), i);
                    if (active[cell_of(i, k)] == 0 || !std::isfinite(reach)) continue;
                    const double w = spring(i, k) * cosine;
                    force += w * (reach - deflection_at(still, k, i));
                    rise += w * (cosine - deflection_at(by_lift, k, i));
                }
            }
            lifted = rise > 0.0 ? (problem.force - force) / rise : 0.0;
        }
        state.deflection = still + lifted * by_lift;

        // Where the belt and the work overlap now, and what that presses with.
        double total = 0.0, change = 0.0;
        bool same = true;
        for (int i = 0; i < n; ++i) {
            const double cosine = std::cos(state.path.angle[static_cast<std::size_t>(i)]);
            for (std::size_t k = 0; k < rows; ++k) {
                const auto row = static_cast<Eigen::Index>(k);
                double overlap = state.gap.reach(row, i);
                if (std::isfinite(overlap))
                    overlap += lifted * cosine - deflection_at(state.deflection, k, i);
                const double now = overlap > 0.0 ? spring(i, k) * overlap : 0.0;
                const std::uint8_t touches = now > 0.0 ? 1 : 0;
                same = same && touches == active[cell_of(i, k)];
                active[cell_of(i, k)] = touches;
                total += now;
                change += std::abs(now - state.load(row, i));
                state.load(row, i) = now;
            }
        }
        // The belt's length and its stress follow.
        const Eigen::ArrayXd longer = stress.elongation(state.deflection);
        const double pull = pull_of(state.path, (weights * longer).sum() / belt_.width);
        const double lean = 6.0 / (belt_.width * belt_.width) * belt_.membrane() / run_.length *
                            (weights * y * longer).sum();
        const double slope = std::max(state.path.left_angle, state.path.right_angle);
        const double gain =
            problem.force_control && run_.rollers == BeltRun::Rollers::kFixed
                ? belt_.membrane() * slope * slope / state.pull
                : 0.0;
        const double pull_change = (pull - state.pull) / (1.0 + gain);
        Matrix wanted = stress.function(state.deflection);
        const double stress_change = (wanted - function).norm() / std::max(wanted.norm(), 1e-300);
        if (getenv("BELTDBG"))
            fprintf(stderr, "  it %d total %.5f change %.2e same %d pull %.4f lean %.4f stress %.2e |F| %.3f lifted %.4f\n",
                    state.iterations, total, change / total, same, pull, lean, stress_change,
                    wanted.norm(), lifted);
        const bool settled =
            std::abs(pull_change) <= problem.tolerance * state.pull &&
            (state.iterations > kWarmUp && change <= problem.tolerance * total && same);
        (void)stress_change;
        if (settled) {
            state.converged = true;
            break;
        }
        state.pull += pull_change;
        state.lean += kFollow * (lean - state.lean);
        function += kFollow * (wanted - function);
    }
    state.depth += lifted;
    return state;
}

ContactSolution PreparedFreeBelt::do_solve(const ContactProblem& problem,
                                           const Eigen::ArrayXd* start) {
    ContactSolution nothing;
    nothing.pressure = Eigen::ArrayXd::Zero(grid().cells());
    nothing.approach = problem.force_control ? 0.0 : problem.approach;
    nothing.converged = !problem.force_control || problem.force == 0.0;
    if (problem.force_control && problem.force == 0.0) return nothing;

    const SurfaceUnderBelt surface(grid(), problem, rows_, belt_.thickness);
    const std::vector<RidgePoint> ridge = surface.ridge();
    double depth = problem.force_control ? first_depth(problem, ridge) : problem.approach;
    double pull = belt_.tension;
    State state;
    int iterations = 0;
    Eigen::ArrayXd last;
    for (int k = 0; k < kMostPaths; ++k) {
        BeltPathRequest request;
        request.obstacle = ridge;
        request.lift = depth;
        request.half = 0.5 * belt_.thickness;
        request.cell = grid().ds;
        request.cells = grid().nx;
        request.bending = std::sqrt(belt_.bending() / pull);
        request.margin = std::max(kMargin * request.bending, kMarginCells * grid().ds);
        BeltPath path = belt_path(run_, request);
        if (path.columns.count() == 0) return nothing;
        state = solve_about(problem, std::move(path), surface, depth,
                            last.size() > 0 ? &last : start);
        iterations += state.iterations;
        const double moved = std::abs(state.depth - depth);
        const double nearest = std::min(-state.path.left, state.path.right);
        depth = state.depth;
        pull = state.pull;
        if (getenv("BELTDBG")) fprintf(stderr, " path %d depth %.4f moved %.4f conv %d\n", k, depth, moved, state.converged);
        if (moved <= kSamePath * nearest) break;
        last = on_grid(problem, state).pressure;
    }
    ContactSolution solution = on_grid(problem, state);
    solution.iterations = iterations;
    solution.converged = state.converged;
    return solution;
}

ContactSolution PreparedFreeBelt::on_grid(const ContactProblem& problem, const State& state) const {
    const BeltPath& path = state.path;
    const int n = path.columns.count(), nx = grid().nx;
    ContactSolution solution;
    solution.pressure = Eigen::ArrayXd::Zero(grid().cells());
    solution.approach = state.depth;
    const double area = grid().cell_area();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        const auto place = [&](int i) {  // x of the belt's face, in columns of the grid
            const auto c = static_cast<std::size_t>(i);
            const double u = deflection_at(state.deflection, k, i);
            return (path.x[c] + (0.5 * belt_.thickness - u) * std::sin(path.angle[c])) / grid().ds +
                   0.5 * nx;
        };
        for (int i = 0; i < n; ++i) {
            if (!(state.load(row, i) > 0.0)) continue;
            // The force along z, shared by the columns of the grid that it lies on.
            const double force =
                state.load(row, i) * std::cos(path.angle[static_cast<std::size_t>(i)]);
            if (const int own = path.cell[static_cast<std::size_t>(i)]; own >= 0) {
                const int cell = rows_[k].row * nx + own;
                if (problem.coverage[cell] > 0.0)
                    solution.pressure[cell] += force / (area * problem.coverage[cell]);
                continue;
            }
            const double here = place(i);
            double from = i > 0 ? 0.5 * (place(i - 1) + here) : here;
            double to = i + 1 < n ? 0.5 * (place(i + 1) + here) : here;
            from = std::clamp(from, 0.0, nx - 1e-9);
            to = std::clamp(to, from + 1e-9, static_cast<double>(nx));
            for (int c = static_cast<int>(from); c < nx && c < to; ++c) {
                const double share = std::min(to, c + 1.0) - std::max(from, static_cast<double>(c));
                const int cell = rows_[k].row * nx + c;
                if (problem.coverage[cell] > 0.0)
                    solution.pressure[cell] +=
                        force * share / (to - from) / (area * problem.coverage[cell]);
            }
        }
    }
    solution.force = (solution.pressure * problem.coverage).sum() * area;
    solution.area = (solution.pressure > 0.0).select(problem.coverage, 0.0).sum() * area;
    solution.peak_pressure = peak_pressure(grid(), solution.pressure, problem.coverage);
    return solution;
}

}  // namespace

FreeBelt::FreeBelt(const AbrasiveBelt& belt, const BeltRun& run) : belt_(belt), run_(run) {
    belt_.validate();
    run_.validate();
}

std::string FreeBelt::describe() const {
    std::ostringstream text;
    text << "free belt, " << belt_.width << " mm wide, " << belt_.thickness << " mm thick, E "
         << belt_.youngs_modulus << " MPa, nu " << belt_.poissons_ratio << ", "
         << belt_.tension << " N/mm over " << run_.length << " mm, rollers "
         << (run_.rollers == BeltRun::Rollers::kFixed ? "fixed" : "tensioned");
    return text.str();
}

std::unique_ptr<PreparedContact> FreeBelt::do_prepare(const ContactGrid& grid) const {
    return std::make_unique<PreparedFreeBelt>(grid, describe(), belt_, run_);
}

}  // namespace beltgrinding

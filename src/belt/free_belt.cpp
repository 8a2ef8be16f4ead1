#include "belt/free_belt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "belt_loads.h"
#include "belt_path.h"
#include "belt_solver.h"
#include "contact/peak_pressure.h"
#include "surface_under_belt.h"

namespace beltgrinding {
namespace {

constexpr double kMargin = 2.0;       // bending lengths beside the contact with fine columns
constexpr double kMarginCells = 5.0;  // the same at least, in cells
constexpr int kMostPaths = 12;        // until the path that is linearised about is the belt's
constexpr double kSamePath = 0.004;   // rad that a free run may turn from the path's
constexpr int kCoarsen = 32;      // cells of a side, of grids that are first solved on half as many
constexpr double kRough = 0.02;   // tolerance there
constexpr double kDeepest = 1.0;  // runs' lengths that a force may press the belt in
constexpr int kSearch = 40;       // halvings, for a first guess of the depth

/// mm at which the flat belt touches the ridge; infinite: never.
double first_touch(const std::vector<RidgePoint>& ridge) {
    double touch = std::numeric_limits<double>::infinity();
    for (const RidgePoint& p : ridge) touch = std::min(touch, -p.z);
    return touch;
}

/// How the depth follows the lift from path to path: one may press more, the next one less, and it
/// goes towards what is between them.
class Following {
  public:
    double step(double lift) {
        if (lift * last_ < 0.0 && std::abs(lift) > 0.5 * std::abs(last_)) part_ *= 0.5;
        last_ = lift;
        return part_ * lift;
    }

  private:
    double last_ = 0.0, part_ = 1.0;
};

/// The belt over the work on one grid.
class PreparedFreeBelt final : public PreparedContact {
  public:
    PreparedFreeBelt(const ContactGrid& grid, const std::string& description,
                     const AbrasiveBelt& belt, const BeltRun& run)
        : PreparedContact(grid, description),
          belt_(belt),
          run_(run),
          solver_(belt, run, grid, BeltSolver::Sheet::kThin) {
        if (std::min(grid.nx, grid.ny) < kCoarsen) return;
        const ContactGrid half{(grid.nx + 1) / 2, (grid.ny + 1) / 2, 2.0 * grid.ds, 2.0 * grid.dy};
        coarse_ = std::make_unique<PreparedFreeBelt>(half, description, belt, run);
    }

    std::shared_ptr<const ContactMemory> memory() const override {
        return std::make_shared<const Memory>(last_);
    }
    void remember(const std::shared_ptr<const ContactMemory>& memory) override {
        if (const auto* last = dynamic_cast<const Memory*>(memory.get())) last_ = last->last;
    }

  private:
    ContactSolution do_solve(const ContactProblem& problem, const Eigen::ArrayXd* start) override;
    /// mm at which a string over the ridge presses with the force.
    double first_depth(const ContactProblem& problem, const std::vector<RidgePoint>& ridge) const;
    /// mm that the work is first lifted by.
    double start_depth(const ContactProblem& problem, const std::vector<RidgePoint>& ridge,
                       bool warm) const;
    /// The path of the belt over the ridge at `depth`, which changes where the belt does not reach
    /// it there; empty: nowhere. `first`: the depth is a guess.
    std::optional<BeltPath> path_over(const ContactProblem& problem,
                                      const std::vector<RidgePoint>& ridge, double pull, bool first,
                                      double& depth) const;
    BeltPathRequest path_request(const std::vector<RidgePoint>& ridge, double depth,
                                 double pull) const;
    ContactSolution on_grid(const ContactProblem& problem, const BeltState& state,
                            double depth) const;
    /// The cell of `coarse_` that a cell lies in.
    int coarse_cell(int cell) const;
    /// A solution on the coarse grid, to start from.
    Eigen::ArrayXd rough(const ContactProblem& problem, double& depth);

    AbrasiveBelt belt_;
    BeltRun run_;
    BeltSolver solver_;
    std::unique_ptr<PreparedFreeBelt> coarse_;
    // Of the last solution: its stress, for one that starts from its pressure.
    struct Last {
        Eigen::ArrayXd pressure;
        BeltState state;
        double depth = 0.0;
    } last_;
    struct Memory final : ContactMemory {
        explicit Memory(const Last& given) : last(given) {}
        std::size_t bytes() const override {
            return static_cast<std::size_t>(last.pressure.size()) * sizeof(double) +
                   last.state.bytes();
        }
        Last last;
    };
};

int PreparedFreeBelt::coarse_cell(int cell) const {
    const ContactGrid& to = coarse_->grid();
    const auto at = [](double place, int cells, double size) {
        return std::clamp(static_cast<int>(std::floor(place / size + 0.5 * cells)), 0, cells - 1);
    };
    return at(grid().y(cell / grid().nx), to.ny, to.dy) * to.nx +
           at(grid().s(cell % grid().nx), to.nx, to.ds);
}

Eigen::ArrayXd PreparedFreeBelt::rough(const ContactProblem& problem, double& depth) {
    const int cells = coarse_->grid().cells();
    ContactProblem half = problem;
    half.gap = Eigen::ArrayXd::Zero(cells);
    half.coverage = Eigen::ArrayXd::Zero(cells);
    half.drop.resize(0);
    half.tolerance = std::max(problem.tolerance, kRough);
    Eigen::ArrayXd count = Eigen::ArrayXd::Zero(cells);
    for (int c = 0; c < grid().cells(); ++c) {
        const int to = coarse_cell(c);
        count[to] += 1.0;
        if (!std::isfinite(problem.gap[c])) continue;
        half.gap[to] += problem.coverage[c] * problem.gap[c];
        half.coverage[to] += problem.coverage[c];
    }
    half.gap =
        (half.coverage > 0.0)
            .select(half.gap / half.coverage.max(1e-300), std::numeric_limits<double>::infinity());
    half.coverage /= count.max(1.0);
    const ContactSolution solution = coarse_->solve(half);
    if (solution.force > 0.0 && BeltSolver::yields(problem)) depth = solution.approach;
    Eigen::ArrayXd start(grid().cells());
    for (int c = 0; c < grid().cells(); ++c) start[c] = solution.pressure[coarse_cell(c)];
    return start;
}

double PreparedFreeBelt::first_depth(const ContactProblem& problem,
                                     const std::vector<RidgePoint>& ridge) const {
    const double touch = first_touch(ridge);
    if (!std::isfinite(touch)) return 0.0;
    // Of a string over the ridge, whose force rises with the depth.
    BeltPathRequest request;
    request.obstacle = ridge;
    const auto force = [&](double depth) {
        request.lift = depth;
        const BeltPath path = belt_path(run_, request);
        if (path.columns.count() == 0) return 0.0;
        return solver_.pull_of(path, 0.0) * belt_.width *
               (std::sin(path.left_angle) + std::sin(path.right_angle));
    };
    double low = touch, high = low + 0.5 * run_.length;
    for (int k = 0; k < kSearch && high - low > 1e-3; ++k) {
        const double middle = 0.5 * (low + high);
        (force(middle) < problem.force ? low : high) = middle;
    }
    return high;
}

double PreparedFreeBelt::start_depth(const ContactProblem& problem,
                                     const std::vector<RidgePoint>& ridge, bool warm) const {
    if (warm && BeltSolver::yields(problem)) return last_.depth;
    return problem.force_control ? first_depth(problem, ridge) : problem.approach;
}

std::optional<BeltPath> PreparedFreeBelt::path_over(const ContactProblem& problem,
                                                    const std::vector<RidgePoint>& ridge,
                                                    double pull, bool first, double& depth) const {
    BeltPath path = belt_path(run_, path_request(ridge, depth, pull));
    if (path.columns.count() > 0) return path;
    if (problem.force_control) {
        if (!std::isfinite(first_touch(ridge))) return std::nullopt;
        if (first) depth = first_depth(problem, ridge);
    } else {
        if (depth >= problem.approach) return std::nullopt;
        depth = problem.approach;  // where a robot that gave way stands without the work
    }
    path = belt_path(run_, path_request(ridge, depth, pull));
    // A part may touch beside the ridge before a string does.
    if (path.columns.count() == 0 && problem.force_control)
        path = straight_path(run_, grid().ds, grid().nx);
    if (path.columns.count() == 0) return std::nullopt;
    return path;
}

ContactSolution PreparedFreeBelt::do_solve(const ContactProblem& problem,
                                           const Eigen::ArrayXd* start) {
    ContactSolution nothing;
    nothing.pressure = Eigen::ArrayXd::Zero(grid().cells());
    nothing.approach = problem.force_control ? 0.0 : problem.approach;
    nothing.converged = !problem.force_control || problem.force == 0.0;
    if (problem.force_control && problem.force == 0.0) return nothing;

    const SurfaceUnderBelt surface(grid(), problem, solver_.rows(), belt_.thickness);
    const std::vector<RidgePoint> ridge = surface.ridge();
    const bool warm = start != nullptr && last_.pressure.size() == start->size() &&
                      (*start == last_.pressure).all();
    double depth = start_depth(problem, ridge, warm);
    double pull = warm ? last_.state.pull : belt_.tension;
    Eigen::ArrayXd guess;
    if (start != nullptr && (*start > 0.0).any())
        guess = *start;
    else if (coarse_)
        guess = rough(problem, depth);
    BeltState state, before;
    if (warm) before = std::move(last_.state);
    last_.pressure.resize(0);
    int iterations = 0;
    Following following;
    const double deepest = problem.force_control ? first_touch(ridge) + kDeepest * run_.length
                                                 : std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
        std::optional<BeltPath> path = path_over(problem, ridge, pull, k == 0, depth);
        if (!path) return nothing;
        const BeltGap gap = surface.seen_from(*path, depth);
        BeltSolver::Request request;
        request.problem = &problem;
        request.gap = &gap;
        request.depth = depth;
        if (guess.size() > 0) request.touching = pressed_columns(solver_, grid(), *path, guess);
        if (before.deflection.size() > 0) request.before = &before;
        state = solver_.solve(std::move(*path), std::move(request));
        iterations += state.iterations;
        const double nearest = std::min(-state.path.left, state.path.right);
        pull = state.pull;
        const bool same = std::abs(state.lift) <= kSamePath * nearest;
        const bool gave_up = !state.converged && state.iterations >= problem.max_iterations;
        if (same || k + 1 == kMostPaths || gave_up) {
            depth += state.lift;
            state.converged = state.converged && same;
            break;
        }
        // A force that the belt cannot bear: it would be pressed in for ever.
        if (problem.force_control && depth == deepest && state.lift > 0.0) return nothing;
        depth = std::min(depth + following.step(state.lift), deepest);
        guess = on_grid(problem, state, depth).pressure;
        before = std::move(state);
    }
    ContactSolution solution = on_grid(problem, state, depth);
    solution.iterations = iterations;
    solution.converged = state.converged;
    last_ = {solution.pressure, std::move(state), depth};
    return solution;
}

BeltPathRequest PreparedFreeBelt::path_request(const std::vector<RidgePoint>& ridge, double depth,
                                               double pull) const {
    BeltPathRequest request;
    request.obstacle = ridge;
    request.lift = depth;
    request.half = 0.5 * belt_.thickness;
    request.cell = grid().ds;
    request.cells = grid().nx;
    request.halves = coarse_ != nullptr;
    request.bending = std::sqrt(belt_.bending() / pull);
    request.margin = std::max(kMargin * request.bending, kMarginCells * grid().ds);
    return request;
}

ContactSolution PreparedFreeBelt::on_grid(const ContactProblem& problem, const BeltState& state,
                                          double depth) const {
    ContactSolution solution;
    solution.pressure = pressure_on_grid(solver_, grid(), problem.coverage, belt_.thickness, state);
    solution.approach = depth;
    const double area = grid().cell_area();
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
         << belt_.youngs_modulus << " MPa, nu " << belt_.poissons_ratio << ", " << belt_.tension
         << " N/mm over " << run_.length << " mm, rollers "
         << (run_.rollers == BeltRun::Rollers::kFixed ? "fixed" : "tensioned");
    return text.str();
}

std::unique_ptr<PreparedContact> FreeBelt::do_prepare(const ContactGrid& grid) const {
    return std::make_unique<PreparedFreeBelt>(grid, describe(), belt_, run_);
}

}  // namespace beltgrinding

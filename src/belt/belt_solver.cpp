#include "belt_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beltgrinding {
namespace {

constexpr double kInterval = 2.0;   // mm, or cells of 1 mm or more: of the splines across the belt
constexpr double kAtEdge = 1.0;     // the same at its side edges
constexpr double kOnLayers = 0.75;  // of these where layers bear the belt: pressure is less even
// The face of an elastic layer of thickness t that bends under waves of wavenumber k on one face
// deflects by q / (D k^4) (1 + k^2 t^2 / 5 + ...), exactly; half of it where the face is and half
// where its load acts keep the stiffness symmetric, and are that within 5 % up to k t = 4.
constexpr double kThick = 0.2;
// Of that, on a free belt: where a wrap ends, finite elements lie between a thin sheet and a thick
// one. A fit to five of them, not a theory (docs/belt-method.md).
constexpr double kFree = 0.25;
constexpr double kUnbalanced = 0.3;  // of the tolerance: forces that are left
constexpr double kRough = 0.02;      // tolerance where only the rows that bear are asked for
constexpr double kStuck = 1e-3;      // of a step
constexpr double kTouch = 1e-3;      // mm that the work is lifted into the belt, to begin with
constexpr double kGoodStep = 0.1;    // of the forces that were left over: less after a good step
constexpr double kNoForce = 1e-6;    // N
// Of what the backing bears: its layers are computed in single precision, and a belt that hardly
// touches the work could never be nearer its balance than that.
constexpr double kSingle = 3e-7;

double closer(BeltSolver::Sheet sheet) {
    return sheet == BeltSolver::Sheet::kThick ? kOnLayers : 1.0;
}

/// Springs stay as they are, or little is left: the backing is worth following.
bool settled(const BeltUnbalanced& off, double tolerance) {
    return (off.borne.same && off.borne.borne) ||
           off.left() <= kUnbalanced * tolerance * off.borne.total;
}

bool balanced(const BeltUnbalanced& off, double tolerance) {
    return off.left() <= std::max({kUnbalanced * tolerance * off.borne.total, kNoForce,
                                   kSingle * off.borne.behind});
}

}  // namespace

std::size_t BeltState::bytes() const {
    constexpr std::size_t kOfPath = 8;  // numbers a column
    const auto numbers = static_cast<std::size_t>(deflection.size() + load.size());
    return (numbers + kOfPath * path.x.size()) * sizeof(double);
}

BeltSolver::BeltSolver(const AbrasiveBelt& belt, const BeltRun& run, const ContactGrid& grid,
                       Sheet sheet)
    : belt_(belt),
      run_(run),
      shear_((sheet == Sheet::kThick ? 1.0 : kFree) * 0.5 * kThick * belt.thickness *
             belt.thickness),
      rows_(rows_under_belt(grid, belt.width)),
      basis_(belt_, rows_, shear_,
             BeltSpline(belt.width, kInterval * closer(sheet) * std::max(1.0, grid.dy),
                        kAtEdge * closer(sheet) * std::max(1.0, grid.dy))),
      support_(rows_, {belt.face(), belt.thickness, shear_}) {}

double BeltSolver::pull_of(const BeltPath& path, double elongated) const {
    if (run_.rollers == BeltRun::Rollers::kTensioned) {
        // Of the roller's carriage, which moves along x.
        return 2.0 * belt_.tension / (std::cos(path.left_angle) + std::cos(path.right_angle));
    }
    const double unloaded = run_.length / (1.0 + belt_.tension / belt_.membrane());
    return belt_.membrane() * (path.length + elongated - unloaded) / unloaded;
}

BeltIterate BeltSolver::start(const Request& request, const BeltPath& path) const {
    const BeltColumns& columns = path.columns;
    const int n = columns.count(), m = basis_.finest().spline.count();
    BeltIterate at;
    at.lift = request.lift;
    at.deflection.setZero(m, n);
    if (request.before != nullptr && request.before->deflection.rows() == m &&
        request.before->deflection.cols() > 1) {
        // Between the columns that were there.
        const BeltState& before = *request.before;
        const std::vector<double>& x = before.path.x;
        for (int i = 0; i < n; ++i) {
            const double here = path.x[static_cast<std::size_t>(i)];
            const auto after =
                std::clamp<std::ptrdiff_t>(std::lower_bound(x.begin(), x.end(), here) - x.begin(),
                                           1, static_cast<std::ptrdiff_t>(x.size()) - 1);
            const auto k = static_cast<std::size_t>(after);
            const double t = std::clamp((here - x[k - 1]) / (x[k] - x[k - 1]), 0.0, 1.0);
            at.deflection.col(i) =
                (1.0 - t) * before.deflection.col(after - 1) + t * before.deflection.col(after);
        }
    }
    at.deflection = basis_.from_finest(std::move(at.deflection));
    at.cells = basis_.across().face.deflection(columns, at.deflection);
    return at;
}

BeltState BeltSolver::solve_roughly(BeltPath path, const Request& request) {
    ContactProblem problem = *request.problem;
    problem.tolerance = std::max(problem.tolerance, kRough);
    Request rough = request;
    rough.problem = &problem;
    const std::vector<double>& finest = basis_.finest().spline.lines();
    std::vector<double> lines;
    for (std::size_t k = 0; k < finest.size(); k += 2) lines.push_back(finest[k]);
    lines.back() = finest.back();
    basis_.use(lines);
    return solve_on(std::move(path), rough);
}

BeltState BeltSolver::solve(BeltPath path, Request request) {
    BeltState state, before;
    int iterations = 0;
    const auto from_there = [&] {
        before = std::move(state);
        request.before = &before;
        request.lift = before.lift;
        return before.path;
    };
    support_.expect(std::move(request.touching));
    if (request.backing != nullptr && !support_.touches()) {
        state = solve_roughly(std::move(path), request);
        iterations = state.iterations;
        path = from_there();
    }
    std::vector<std::uint8_t> rows = support_.rows_touched();
    if (!support_.touches()) rows.assign(rows_.size(), 1);
    for (bool again = false;; again = true) {
        const BeltKnots knots(basis_.finest().spline, rows_, rows);
        basis_.use(knots.lines());
        state = solve_on(std::move(path), request);
        iterations += state.iterations;
        const std::vector<std::uint8_t> now = support_.rows_touched();
        if (knots.covers(rows_, now)) break;
        // Pressure where it was not expected: once more, from there; then by all knots.
        for (std::size_t k = 0; k < rows.size(); ++k)
            rows[k] = again || rows[k] != 0 || now[k] != 0 ? 1 : 0;
        path = from_there();
    }
    state.iterations = iterations;
    return state;
}

bool BeltSolver::touch(BeltIterate& at) const {
    const double least = support_.short_of_touch(at.cells, at.lift);
    if (!std::isfinite(least)) return false;
    at.lift += least + kTouch;
    return true;
}

BeltState BeltSolver::solve_on(BeltPath path, const Request& request) {
    BeltState state;
    state.path = std::move(path);
    const double unloaded = run_.length / (1.0 + belt_.tension / belt_.membrane());
    const double stretching =
        run_.rollers == BeltRun::Rollers::kFixed ? belt_.membrane() / unloaded : 0.0;
    basis_.prepare(state.path.columns);
    const BeltStress stress(belt_, basis_.across().terms, state.path, basis_.compliance(),
                            pull_of(state.path, 0.0), stretching, run_.length);
    const BeltDrive drive{*request.problem, request.depth};
    BeltEnergy energy(basis_, support_, stress, state.path, drive);
    BeltIterate at = start(request, state.path);
    support_.set(state.path, *request.gap, request.problem->recession, request.backing,
                 request.before != nullptr ? &at.cells : nullptr);
    energy.complete(at);
    descend(energy, at, state);
    state.load = support_.load(at.cells, at.lift);
    state.pull = stress.pull(at.stress);
    state.lift = at.lift;
    state.deflection = basis_.to_finest(std::move(at.deflection));
    return state;
}

void BeltSolver::descend(BeltEnergy& energy, BeltIterate& at, BeltState& state) {
    const ContactProblem& problem = energy.drive().problem;
    // Without a place to begin with, from the first touch.
    bool bonded = support_.touches();
    double share = 0.0, before = 0.0, most = 1.0;
    BeltUnbalanced off = energy.unbalanced(at, bonded);
    for (state.iterations = 0;; ++state.iterations) {
        problem.context.throw_if_cancelled();
        const bool first = state.iterations == 0, whole = !first && share == 1.0;
        bool good = whole && off.left() <= kGoodStep * before;
        double bears = 0.0;
        if (whole && support_.backed() && settled(off, problem.tolerance)) {
            bears = support_.follow(at.cells);
            off = energy.unbalanced(at, false);
        }
        state.converged = !first && balanced(off, problem.tolerance) && bears <= problem.tolerance;
        if (state.converged || state.iterations >= problem.max_iterations) break;
        if (problem.force_control && off.borne.total == 0.0 && !bonded) {
            if (!touch(at)) break;
            off = energy.unbalanced(at, false);
            good = false;
        }
        // The last factor is as good where its step was and few springs have switched.
        const bool again = good && factor_.serves(support_);
        before = off.left();
        if (!again && !factor_.factorise(energy, basis_, support_, at, most)) break;
        const BeltStep to = factor_.step(energy, basis_, support_, off, again);
        if (!to.deflection.allFinite() || !std::isfinite(to.lift)) break;
        share = energy.go(to, bonded, at, off);
        bonded = false;
        // A step that leads nowhere: once more, by what is surely a valley; then there is no way.
        const bool stuck = share < kStuck;
        if (stuck && most == 0.0) break;
        most = stuck ? 0.0 : 1.0;
    }
}

}  // namespace beltgrinding

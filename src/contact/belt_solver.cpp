#include "belt_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace beltgrinding {
namespace {

constexpr double kInterval = 2.0;  // mm, or cells of 1 mm or more: of the splines across the belt
constexpr double kAtEdge = 1.0;    // the same at its side edges
constexpr int kWarmUp = 2;         // solutions before it may have converged, the stress being new
constexpr double kFollow = 0.7;    // share of a change of the stress that is taken
// The face of an elastic layer of thickness t that bends under waves of wavenumber k on one face
// deflects by q / (D k^4) (1 + k^2 t^2 / 5 + ...), exactly; half of it where the face is and half
// where its load acts keep the stiffness symmetric, and are that within 5 % up to k t = 4.
constexpr double kThick = 0.2;
constexpr double kPatience = 30.0;         // iterations after which half as much is taken
constexpr int kHalvings = 8;               // of the way to the next state, for the least energy
constexpr double kLeastStep = 1.0 / 64.0;  // of that way
constexpr double kLessStress = 0.5;        // of a stress under which the sides would buckle

}  // namespace

std::size_t BeltState::bytes() const {
    constexpr std::size_t kOfPath = 8;  // numbers a column
    const auto numbers =
        static_cast<std::size_t>(deflection.size() + function.size() + load.size());
    return (numbers + kOfPath * path.x.size()) * sizeof(double);
}

BeltSolver::BeltSolver(const AbrasiveBelt& belt, const BeltRun& run, const ContactGrid& grid,
                       Sheet sheet)
    : belt_(belt),
      run_(run),
      face_(belt.face()),
      shear_(sheet == Sheet::kThick ? 0.5 * kThick * belt.thickness * belt.thickness : 0.0),
      rows_(rows_under_belt(grid, belt.width)),
      spline_(belt.width, kInterval * std::max(1.0, grid.dy), kAtEdge * std::max(1.0, grid.dy)),
      plate_(belt_, spline_) {
    for (const BeltRow& row : rows_) locals_.push_back(spline_.at(row.y));
}

double BeltSolver::pull_of(const BeltPath& path, double elongated) const {
    if (run_.rollers == BeltRun::Rollers::kTensioned) {
        // Of the roller's carriage, which moves along x.
        return 2.0 * belt_.tension / (std::cos(path.left_angle) + std::cos(path.right_angle));
    }
    const double unloaded = run_.length / (1.0 + belt_.tension / belt_.membrane());
    return belt_.membrane() * (path.length + elongated - unloaded) / unloaded;
}

double BeltSolver::deflection_at(const BeltColumns& columns, const Eigen::MatrixXd& coefficients,
                                 std::size_t row, int column) const {
    const BeltSpline::Local& b = locals_[row];
    const std::array<double, 3> along = columns.curvature(column);
    double sum = 0.0;
    for (std::size_t r = 0; r < BeltSpline::kLocal; ++r) {
        const int at = b.first + static_cast<int>(r);
        double curved = along[1] * coefficients(at, column);
        if (along[1] != 0.0)
            curved +=
                along[0] * coefficients(at, column - 1) + along[2] * coefficients(at, column + 1);
        sum += (b.value[r] - shear_ * b.curvature[r]) * coefficients(at, column) -
               shear_ * b.value[r] * curved;
    }
    return sum;
}

void BeltSolver::assemble(const Request& request, const BeltState& state,
                          const BeltForces& forces) {
    const BeltColumns& columns = state.path.columns;
    const int n = columns.count(), m = spline_.count();
    if (matrix_.count() != n || matrix_.size() != m) matrix_ = BlockBanded(n, m);
    plate_.stiffness(columns, forces, matrix_);
    right_.setZero(static_cast<Eigen::Index>(m) * n, 2);
    Eigen::Map<Eigen::MatrixXd> load(right_.data(), m, n), lift(right_.col(1).data(), m, n);
    load = plate_.path_load(state.path, forces);
    for (int i = 0; i < n; ++i) {
        const double cosine = std::cos(state.path.angle[static_cast<std::size_t>(i)]);
        const std::array<double, 3> along = columns.curvature(i);
        // The face's deflection is of three columns.
        const int first = along[1] != 0.0 ? 0 : 1, last = along[1] != 0.0 ? 2 : 1;
        const auto add = [&](std::size_t k, double w, double place, double rise) {
            const BeltSpline::Local& b = locals_[k];
            std::array<std::array<double, BeltSpline::kLocal>, 3> v{};
            for (std::size_t p = 0; p < 3; ++p)
                for (std::size_t r = 0; r < BeltSpline::kLocal; ++r)
                    v[p][r] = (p == 1 ? b.value[r] - shear_ * b.curvature[r] : 0.0) -
                              shear_ * along[p] * b.value[r];
            for (int q = first; q <= last; ++q) {
                const auto& vq = v[static_cast<std::size_t>(q)];
                for (int r = 0; r < BeltSpline::kLocal; ++r) {
                    const double wr = w * vq[static_cast<std::size_t>(r)];
                    load(b.first + r, i - 1 + q) += wr * place;
                    lift(b.first + r, i - 1 + q) += wr * rise;
                }
                for (int p = q; p <= last; ++p) {
                    const auto& vp = v[static_cast<std::size_t>(p)];
                    auto to = matrix_.block(i - 1 + q, p - q);
                    for (int c = 0; c < BeltSpline::kLocal; ++c)
                        for (int r = 0; r < BeltSpline::kLocal; ++r)
                            to(b.first + r, b.first + c) += w * vp[static_cast<std::size_t>(r)] *
                                                            vq[static_cast<std::size_t>(c)];
                }
            }
        };
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            if (request.touching[cell(i, k)] != 0)
                add(k, spring(request, columns, i, k), reach_at(request, state.path, i, k), cosine);
            if (request.backing != nullptr && borne_[cell(i, k)] != 0)
                add(k,
                    request.backing->stiffness() * rows_[k].width *
                        columns.width[static_cast<std::size_t>(i)],
                    request.backing->rest()(row, i), 0.0);
        }
    }
}

double BeltSolver::commanded(const Request& request, double lift) {
    const ContactProblem& problem = *request.problem;
    if (problem.force_control) return problem.force;
    return (problem.approach - request.depth - lift) / problem.robot_compliance;
}

double BeltSolver::lift_for(const Request& request, const BeltState& state) const {
    const BeltColumns& columns = state.path.columns;
    const int n = columns.count(), m = spline_.count();
    const Eigen::MatrixXd still = Eigen::Map<const Eigen::MatrixXd>(right_.data(), m, n);
    const Eigen::MatrixXd by_lift = Eigen::Map<const Eigen::MatrixXd>(right_.col(1).data(), m, n);
    double force = 0.0, rise = 0.0;
    for (int i = 0; i < n; ++i) {
        const double cosine = std::cos(state.path.angle[static_cast<std::size_t>(i)]);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (request.touching[cell(i, k)] == 0) continue;
            const double w = spring(request, columns, i, k) * cosine;
            force +=
                w * (reach_at(request, state.path, i, k) - deflection_at(columns, still, k, i));
            rise += w * (cosine - deflection_at(columns, by_lift, k, i));
        }
    }
    const ContactProblem& problem = *request.problem;
    if (!problem.force_control) rise += 1.0 / problem.robot_compliance;
    return rise > 0.0 ? (commanded(request, 0.0) - force) / rise : 0.0;
}

double BeltSolver::work_force(const Request& request, const BeltPath& path, int i, std::size_t k,
                              double deflection, double lift) const {
    const double reach = reach_at(request, path, i, k);
    if (!std::isfinite(reach)) return 0.0;
    const double overlap =
        reach + lift * std::cos(path.angle[static_cast<std::size_t>(i)]) - deflection;
    return overlap > 0.0 ? spring(request, path.columns, i, k) * overlap : 0.0;
}

double BeltSolver::backing_force(const Request& request, const BeltPath& path, int i, std::size_t k,
                                 double deflection) const {
    if (request.backing == nullptr) return 0.0;
    const double in = deflection - request.backing->rest()(static_cast<Eigen::Index>(k), i);
    if (!(in > 0.0)) return 0.0;
    return in * request.backing->stiffness() * rows_[k].width *
           path.columns.width[static_cast<std::size_t>(i)];
}

BeltSolver::Cells BeltSolver::solved(const Request& request, const BeltState& state,
                                     double lift) const {
    const BeltPath& path = state.path;
    const int n = path.columns.count(), m = spline_.count();
    const Eigen::MatrixXd c = Eigen::Map<const Eigen::MatrixXd>(right_.data(), m, n) +
                              lift * Eigen::Map<const Eigen::MatrixXd>(right_.col(1).data(), m, n);
    Cells cells;
    cells.raised = lift;
    cells.deflection.resize(static_cast<Eigen::Index>(rows_.size()), n);
    cells.force.setZero(cells.deflection.rows(), n);
    for (int i = 0; i < n; ++i) {
        const double cosine = std::cos(path.angle[static_cast<std::size_t>(i)]);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const double u = cells.deflection(row, i) = deflection_at(path.columns, c, k, i);
            double& force = cells.force(row, i);
            if (request.touching[cell(i, k)] != 0)
                force += spring(request, path.columns, i, k) *
                         (reach_at(request, path, i, k) + lift * cosine - u);
            if (request.backing != nullptr && borne_[cell(i, k)] != 0)
                force -= request.backing->stiffness() * rows_[k].width *
                         path.columns.width[static_cast<std::size_t>(i)] *
                         (u - request.backing->rest()(row, i));
        }
    }
    return cells;
}

double BeltSolver::slope(const Request& request, const BeltPath& path, const Cells& from,
                         const Cells& to, double share) const {
    const double lift = std::lerp(from.raised, to.raised, share);
    const double rises = to.raised - from.raised;
    double sum = yields(*request.problem) ? -rises * commanded(request, lift) : 0.0;
    for (int i = 0; i < path.columns.count(); ++i) {
        const double cosine = std::cos(path.angle[static_cast<std::size_t>(i)]);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const double u = from.deflection(row, i), step = to.deflection(row, i) - u;
            // What the sheet itself resists with is linear on the way.
            const double held = std::lerp(from.force(row, i), to.force(row, i), share);
            const double work = work_force(request, path, i, k, u + share * step, lift);
            sum += step * (held - work + backing_force(request, path, i, k, u + share * step)) +
                   rises * cosine * work;
        }
    }
    return sum;
}

double BeltSolver::least_energy(const Request& request, const BeltPath& path, const Cells& from,
                                const Cells& to) const {
    // The energy is convex.
    if (slope(request, path, from, to, 1.0) <= 0.0) return 1.0;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (slope(request, path, from, to, middle) > 0.0 ? high : low) = middle;
    }
    return std::max(low, kLeastStep);
}

BeltSolver::Sums BeltSolver::touch(Request& request, BeltState& state, const Cells& cells) {
    Sums sums;
    for (int i = 0; i < state.path.columns.count(); ++i) {
        const double cosine = std::cos(state.path.angle[static_cast<std::size_t>(i)]);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const double u = cells.deflection(row, i);
            const double now = work_force(request, state.path, i, k, u, state.lift);
            const std::uint8_t touches = now > 0.0 ? 1 : 0;
            sums.same = sums.same && touches == request.touching[cell(i, k)];
            request.touching[cell(i, k)] = touches;
            sums.total += now;
            sums.along_z += now * cosine;
            sums.change += std::abs(now - state.load(row, i));
            state.load(row, i) = now;
            if (request.backing == nullptr) continue;
            const std::uint8_t borne = backing_force(request, state.path, i, k, u) > 0.0 ? 1 : 0;
            sums.same = sums.same && borne == borne_[cell(i, k)];
            borne_[cell(i, k)] = borne;
        }
    }
    return sums;
}

double BeltSolver::follow_length(const Request& request, BeltState& state,
                                 const BeltStress& stress) const {
    const auto places = static_cast<Eigen::Index>(spline_.places().size());
    const Eigen::Map<const Eigen::ArrayXd> weights(spline_.weights().data(), places);
    const Eigen::Map<const Eigen::ArrayXd> y(spline_.places().data(), places);
    const Eigen::ArrayXd longer = stress.elongation(state.deflection);
    const double pull = pull_of(state.path, (weights * longer).sum() / belt_.width);
    const double lean = 6.0 / (belt_.width * belt_.width) * belt_.membrane() / run_.length *
                        (weights * y * longer).sum();
    // Under a given force, a larger pull lets the belt in less, which makes it shorter.
    const double slope = std::max(state.path.left_angle, state.path.right_angle);
    const bool stretches = run_.rollers == BeltRun::Rollers::kFixed;
    const double gain =
        yields(*request.problem) && stretches ? belt_.membrane() * slope * slope / state.pull : 0.0;
    const double change = (pull - state.pull) / (1.0 + gain);
    state.pull += change;
    state.lean += kFollow * (lean - state.lean);
    return change;
}

BeltState BeltSolver::solve(BeltPath path, Request request) {
    BeltState state;
    state.path = std::move(path);
    const ContactProblem& problem = *request.problem;
    const BeltColumns& columns = state.path.columns;
    const int n = columns.count(), m = spline_.count();
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    const BeltStress stress(belt_, spline_, state.path);
    state.deflection = Eigen::MatrixXd::Zero(m, n);
    const bool follows = request.before != nullptr &&
                         request.before->path.cell == state.path.cell &&
                         request.before->function.cols() == n;
    if (follows) {
        state.function = request.before->function;
        state.pull = request.before->pull;
        state.lean = request.before->lean;
        state.load = request.before->load;
    } else {
        state.function = Eigen::MatrixXd::Zero(BeltStress::kTerms, n);
        state.pull = pull_of(state.path, 0.0);
        state.load.setZero(rows, n);
    }
    const std::size_t all = rows_.size() * static_cast<std::size_t>(n);
    if (request.touching.size() != all) {
        request.touching.assign(all, 0);
        // What the path's rounded corners lie in; else what is nearest to it.
        const double deepest = request.gap->reach.maxCoeff();
        const double least = deepest > 0.0 ? 0.5 * deepest : deepest - belt_.thickness;
        for (int i = 0; i < n; ++i)
            for (std::size_t k = 0; k < rows_.size(); ++k)
                request.touching[cell(i, k)] =
                    request.gap->reach(static_cast<Eigen::Index>(k), i) > least ? 1 : 0;
    }
    for (int i = 0; i < n; ++i)
        for (std::size_t k = 0; k < rows_.size(); ++k)
            if (!std::isfinite(request.gap->reach(static_cast<Eigen::Index>(k), i)))
                request.touching[cell(i, k)] = 0;
    if (request.backing != nullptr) {
        borne_.assign(all, 0);
        for (int i = 0; i < n; ++i)
            for (std::size_t k = 0; k < rows_.size(); ++k)
                borne_[cell(i, k)] =
                    std::isfinite(request.backing->rest()(static_cast<Eigen::Index>(k), i)) ? 1 : 0;
    }

    Cells cells;
    for (state.iterations = 1; state.iterations <= problem.max_iterations; ++state.iterations) {
        if (problem.force_control && std::find(request.touching.begin(), request.touching.end(),
                                               1) == request.touching.end())
            break;
        const BeltForces forces = stress.forces(state.function, state.pull, state.lean);
        assemble(request, state, forces);
        if (!matrix_.factorise()) {
            state.function *= kLessStress;
            continue;
        }
        matrix_.solve(right_);
        Cells now = solved(request, state, yields(problem) ? lift_for(request, state) : 0.0);
        const Eigen::MatrixXd whole =
            Eigen::Map<const Eigen::MatrixXd>(right_.data(), m, n) +
            now.raised * Eigen::Map<const Eigen::MatrixXd>(right_.col(1).data(), m, n);
        double share = 1.0;
        if (cells.deflection.size() > 0) share = least_energy(request, state.path, cells, now);
        if (share < 1.0) {
            now.deflection = cells.deflection + share * (now.deflection - cells.deflection);
            now.force = cells.force + share * (now.force - cells.force);
            now.raised = std::lerp(cells.raised, now.raised, share);
        }
        state.deflection += share * (whole - state.deflection);
        state.lift = now.raised;
        const Sums sums = touch(request, state, now);
        double bears = 0.0;
        if (request.backing != nullptr && sums.same) {
            bears = request.backing->follow(now.deflection);
            touch(request, state, now);
        }
        cells = std::move(now);
        const double stretch = follow_length(request, state, stress);
        // Less and less where the belt's sides are near to buckling.
        const double follow = kFollow / (1.0 + state.iterations / kPatience);
        if (request.backing == nullptr || sums.same)
            state.function += follow * (stress.function(state.deflection) - state.function);
        const double force = yields(problem) ? std::abs(commanded(request, state.lift)) : 0.0;
        const double off = yields(problem) ? std::abs(sums.along_z - force) : 0.0;
        state.converged = state.iterations > (follows ? 1 : kWarmUp) && sums.same &&
                          sums.change <= problem.tolerance * sums.total &&
                          off <= problem.tolerance * force && bears <= problem.tolerance &&
                          std::abs(stretch) <= problem.tolerance * state.pull;
        if (state.converged) break;
    }
    return state;
}

}  // namespace beltgrinding

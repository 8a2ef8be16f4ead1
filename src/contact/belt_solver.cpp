#include "belt_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "belt_springs.h"

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
// one. A fit to five of them, not a theory (docs/free-belt.md).
constexpr double kFree = 0.25;
constexpr double kUnbalanced = 0.3;  // of the tolerance: forces that are left
constexpr double kStiffer = 0.75;    // of the stress, where with all of it the energy is no valley
constexpr double kLeastStress = 0.1;
constexpr double kRough = 0.02;    // tolerance where only the rows that bear are asked for
constexpr double kStuck = 1e-3;    // of a step
constexpr double kTouch = 1e-3;    // mm that the work is lifted into the belt, to begin with
constexpr double kNear = 0.05;     // thicknesses below the highest place: may touch, to begin with
constexpr double kGoodStep = 0.1;  // of the forces that were left over: less after a good step
constexpr double kNoForce = 1e-6;  // N
constexpr std::size_t kMostSwitched = 24;  // springs: more of them cost what a new factor does

double closer(BeltSolver::Sheet sheet) {
    return sheet == BeltSolver::Sheet::kThick ? kOnLayers : 1.0;
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
      face_(belt.face()),
      shear_((sheet == Sheet::kThick ? 1.0 : kFree) * 0.5 * kThick * belt.thickness *
             belt.thickness),
      rows_(rows_under_belt(grid, belt.width)),
      finest_(belt_, rows_, shear_,
              BeltSpline(belt.width, kInterval * closer(sheet) * std::max(1.0, grid.dy),
                         kAtEdge * closer(sheet) * std::max(1.0, grid.dy))) {}

double BeltSolver::pull_of(const BeltPath& path, double elongated) const {
    if (run_.rollers == BeltRun::Rollers::kTensioned) {
        // Of the roller's carriage, which moves along x.
        return 2.0 * belt_.tension / (std::cos(path.left_angle) + std::cos(path.right_angle));
    }
    const double unloaded = run_.length / (1.0 + belt_.tension / belt_.membrane());
    return belt_.membrane() * (path.length + elongated - unloaded) / unloaded;
}

double BeltSolver::commanded(const Request& request, double lift) {
    const ContactProblem& problem = *request.problem;
    if (problem.force_control) return problem.force;
    return (problem.approach - request.depth - lift) / problem.robot_compliance;
}

void BeltSolver::strain(const BeltStress& stress, Iterate& at) const {
    at.strain = stress.product(at.shape, at.shape);
    const BeltModes turned = stress.turned(at.deflection);
    at.strain.function += turned.function;
    at.strain.mean += turned.mean;
    at.strain.lean += turned.lean;
    at.stress = stress.stress(at.strain);
    at.smooth = path_load_ - at.bent - stress.resistance(at.shape, at.stress);
}

BeltSolver::Unbalanced BeltSolver::unbalanced(Request& request, const BeltPath& path,
                                              const Iterate& at, bool bonded) {
    Unbalanced off;
    off.belt = at.smooth;
    const bool yield = yields(*request.problem);
    if (yield) off.work = commanded(request, at.lift);
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    forces_.resize(rows, at.cells.cols());
    backing_forces_.resize(rows);
    for (int i = 0; i < path.columns.count(); ++i) {
        const double raised = at.lift * cosine_[i];
        const double* u = at.cells.col(i).data();
        double* forces = forces_.col(i).data();
        std::uint8_t* touching = &request.touching[cell(i, 0)];
        if (bonded) {
            for (Eigen::Index k = 0; k < rows; ++k)
                forces[k] =
                    touching[k] != 0 ? springs_(k, i) * (reach_(k, i) + raised - u[k]) : 0.0;
        } else {
            const bool same = press_springs(static_cast<int>(rows), reach_.col(i).data(), raised, u,
                                            springs_.col(i).data(), forces, touching);
            off.same = off.same && same;
        }
        const double total = sum_apart(static_cast<int>(rows), forces);
        off.total += total;
        if (yield) off.work -= total * cosine_[i];
        if (request.backing == nullptr) continue;
        const double* rest = request.backing->rest().col(i).data();
        std::uint8_t* borne = &borne_[cell(i, 0)];
        if (bonded) {
            for (Eigen::Index k = 0; k < rows; ++k)
                if (borne[k] != 0) forces[k] -= backing_springs_(k, i) * (u[k] - rest[k]);
            continue;
        }
        const bool same =
            press_springs(static_cast<int>(rows), u, 0.0, rest, backing_springs_.col(i).data(),
                          backing_forces_.data(), borne);
        off.borne = off.borne && same;
        forces_.col(i) -= backing_forces_;
    }
    across_->face.push(path.columns, forces_, off.belt);
    return off;
}

bool BeltSolver::factorise(const Request& request, const BeltPath& path, const BeltStress& stress,
                           const Iterate& at, double most) {
    const BeltColumns& columns = path.columns;
    coupling_ = stress.coupling(at.shape);
    const int n = columns.count(), size = across_->spline.count() + BeltStress::kTerms;
    touching_in_factor_ = request.touching;
    if (matrix_.count() != n || matrix_.size() != size)
        matrix_ = BlockBanded(n, size, BeltStress::kTerms, BeltSpline::kLocal - 1);
    forces_.resize(at.cells.rows(), n);
    for (int i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            double spring = request.touching[cell(i, k)] != 0 ? springs_(row, i) : 0.0;
            if (request.backing != nullptr && borne_[cell(i, k)] != 0)
                spring += backing_springs_(row, i);
            forces_(row, i) = spring;
        }
    }
    for (double share = most;; share = share > kLeastStress ? kStiffer * share : 0.0) {
        bands_ = bending_;
        stress.stiffen(at.stress, share, bands_);
        across_->face.stiffen(columns, forces_, bands_);
        int i = 0;
        for (; i < n; ++i) {
            matrix_.clear(i);
            stress.add_to(matrix_, i, coupling_);
            bands_.add_to(matrix_, i, BeltStress::kTerms);
            if (!matrix_.factorise(i)) break;
        }
        if (i == n) return true;
        if (share == 0.0) return false;
    }
}

bool BeltSolver::touch(Iterate& at) const {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < at.cells.cols(); ++i)
        least =
            std::min(least, (at.cells.col(i) - reach_.col(i)).minCoeff() / cosine_[i] - at.lift);
    if (!std::isfinite(least)) return false;
    at.lift += least + kTouch;
    return true;
}

void BeltSolver::start(const Request& request, BeltState& state, Iterate& at) {
    const BeltColumns& columns = state.path.columns;
    const int n = columns.count(), m = finest_.spline.count();
    at.lift = request.lift;
    at.deflection.setZero(m, n);
    if (request.before != nullptr && request.before->deflection.rows() == m &&
        request.before->deflection.cols() > 1) {
        // Between the columns that were there.
        const BeltState& before = *request.before;
        const std::vector<double>& x = before.path.x;
        for (int i = 0; i < n; ++i) {
            const double here = state.path.x[static_cast<std::size_t>(i)];
            const auto after =
                std::clamp<std::ptrdiff_t>(std::lower_bound(x.begin(), x.end(), here) - x.begin(),
                                           1, static_cast<std::ptrdiff_t>(x.size()) - 1);
            const auto k = static_cast<std::size_t>(after);
            const double t = std::clamp((here - x[k - 1]) / (x[k] - x[k - 1]), 0.0, 1.0);
            at.deflection.col(i) =
                (1.0 - t) * before.deflection.col(after - 1) + t * before.deflection.col(after);
        }
    }
    if (wider_) at.deflection = to_wider_ * at.deflection;
    at.cells = across_->face.deflection(columns, at.deflection);
}

std::vector<std::uint8_t> BeltSolver::rows_touched(
    const std::vector<std::uint8_t>& touching) const {
    std::vector<std::uint8_t> rows(rows_.size(), 0);
    for (std::size_t c = 0; c < touching.size(); ++c)
        if (touching[c] != 0) rows[c % rows_.size()] = 1;
    return rows;
}

void BeltSolver::set_lines(const std::vector<double>& lines) {
    if (lines == across_->spline.lines()) return;
    across_ = &finest_;
    wider_.reset();
    prepared_for_ = {};
    if (lines == finest_.spline.lines()) return;
    wider_ = std::make_unique<BeltAcross>(belt_, rows_, shear_, BeltSpline(lines));
    across_ = wider_.get();
    to_wider_ = wider_->spline.from(finest_.spline);
    from_wider_ = finest_.spline.from(wider_->spline);
}

BeltState BeltSolver::solve_roughly(BeltPath path, Request& request) {
    ContactProblem rough = *request.problem;
    rough.tolerance = std::max(rough.tolerance, kRough);
    const ContactProblem* given = std::exchange(request.problem, &rough);
    const std::vector<double>& finest = finest_.spline.lines();
    std::vector<double> lines;
    for (std::size_t k = 0; k < finest.size(); k += 2) lines.push_back(finest[k]);
    lines.back() = finest.back();
    set_lines(lines);
    BeltState state = solve_on(std::move(path), request);
    request.problem = given;
    return state;
}

BeltState BeltSolver::solve(BeltPath path, Request request) {
    const auto any = [](const std::vector<std::uint8_t>& flags) {
        return std::find(flags.begin(), flags.end(), 1) != flags.end();
    };
    BeltState state, before;
    int iterations = 0;
    const auto from_there = [&] {
        before = std::move(state);
        request.before = &before;
        request.lift = before.lift;
        return before.path;
    };
    if (request.backing != nullptr && !any(request.touching)) {
        state = solve_roughly(std::move(path), request);
        iterations = state.iterations;
        path = from_there();
    }
    std::vector<std::uint8_t> rows = rows_touched(request.touching);
    if (!any(rows)) rows.assign(rows_.size(), 1);
    for (bool again = false;; again = true) {
        const BeltKnots knots(finest_.spline, rows_, rows);
        set_lines(knots.lines());
        state = solve_on(std::move(path), request);
        iterations += state.iterations;
        const std::vector<std::uint8_t> now = rows_touched(request.touching);
        if (knots.covers(rows_, now)) break;
        // Pressure where it was not expected: once more, from there; then by all knots.
        for (std::size_t k = 0; k < rows.size(); ++k)
            rows[k] = again || rows[k] != 0 || now[k] != 0 ? 1 : 0;
        path = from_there();
    }
    state.iterations = iterations;
    return state;
}

void BeltSolver::set_contact(Request& request, const BeltPath& path, const Iterate& at) {
    const int n = path.columns.count();
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    reach_.resize(rows, n);
    springs_.resize(rows, n);
    backing_springs_.resize(rows, n);
    cosine_.resize(n);
    const double face = face_ / (1.0 + face_ * request.problem->recession);
    for (int i = 0; i < n; ++i) {
        const auto c = static_cast<std::size_t>(i);
        cosine_[i] = std::cos(path.angle[c]);
        reach_.col(i) = request.gap->reach.col(i) + shear_ * path.turn[c];
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const double area = rows_[k].width * path.columns.width[c];
            springs_(row, i) = face * request.gap->cover(row, i) * area;
            if (request.backing != nullptr)
                backing_springs_(row, i) = request.backing->stiffness() * area;
        }
    }
    const std::size_t all = rows_.size() * static_cast<std::size_t>(n);
    if (request.touching.size() != all) {
        request.touching.assign(all, 0);
        // What the path's rounded corners lie in; else what is nearest to it.
        const double deepest = request.gap->reach.maxCoeff();
        const double least = std::min(0.5 * deepest, deepest - kNear * belt_.thickness);
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
            for (std::size_t k = 0; k < rows_.size(); ++k) {
                const double rest = request.backing->rest()(static_cast<Eigen::Index>(k), i);
                const bool bears = request.before != nullptr
                                       ? at.cells(static_cast<Eigen::Index>(k), i) > rest
                                       : std::isfinite(rest);
                borne_[cell(i, k)] = bears ? 1 : 0;
            }
    }
}

BeltState BeltSolver::solve_on(BeltPath path, Request& request) {
    BeltState state;
    state.path = std::move(path);
    const ContactProblem& problem = *request.problem;
    const BeltColumns& columns = state.path.columns;
    const int n = columns.count();
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    const double unloaded = run_.length / (1.0 + belt_.tension / belt_.membrane());
    const double stretching =
        run_.rollers == BeltRun::Rollers::kFixed ? belt_.membrane() / unloaded : 0.0;
    if (columns != prepared_for_) {
        bending_ = across_->sheet.bending(columns);
        compliance_ = BeltStress::Compliance(across_->terms, columns);
        prepared_for_ = columns;
    }
    const BeltStress stress(belt_, across_->terms, state.path, compliance_,
                            pull_of(state.path, 0.0), stretching, run_.length);
    path_load_ = across_->sheet.path_load(state.path);
    Iterate at;
    start(request, state, at);
    set_contact(request, state.path, at);
    at.bent = bending_.times(at.deflection);
    at.shape = stress.shape(at.deflection);
    strain(stress, at);
    // Without a place to begin with, from the first touch.
    bool bonded =
        std::find(request.touching.begin(), request.touching.end(), 1) != request.touching.end();
    double share = 0.0, before = 0.0, most = 1.0;
    Unbalanced off = unbalanced(request, state.path, at, bonded);
    for (state.iterations = 0;; ++state.iterations) {
        const bool first = state.iterations == 0;
        const auto left = [&] { return std::max(off.belt.cwiseAbs().sum(), std::abs(off.work)); };
        bool good = !first && share == 1.0 && left() <= kGoodStep * before;
        double bears = 0.0;
        if (!first && request.backing != nullptr && share == 1.0 &&
            ((off.same && off.borne) || left() <= kUnbalanced * problem.tolerance * off.total)) {
            bears = request.backing->follow(at.cells);
            off = unbalanced(request, state.path, at, false);
        }
        state.converged =
            !first && left() <= std::max(kUnbalanced * problem.tolerance * off.total, kNoForce) &&
            bears <= problem.tolerance;
        if (state.converged || state.iterations >= problem.max_iterations) break;
        if (problem.force_control && off.total == 0.0 && !bonded) {
            if (!touch(at)) break;
            off = unbalanced(request, state.path, at, false);
            good = false;
        }
        // The last factor is as good where its step was and few springs have switched.
        const bool again = good && switched(request).size() <= kMostSwitched;
        before = left();
        if (!again && !factorise(request, state.path, stress, at, most)) break;
        const Step to = step(request, state.path, stress, off, again);
        if (!to.deflection.allFinite() || !std::isfinite(to.lift)) break;
        share = go(request, state.path, stress, to, bonded, at, off);
        bonded = false;
        // A step that leads nowhere: once more, by what is surely a valley; then there is no way.
        const bool stuck = share < kStuck;
        if (stuck && most == 0.0) break;
        most = stuck ? 0.0 : 1.0;
    }
    state.load.setZero(rows, n);
    for (int i = 0; i < n; ++i)
        state.load.col(i) =
            (springs_.col(i) > 0.0)
                .select(springs_.col(i) *
                            (reach_.col(i) + at.lift * cosine_[i] - at.cells.col(i)).max(0.0),
                        0.0);
    state.pull = stress.pull(at.stress);
    state.lift = at.lift;
    state.deflection =
        wider_ ? Eigen::MatrixXd(from_wider_ * at.deflection) : std::move(at.deflection);
    return state;
}

}  // namespace beltgrinding

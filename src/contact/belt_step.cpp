// A step of Newton's method on the belt's energy, and the way along it.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "belt_solver.h"

namespace beltgrinding {
namespace {

constexpr int kLineSteps = 20;  // of the search along a step
constexpr double kFlat = 0.1;   // of the energy's slope at its beginning: where that ends

}  // namespace

Eigen::MatrixXd BeltSolver::pushed_by_lift(const Request& request, const BeltPath& path,
                                           double& own) const {
    const int n = path.columns.count();
    Eigen::MatrixXd pushed = Eigen::MatrixXd::Zero(across_->spline.count(), n);
    own = request.problem->force_control ? 0.0 : 1.0 / request.problem->robot_compliance;
    for (int i = 0; i < n; ++i) {
        const double cosine = std::cos(path.angle[static_cast<std::size_t>(i)]);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (request.touching[cell(i, k)] == 0) continue;
            const double w = spring(request, path.columns, i, k) * cosine;
            own += w * cosine;
            const FaceForm form = face_form(path.columns, k, i);
            for (int p = form.first; p <= form.last; ++p)
                for (int r = 0; r < BeltSpline::kLocal; ++r)
                    pushed(across_->locals[k].first + r, i - 1 + p) -=
                        w * form.values[static_cast<std::size_t>(p)][static_cast<std::size_t>(r)];
        }
    }
    return pushed;
}

Eigen::MatrixXd BeltSolver::signed_by_rows(Eigen::MatrixXd values) const {
    const Eigen::Index size = matrix_.size();
    for (Eigen::Index c = 0; c < values.cols(); ++c)
        Eigen::Map<Eigen::MatrixXd>(values.col(c).data(), size, values.rows() / size)
            .topRows(BeltStress::kTerms) *= -1.0;
    return values;
}

std::vector<std::size_t> BeltSolver::switched(const Request& request) const {
    std::vector<std::size_t> cells;
    for (std::size_t c = 0; c < touching_in_factor_.size(); ++c)
        if (request.touching[c] != touching_in_factor_[c]) cells.push_back(c);
    return cells;
}

void BeltSolver::add_switched(const BeltPath& path, const std::vector<std::size_t>& cells) {
    const int m = across_->spline.count(), size = m + BeltStress::kTerms;
    const Eigen::Index known = static_cast<Eigen::Index>(switched_.size());
    int first = path.columns.count();
    for (const std::size_t at : cells) {
        if (std::find(switched_.begin(), switched_.end(), at) != switched_.end()) continue;
        first = std::min(first, std::max(static_cast<int>(at / rows_.size()) - 1, 0));
        switched_.push_back(at);
    }
    const Eigen::Index added = static_cast<Eigen::Index>(switched_.size()) - known;
    if (added == 0) return;
    switched_borders_.conservativeResize(borders_.rows(), known + added);
    auto to = switched_borders_.rightCols(added);
    to.setZero();
    for (Eigen::Index c = 0; c < added; ++c) {
        const std::size_t at = switched_[static_cast<std::size_t>(known + c)];
        const auto i = static_cast<int>(at / rows_.size());
        const std::size_t k = at % rows_.size();
        const FaceForm form = face_form(path.columns, k, i);
        for (int p = form.first; p <= form.last; ++p)
            for (int r = 0; r < BeltSpline::kLocal; ++r)
                to(std::ptrdiff_t{size} * (i - 1 + p) + BeltStress::kTerms +
                       across_->locals[k].first + r,
                   c) = form.values[static_cast<std::size_t>(p)][static_cast<std::size_t>(r)];
    }
    matrix_.forward(to, first);
    const Eigen::Index borders = borders_.cols(), count = borders + known + added;
    products_.conservativeResize(count, count);
    const Eigen::Index below = std::ptrdiff_t{size} * first;
    const Eigen::MatrixXd signs = signed_by_rows(to.bottomRows(to.rows() - below));
    products_.bottomLeftCorner(added, borders) =
        signs.transpose() * borders_.bottomRows(signs.rows());
    products_.bottomRightCorner(added, known + added) =
        signs.transpose() * switched_borders_.bottomRows(signs.rows());
    products_.topRightCorner(count - added, added) =
        products_.bottomLeftCorner(added, count - added).transpose();
}

BeltSolver::Step BeltSolver::step(const Request& request, const BeltPath& path,
                                  const BeltStress& stress, const BeltStress::Coupling& coupling,
                                  const Unbalanced& off, bool again) {
    const int n = path.columns.count(), m = across_->spline.count(), size = m + BeltStress::kTerms;
    const bool yield = yields(*request.problem);
    const auto belt = [&](Eigen::MatrixXd& all, Eigen::Index c) {
        return Eigen::Map<Eigen::MatrixXd>(all.col(c).data(), size, n).bottomRows(m);
    };
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(std::ptrdiff_t{size} * n, 1);
    belt(left, 0) = off.belt;
    std::vector<std::size_t> cells;
    if (again) {
        matrix_.forward(left);
        cells = switched(request);
        add_switched(path, cells);
    } else {
        const bool mean = stress.mean_stiffness() > 0.0;
        const Eigen::Index count = 1 + (yield ? 1 : 0) + (mean ? 1 : 0);
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(left.rows(), count + 1);
        border_own_.resize(count);
        Eigen::Index c = 0;
        if (yield) {
            belt(all, c) = pushed_by_lift(request, path, border_own_[c]);
            ++c;
        }
        if (mean) {
            belt(all, c) = coupling.mean;
            border_own_[c++] = -1.0 / stress.mean_stiffness();
        }
        belt(all, c) = coupling.lean;
        border_own_[c++] = -1.0 / stress.lean_stiffness();
        all.col(c) = left;
        matrix_.forward(all);
        left = all.col(c);
        borders_ = all.leftCols(count);
        products_ = borders_.transpose() * signed_by_rows(borders_);
        switched_.clear();
        switched_borders_.resize(borders_.rows(), 0);
    }
    // Of the borders, and of the springs that are to be added.
    const Eigen::Index borders = borders_.cols();
    const Eigen::Index count = borders + static_cast<Eigen::Index>(cells.size());
    Eigen::MatrixXd used(left.rows(), count);
    used.leftCols(borders) = borders_;
    Eigen::VectorXd own(count);
    own.head(borders) = border_own_;
    // The lift pushes by the springs that there are: a change of the basis.
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(products_.rows(), count);
    basis.topLeftCorner(borders, borders).setIdentity();
    for (std::size_t s = 0; s < cells.size(); ++s) {
        const Eigen::Index c = borders + static_cast<Eigen::Index>(s);
        const auto known =
            std::find(switched_.begin(), switched_.end(), cells[s]) - switched_.begin();
        used.col(c) = switched_borders_.col(known);
        basis(borders + known, c) = 1.0;
        const auto i = static_cast<int>(cells[s] / rows_.size());
        const double own_spring = spring(request, path.columns, i, cells[s] % rows_.size());
        const double more = request.touching[cells[s]] != 0 ? own_spring : -own_spring;
        own[c] = -1.0 / more;
        if (!yield) continue;
        const double cosine = std::cos(path.angle[static_cast<std::size_t>(i)]);
        basis(borders + known, 0) = -more * cosine;
        used.col(0) -= more * cosine * used.col(c);
        own[0] += more * cosine * cosine;
    }
    Eigen::MatrixXd matrix = -basis.transpose() * products_ * basis;
    matrix.diagonal() += own;
    Eigen::VectorXd rest = -used.transpose() * signed_by_rows(left);
    if (yield) rest[0] += off.work;
    const Eigen::VectorXd others = matrix.partialPivLu().solve(rest);
    left -= used * others;
    matrix_.backward(left);
    Step step;
    step.deflection = belt(left, 0);
    if (yield) step.lift = others[0];
    return step;
}

double BeltSolver::go(const Request& request, const BeltPath& path, const BeltStress& stress,
                      const Unbalanced& off, const Step& step, bool whole, Iterate& at) const {
    const int n = path.columns.count();
    const BeltStress::Shape shape = stress.shape(step.deflection);
    // Strains are e0 + s e1 + s^2 e2 on the way.
    BeltModes e1 = stress.product(at.shape, shape);
    const BeltModes turned = stress.turned(step.deflection);
    e1.function = 2.0 * e1.function + turned.function;
    e1.mean = 2.0 * e1.mean + turned.mean;
    e1.lean = 2.0 * e1.lean + turned.lean;
    const BeltModes e2 = stress.product(shape, shape);
    const BeltModes s1 = stress.stress(e1), s2 = stress.stress(e2);
    const auto work = [](const BeltModes& s, const BeltModes& e) {
        return s.function.cwiseProduct(e.function).sum() + s.mean * e.mean + s.lean * e.lean;
    };
    const Eigen::ArrayXXd cells = face_at_cells(path.columns, step.deflection);
    const Eigen::MatrixXd bent = bending_.times(step.deflection);
    double share = 1.0;
    if (!whole) {
        const double rest = stress.pull({{}, 0.0, 0.0});
        // The energy's slope, but for what is not smooth.
        std::array<double, 4> smooth = {
            -path_load_.cwiseProduct(step.deflection).sum() +
                at.bent.cwiseProduct(step.deflection).sum() + work(at.stress, e1) + rest * e1.mean,
            bent.cwiseProduct(step.deflection).sum() + 2.0 * work(at.stress, e2) + work(s1, e1) +
                2.0 * rest * e2.mean,
            3.0 * work(s1, e2), 2.0 * work(s2, e2)};
        if (yields(*request.problem)) {
            smooth[0] -= commanded(request, at.lift) * step.lift;
            if (!request.problem->force_control)
                smooth[1] += step.lift * step.lift / request.problem->robot_compliance;
        }
        const auto slope = [&](double s) {
            double sum = smooth[0] + s * (smooth[1] + s * (smooth[2] + s * smooth[3]));
            for (int i = 0; i < n; ++i) {
                const double cosine = std::cos(path.angle[static_cast<std::size_t>(i)]);
                for (std::size_t k = 0; k < rows_.size(); ++k) {
                    const auto row = static_cast<Eigen::Index>(k);
                    const double du = cells(row, i), u = at.cells(row, i) + s * du;
                    const double overlap =
                        reach_at(request, path, i, k) + (at.lift + s * step.lift) * cosine - u;
                    if (overlap > 0.0)
                        sum += spring(request, path.columns, i, k) * overlap *
                               (step.lift * cosine - du);
                    if (request.backing == nullptr) continue;
                    const double in = u - request.backing->rest()(row, i);
                    if (in > 0.0) sum += backing_spring(request, path.columns, i, k) * in * du;
                }
            }
            return sum;
        };
        const double first = -(off.belt.cwiseProduct(step.deflection).sum() + off.work * step.lift);
        double end = slope(1.0);
        if (end > kFlat * std::abs(first)) {
            double low = 0.0, high = 1.0, at_low = first, at_high = end;
            share = 0.0;
            for (int k = 0; k < kLineSteps; ++k) {
                // Regula falsi, kept away from the ends.
                const double part = std::clamp(at_low / (at_low - at_high), 0.1, 0.9);
                const double middle = k % 3 == 2 ? 0.5 * (low + high) : std::lerp(low, high, part);
                const double value = slope(middle);
                if (value > 0.0) {
                    high = middle;
                    at_high = value;
                } else {
                    low = middle;
                    at_low = value;
                }
                share = low;
                if (low > 0.0 && std::abs(at_low) <= kFlat * std::abs(first)) break;
            }
            if (share == 0.0) share = high;
        }
    }
    at.deflection += share * step.deflection;
    at.bent += share * bent;
    at.lift += share * step.lift;
    at.cells += share * cells;
    at.shape.x += share * shape.x;
    at.shape.xy += share * shape.xy;
    at.shape.xx += share * shape.xx;
    at.shape.yy += share * shape.yy;
    const auto add = [](BeltModes& to, double factor, const BeltModes& from) {
        to.function += factor * from.function;
        to.mean += factor * from.mean;
        to.lean += factor * from.lean;
    };
    add(at.strain, share, e1);
    add(at.strain, share * share, e2);
    add(at.stress, share, s1);
    add(at.stress, share * share, s2);
    return share;
}

}  // namespace beltgrinding

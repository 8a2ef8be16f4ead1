// A step of Newton's method on the belt's energy.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "belt_solver.h"

namespace beltgrinding {
namespace {

constexpr Eigen::Index kAtOnce = 4;  // springs that are taken into a factor

}  // namespace

Eigen::MatrixXd BeltSolver::pushed_by_lift(const Request& request, const BeltPath& path,
                                           double& own) const {
    Eigen::MatrixXd pushed = Eigen::MatrixXd::Zero(across_->spline.count(), path.columns.count());
    Eigen::ArrayXXd forces = Eigen::ArrayXXd::Zero(springs_.rows(), springs_.cols());
    own = request.problem->force_control ? 0.0 : 1.0 / request.problem->robot_compliance;
    for (Eigen::Index i = 0; i < forces.cols(); ++i) {
        for (Eigen::Index k = 0; k < forces.rows(); ++k) {
            if (request.touching[cell(static_cast<int>(i), static_cast<std::size_t>(k))] == 0)
                continue;
            const double w = springs_(k, i) * cosine_[i];
            own += w * cosine_[i];
            forces(k, i) = -w;
        }
    }
    across_->face.push(path.columns, forces, pushed);
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
    for (const std::size_t at : cells)
        if (std::find(switched_.begin(), switched_.end(), at) == switched_.end())
            switched_.push_back(at);
    const Eigen::Index added = static_cast<Eigen::Index>(switched_.size()) - known;
    if (added == 0) return;
    switched_borders_.conservativeResize(borders_.rows(), known + added);
    auto to = switched_borders_.rightCols(added);
    to.setZero();
    for (Eigen::Index c = 0; c < added; ++c) {
        const std::size_t at = switched_[static_cast<std::size_t>(known + c)];
        const auto i = static_cast<int>(at / rows_.size());
        const std::size_t k = at % rows_.size();
        const BeltFace::Form form = across_->face.form(path.columns, k, i);
        for (int p = form.first; p <= form.last; ++p)
            for (int r = 0; r < BeltSpline::kLocal; ++r)
                to(std::ptrdiff_t{size} * (i - 1 + p) + BeltStress::kTerms + form.spline + r, c) =
                    form.values[static_cast<std::size_t>(p)][static_cast<std::size_t>(r)];
    }
    const Eigen::Index borders = borders_.cols(), count = borders + known + added;
    products_.conservativeResize(count, count);
    // Cells ascend with the columns, and so do those from which on there is something: some at a
    // time, whose products with themselves and those before are all that is not yet known.
    for (Eigen::Index c = 0; c < added; c += kAtOnce) {
        const Eigen::Index some = std::min(kAtOnce, added - c);
        const std::size_t least = switched_[static_cast<std::size_t>(known + c)] / rows_.size();
        const int first = std::max(static_cast<int>(least) - 1, 0);
        matrix_.forward(to.middleCols(c, some), first);
        const Eigen::Index rows = to.rows() - std::ptrdiff_t{size} * first;
        const Eigen::Index at = borders + known + c, end = known + c + some;
        const auto from = to.middleCols(c, some).bottomRows(rows);
        products_.block(0, at, borders, some) = matrix_.products(borders_.bottomRows(rows), from);
        products_.block(borders, at, end, some) =
            matrix_.products(switched_borders_.leftCols(end).bottomRows(rows), from);
        products_.block(at, 0, some, borders + end) =
            products_.block(0, at, borders + end, some).transpose();
    }
}

BeltSolver::Step BeltSolver::step(const Request& request, const BeltPath& path,
                                  const BeltStress& stress, const Unbalanced& off, bool again) {
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
            belt(all, c) = coupling_.mean;
            border_own_[c++] = -1.0 / stress.mean_stiffness();
        }
        belt(all, c) = coupling_.lean;
        border_own_[c++] = -1.0 / stress.lean_stiffness();
        all.col(c) = left;
        matrix_.forward(all);
        left = all.col(c);
        borders_ = all.leftCols(count);
        products_ = matrix_.products(borders_, borders_);
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
        const double own_spring = springs_(static_cast<Eigen::Index>(cells[s] % rows_.size()), i);
        const double more = request.touching[cells[s]] != 0 ? own_spring : -own_spring;
        own[c] = -1.0 / more;
        if (!yield) continue;
        const double cosine = cosine_[i];
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

}  // namespace beltgrinding

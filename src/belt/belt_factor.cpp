#include "belt_factor.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

namespace beltgrinding {
namespace {

constexpr double kStiffer = 0.75;  // of the stress, where with all of it the energy is no valley
constexpr double kLeastStress = 0.1;
constexpr Eigen::Index kAtOnce = 4;        // springs that are taken into a factor
constexpr std::size_t kMostSwitched = 24;  // springs: more of them cost what a new factor does

/// Of all unknowns, column by column, those of the splines.
auto splines_of(Eigen::MatrixXd& all, Eigen::Index c, int splines) {
    const int size = splines + BeltStress::kTerms;
    return Eigen::Map<Eigen::MatrixXd>(all.col(c).data(), size, all.rows() / size)
        .bottomRows(splines);
}

}  // namespace

bool BeltFactor::factorise(const BeltEnergy& energy, const BeltBasis& basis,
                           const BeltSupport& support, const BeltIterate& at, double most) {
    const BeltColumns& columns = energy.columns();
    const BeltStress& stress = energy.stress();
    const BeltAcross& across = basis.across();
    coupling_ = stress.coupling(at.shape);
    const int n = columns.count(), size = across.spline.count() + BeltStress::kTerms;
    touching_ = support.touching();
    if (matrix_.count() != n || matrix_.size() != size)
        matrix_ = BlockBanded(n, size, BeltStress::kTerms, BeltSpline::kLocal - 1);
    const Eigen::ArrayXXd springs = support.springs_on();
    for (double share = most;; share = share > kLeastStress ? kStiffer * share : 0.0) {
        bands_ = basis.bending();
        stress.stiffen(at.stress, share, bands_);
        across.face.stiffen(columns, springs, bands_);
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

bool BeltFactor::serves(const BeltSupport& support) const {
    return switched(support).size() <= kMostSwitched;
}

std::vector<std::size_t> BeltFactor::switched(const BeltSupport& support) const {
    const std::vector<std::uint8_t>& now = support.touching();
    std::vector<std::size_t> cells;
    for (std::size_t c = 0; c < touching_.size(); ++c)
        if (now[c] != touching_[c]) cells.push_back(c);
    return cells;
}

Eigen::MatrixXd BeltFactor::signed_by_rows(Eigen::MatrixXd values) const {
    const Eigen::Index size = matrix_.size();
    for (Eigen::Index c = 0; c < values.cols(); ++c)
        Eigen::Map<Eigen::MatrixXd>(values.col(c).data(), size, values.rows() / size)
            .topRows(BeltStress::kTerms) *= -1.0;
    return values;
}

void BeltFactor::add_switched(const BeltColumns& columns, const BeltBasis& basis,
                              const BeltSupport& support, const std::vector<std::size_t>& cells) {
    const int m = basis.across().spline.count(), size = m + BeltStress::kTerms;
    const std::size_t rows = support.rows().size();
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
        const auto i = static_cast<int>(at / rows);
        const std::size_t k = at % rows;
        const BeltFace::Form form = basis.across().face.form(columns, k, i);
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
        const std::size_t least = switched_[static_cast<std::size_t>(known + c)] / rows;
        const int first = std::max(static_cast<int>(least) - 1, 0);
        matrix_.forward(to.middleCols(c, some), first);
        const Eigen::Index below = to.rows() - std::ptrdiff_t{size} * first;
        const Eigen::Index at = borders + known + c, end = known + c + some;
        const auto from = to.middleCols(c, some).bottomRows(below);
        products_.block(0, at, borders, some) = matrix_.products(borders_.bottomRows(below), from);
        products_.block(borders, at, end, some) =
            matrix_.products(switched_borders_.leftCols(end).bottomRows(below), from);
        products_.block(at, 0, some, borders + end) =
            products_.block(0, at, borders + end, some).transpose();
    }
}

void BeltFactor::set_borders(const BeltEnergy& energy, const BeltBasis& basis,
                             const BeltSupport& support, Eigen::MatrixXd& left) {
    const BeltStress& stress = energy.stress();
    const BeltDrive& drive = energy.drive();
    const int m = basis.across().spline.count();
    const bool yields = drive.yields(), mean = stress.mean_stiffness() > 0.0;
    const Eigen::Index count = 1 + (yields ? 1 : 0) + (mean ? 1 : 0);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(left.rows(), count + 1);
    border_own_.resize(count);
    Eigen::Index c = 0;
    if (yields) {
        double& own = border_own_[c];
        own = drive.problem.force_control ? 0.0 : 1.0 / drive.problem.robot_compliance;
        Eigen::MatrixXd pushed = Eigen::MatrixXd::Zero(m, energy.columns().count());
        basis.across().face.push(energy.columns(), support.pushed_by_lift(own), pushed);
        splines_of(all, c++, m) = pushed;
    }
    if (mean) {
        splines_of(all, c, m) = coupling_.mean;
        border_own_[c++] = -1.0 / stress.mean_stiffness();
    }
    splines_of(all, c, m) = coupling_.lean;
    border_own_[c++] = -1.0 / stress.lean_stiffness();
    all.col(c) = left;
    matrix_.forward(all);
    left = all.col(c);
    borders_ = all.leftCols(count);
    products_ = matrix_.products(borders_, borders_);
    switched_.clear();
    switched_borders_.resize(borders_.rows(), 0);
}

BeltStep BeltFactor::step(const BeltEnergy& energy, const BeltBasis& basis,
                          const BeltSupport& support, const BeltUnbalanced& off, bool again) {
    const int n = energy.columns().count(), m = basis.across().spline.count();
    const bool yields = energy.drive().yields();
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(std::ptrdiff_t{m + BeltStress::kTerms} * n, 1);
    splines_of(left, 0, m) = off.belt;
    std::vector<std::size_t> cells;
    if (again) {
        matrix_.forward(left);
        cells = switched(support);
        add_switched(energy.columns(), basis, support, cells);
    } else {
        set_borders(energy, basis, support, left);
    }
    // Of the borders, and of the springs that are to be added.
    const Eigen::Index borders = borders_.cols();
    const Eigen::Index count = borders + static_cast<Eigen::Index>(cells.size());
    Eigen::MatrixXd used(left.rows(), count);
    used.leftCols(borders) = borders_;
    Eigen::VectorXd own(count);
    own.head(borders) = border_own_;
    // The lift pushes by the springs that there are: a change of the basis.
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(products_.rows(), count);
    change.topLeftCorner(borders, borders).setIdentity();
    for (std::size_t s = 0; s < cells.size(); ++s) {
        const Eigen::Index c = borders + static_cast<Eigen::Index>(s);
        const auto known =
            std::find(switched_.begin(), switched_.end(), cells[s]) - switched_.begin();
        used.col(c) = switched_borders_.col(known);
        change(borders + known, c) = 1.0;
        const double own_spring = support.spring(cells[s]);
        const double more = support.touching()[cells[s]] != 0 ? own_spring : -own_spring;
        own[c] = -1.0 / more;
        if (!yields) continue;
        const double cosine = support.cosine(cells[s]);
        change(borders + known, 0) = -more * cosine;
        used.col(0) -= more * cosine * used.col(c);
        own[0] += more * cosine * cosine;
    }
    Eigen::MatrixXd matrix = -change.transpose() * products_ * change;
    matrix.diagonal() += own;
    Eigen::VectorXd rest = -used.transpose() * signed_by_rows(left);
    if (yields) rest[0] += off.work;
    const Eigen::VectorXd others = matrix.partialPivLu().solve(rest);
    left -= used * others;
    matrix_.backward(left);
    BeltStep step;
    step.deflection = splines_of(left, 0, m);
    if (yields) step.lift = others[0];
    return step;
}

}  // namespace beltgrinding

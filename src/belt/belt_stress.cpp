#include "belt_stress.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "belt_curved.h"

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;
using Of = BeltTerms::Of;

/// Coefficients of the slopes along the belt, at the columns' borders.
Matrix slopes_of(const BeltColumns& columns, const Matrix& c) {
    const Eigen::Index n = c.cols();
    Matrix slopes(c.rows(), n + 1);
    slopes.col(0) = c.col(0) / columns.between.front();
    for (Eigen::Index border = 1; border < n; ++border)
        slopes.col(border) =
            (c.col(border) - c.col(border - 1)) / columns.between[static_cast<std::size_t>(border)];
    slopes.col(n) = -c.col(n - 1) / columns.between.back();
    return slopes;
}

/// The same of the curvatures, in the columns.
Matrix curvatures_of(const BeltColumns& columns, const Matrix& c) {
    Matrix curvatures = Matrix::Zero(c.rows(), c.cols());
    for (int i = 1; i + 1 < columns.count(); ++i) {
        const std::array<double, 3> k = columns.curvature(i);
        curvatures.col(i) = k[0] * c.col(i - 1) + k[1] * c.col(i) + k[2] * c.col(i + 1);
    }
    return curvatures;
}

/// mm of what is between two columns' middles, and the columns that it belongs to.
struct Share {
    int first, last;
    double length;
};

Share share_of(const BeltColumns& columns, int border) {
    const double between = columns.between[static_cast<std::size_t>(border)];
    if (border == 0) return {0, 0, between};
    if (border == columns.count()) return {border - 1, border - 1, between};
    return {border - 1, border, 0.5 * between};
}

}  // namespace

BeltStress::Compliance::Compliance(const BeltTerms& terms, const BeltColumns& columns)
    : matrix(columns.count(), kTerms) {
    using Square = Eigen::Matrix<double, kTerms, kTerms>;
    const CurvedForm<Square> form = {terms.value_value, terms.value_curvature,
                                     terms.value_curvature.transpose()};
    const Square across = terms.curvature_curvature;
    for (int i = 0; i < columns.count(); ++i) {
        matrix.block(i, 0) += columns.width[static_cast<std::size_t>(i)] * across;
        add_curved(columns, i, form, matrix);
    }
    factor = matrix;
    if (!factor.factorise()) throw std::logic_error("BeltStress: not positive definite");
}

BeltStress::BeltStress(const AbrasiveBelt& belt, const BeltTerms& terms, const BeltPath& path,
                       const Compliance& compliance, double resting, double stretching,
                       double run_length)
    : membrane_(belt.membrane()),
      width_(belt.width),
      resting_(resting),
      stretching_(stretching),
      leaning_(3.0 * belt.membrane() / (belt.width * run_length)),
      terms_(terms),
      spline_(terms.spline),
      path_(path),
      compliance_(compliance) {}

BeltStress::Shape BeltStress::shape(const Matrix& deflection) const {
    Shape shape;
    const Matrix slopes = slopes_of(path_.columns, deflection);
    terms_.at_places(Of::kValue, slopes, shape.x);
    terms_.at_places(Of::kSlope, slopes, shape.xy);
    terms_.at_places(Of::kValue, curvatures_of(path_.columns, deflection), shape.xx);
    terms_.at_places(Of::kCurvature, deflection, shape.yy);
    return shape;
}

BeltModes BeltStress::product(const Shape& a, const Shape& b) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count();
    const auto places = static_cast<Eigen::Index>(spline_.places().size());
    const Eigen::Map<const Eigen::ArrayXd> weights(spline_.weights().data(), places);
    const Eigen::Map<const Eigen::ArrayXd> y(spline_.places().data(), places);
    BeltModes strain;
    Eigen::ArrayXd longer = Eigen::ArrayXd::Zero(places);
    for (int border = 0; border <= n; ++border)
        longer += 0.5 * columns.between[static_cast<std::size_t>(border)] * a.x.col(border) *
                  b.x.col(border);
    strain.mean = (weights * longer).sum();
    strain.lean = 2.0 / width_ * (weights * y * longer).sum();
    Eigen::ArrayXXd gauss = Eigen::ArrayXXd::Zero(places, n);
    for (int border = 0; border <= n; ++border) {
        const Share share = share_of(columns, border);
        const Eigen::ArrayXd twist = a.xy.col(border) * b.xy.col(border);
        for (int i = share.first; i <= share.last; ++i) gauss.col(i) += share.length * twist;
    }
    for (int i = 0; i < n; ++i)
        gauss.col(i) -=
            0.5 * columns.apart(i) * (a.xx.col(i) * b.yy.col(i) + b.xx.col(i) * a.yy.col(i));
    strain.function = terms_.weighted.topRows(kTerms) * gauss.matrix();
    return strain;
}

BeltModes BeltStress::turned(const Matrix& deflection) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count();
    BeltModes strain;
    strain.function.setZero(kTerms, n);
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double turn = columns.width[k] * path_.turn[k];
        if (turn == 0.0) continue;
        strain.mean -= turn * terms_.even.dot(deflection.col(i));
        strain.lean -= turn * terms_.odd.dot(deflection.col(i));
        strain.function.col(i) =
            -columns.apart(i) * path_.turn[k] * (terms_.bent.topRows(kTerms) * deflection.col(i));
    }
    return strain;
}

BeltModes BeltStress::stress(const BeltModes& strain) const {
    BeltModes stress;
    Matrix all =
        membrane_ * Eigen::Map<const Matrix>(strain.function.data(), strain.function.size(), 1);
    compliance_.factor.solve(all);
    stress.function = Eigen::Map<Matrix>(all.data(), kTerms, strain.function.cols());
    stress.mean = mean_stiffness() * strain.mean;
    stress.lean = lean_stiffness() * strain.lean;
    return stress;
}

void BeltStress::stiffen(const BeltModes& stress, double share, BeltBands& sheet) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count(), m = spline_.count();
    // Its work on w_xy^2 - w_xx w_yy, and on the belt's elongation.
    using Band = BeltBands::Band;
    Band along(m, BeltBands::kDiagonals), across = along, twisted = along, before = along;
    const Band even = pull(stress) * terms_.stretched + share * stress.lean * terms_.leaning;
    before.setZero();
    const auto add_border = [&](int border, const Band& left, const Band& right) {
        const double square = 1.0 / columns.between[static_cast<std::size_t>(border)];
        const Band own = square * (even + left + right);
        if (border < n) sheet.add(border, 0, 1.0, own);
        if (border > 0) sheet.add(border - 1, 0, 1.0, own);
        if (border > 0 && border < n) sheet.add(border - 1, 1, -1.0, own);
    };
    for (int i = 0; i < n; ++i) {
        const Eigen::VectorXd function = share * stress.function.col(i);
        BeltTerms::sum(terms_.twisted, function, twisted.data());
        add_border(i, i > 0 ? before : twisted, twisted);
        before.swap(twisted);
        const std::array<double, 3> k = columns.curvature(i);
        if (k[1] == 0.0) continue;
        BeltTerms::sum(terms_.along, function, along.data());
        BeltTerms::sum(terms_.across, function, across.data());
        const double apart = columns.apart(i);
        sheet.add(i - 1, 1, -apart * k[0], across);
        sheet.add(i, 0, -apart * k[1], along, -apart * k[1], across);
        sheet.add(i, 1, -apart * k[2], along);
    }
    add_border(n, before, before);
}

BeltStress::Coupling BeltStress::coupling(const Shape& shape) const {
    using Terms = BeltTerms::Terms;
    const BeltColumns& columns = path_.columns;
    const int n = columns.count(), m = spline_.count();
    Coupling coupling;
    coupling.function.resize(BeltTerms::kPadded, 3 * m * n);
    coupling.mean.resize(m, n);
    coupling.lean.resize(m, n);
    Eigen::ArrayXd factor(shape.x.rows());
    // By what a column's border turns and stretches, and the next one; by its curvatures.
    Terms turns(BeltTerms::kPadded, m), next_turns(BeltTerms::kPadded, m);
    Terms stretches(BeltTerms::kPadded, m), next_stretches(BeltTerms::kPadded, m);
    Terms along(BeltTerms::kPadded, m), across(BeltTerms::kPadded, m);
    const auto at_border = [&](int border, Terms& turn, Terms& stretch) {
        const double by = 2.0 * share_of(columns, border).length /
                          columns.between[static_cast<std::size_t>(border)];
        factor = by * shape.xy.col(border);
        terms_.moments(Of::kSlope, factor.data(), turn.data());
        terms_.moments(Of::kValue, shape.x.col(border).data(), stretch.data());
    };
    at_border(0, turns, stretches);
    for (int i = 0; i < n; ++i) {
        const auto c = static_cast<std::size_t>(i);
        at_border(i + 1, next_turns, next_stretches);
        const double turn = path_.turn[c], apart = columns.apart(i);
        factor = apart * (turn + shape.xx.col(i));
        terms_.moments(Of::kCurvature, factor.data(), along.data());
        factor = apart * shape.yy.col(i);
        terms_.moments(Of::kValue, factor.data(), across.data());
        const std::array<double, 3> k = columns.curvature(i);
        // Of the function in this column by the deflection in the one before, its own and the next.
        const auto to = [&](int p) { return coupling.function.middleCols((3 * i + p) * m, m); };
        to(0) = -turns - k[0] * across;
        to(1) = turns - next_turns - along - k[1] * across;
        to(2) = next_turns - k[2] * across;
        const double turned = columns.width[c] * turn;
        coupling.mean.col(i) =
            (stretches - next_stretches).row(BeltTerms::kEven).transpose() - turned * terms_.even;
        coupling.lean.col(i) =
            (stretches - next_stretches).row(BeltTerms::kOdd).transpose() - turned * terms_.odd;
        turns.swap(next_turns);
        stretches.swap(next_stretches);
    }
    return coupling;
}

Eigen::MatrixXd BeltStress::resistance(const Shape& shape, const BeltModes& stress) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count(), m = spline_.count();
    const auto places = static_cast<Eigen::Index>(spline_.places().size());
    const Eigen::Map<const Eigen::ArrayXd> weights(spline_.weights().data(), places);
    const Eigen::Map<const Eigen::ArrayXd> y(spline_.places().data(), places);
    // The stress at the places, by their weights: of the function, and along the belt.
    Eigen::ArrayXXd function(places, n);
    for (int i = 0; i < n; ++i)
        BeltTerms::sum(terms_.by_place, stress.function.col(i), function.col(i).data());
    const Eigen::ArrayXd along = weights * (pull(stress) + (2.0 / width_ * stress.lean) * y);
    Matrix result = Matrix::Zero(m, n);
    Eigen::ArrayXd factors(places);
    Eigen::VectorXd moments(m);
    for (int i = 0; i < n; ++i) {
        const double apart = columns.apart(i), turn = path_.turn[static_cast<std::size_t>(i)];
        factors = -apart * (turn + shape.xx.col(i)) * function.col(i);
        terms_.add_moments(Of::kCurvature, factors.data(), result.col(i).data());
        const std::array<double, 3> k = columns.curvature(i);
        if (k[1] != 0.0) {
            factors = -apart * shape.yy.col(i) * function.col(i);
            moments.setZero();
            terms_.add_moments(Of::kValue, factors.data(), moments.data());
            for (int p = 0; p < 3; ++p)
                result.col(i - 1 + p) += k[static_cast<std::size_t>(p)] * moments;
        }
        if (turn == 0.0) continue;
        const double turned = columns.width[static_cast<std::size_t>(i)] * turn;
        result.col(i) -= turned * (pull(stress) * terms_.even + stress.lean * terms_.odd);
    }
    for (int border = 0; border <= n; ++border) {
        const Share share = share_of(columns, border);
        moments.setZero();
        factors = function.col(share.first);
        if (share.last != share.first) factors += function.col(share.last);
        factors *= 2.0 * share.length * shape.xy.col(border);
        terms_.add_moments(Of::kSlope, factors.data(), moments.data());
        const double between = columns.between[static_cast<std::size_t>(border)];
        factors = between * along * shape.x.col(border);
        terms_.add_moments(Of::kValue, factors.data(), moments.data());
        if (border < n) result.col(border) += moments / between;
        if (border > 0) result.col(border - 1) -= moments / between;
    }
    return result;
}

void BeltStress::add_to(BlockBanded& matrix, int i, const Coupling& coupling) const {
    const int n = path_.columns.count(), m = spline_.count();
    const auto from = [&](int of, int by) {
        return coupling.function.middleCols((3 * of + by - of + 1) * m, m).topRows<kTerms>();
    };
    for (int below = 0; below < std::min(3, n - i); ++below) {
        auto to = matrix.block(i, below);
        to.topLeftCorner(kTerms, kTerms) -= compliance_.matrix.block(i, below) / membrane_;
        if (below > 1) continue;
        // Rows: deflection of column i + below; columns: function of column i.
        to.bottomLeftCorner(m, kTerms) += from(i, i + below).transpose();
        if (below == 1) to.topRightCorner(kTerms, m) += from(i + 1, i);
    }
}

}  // namespace beltgrinding

#include "belt_sheet.h"

#include <algorithm>
#include <array>

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;
using Band = BeltBands::Band;
constexpr int kLocal = BeltSpline::kLocal;

/// A form of the second derivative k along the belt and of the value c itself: 1/2 k' A k + k' B c
/// + 1/2 c' C c.
struct CurvedForm {
    Band a, b, b_transposed;
};

/// Adds A and B of the form in one column.
void add_curved(const BeltColumns& columns, int i, const CurvedForm& form, BeltBands& matrix) {
    const std::array<double, 3> k = columns.curvature(i);
    if (k[1] == 0.0) return;
    const double h = columns.apart(i);
    for (int q = 0; q < 3; ++q) {
        for (int p = q; p < 3; ++p) {
            auto to = matrix.block(i - 1 + q, p - q);
            const double kp = k[static_cast<std::size_t>(p)];
            const double kq = k[static_cast<std::size_t>(q)];
            to += h * kp * kq * form.a;
            if (q == 1) to += h * kp * form.b;
            if (p == 1) to += h * kq * form.b_transposed;
        }
    }
}

/// Adds 1/2 s' P s, s the slope along the belt, at a border. At the ends the belt is held.
void add_sloped(const BeltColumns& columns, int border, const Band& p, BeltBands& matrix) {
    const double square = 1.0 / columns.between[static_cast<std::size_t>(border)];
    const bool first = border == 0, last = border == columns.count();
    if (!last) matrix.block(border, 0) += square * p;
    if (first) return;
    matrix.block(border - 1, 0) += square * p;
    // Row: the column behind the border; column: that before it.
    if (!last) matrix.block(border - 1, 1) -= square * p;
}

/// Integral of f times the products of two splines' parts.
template <class Row, class Column, class Values>
void integrate(const BeltSpline& spline, const Values& f, Row row, Column column, Band& to) {
    const auto& locals = spline.locals();
    for (std::size_t q = 0; q < locals.size(); ++q) {
        const auto& local = locals[q];
        const auto &a = row(local), &b = column(local);
        const double weight = spline.weights()[q] * f[static_cast<Eigen::Index>(q)];
        for (std::size_t s = 0; s < kLocal; ++s)
            for (std::size_t r = 0; r < kLocal; ++r)
                to(kLocal - 1 + static_cast<int>(r) - static_cast<int>(s),
                   local.first + static_cast<int>(s)) += weight * a[r] * b[s];
    }
}

}  // namespace

BeltSheet::BeltSheet(const AbrasiveBelt& belt, const BeltSpline& spline)
    : bending_(belt.bending()), ratio_(belt.poissons_ratio), spline_(spline) {
    leaning_.setZero(spline.count(), spline.count());
    for (std::size_t q = 0; q < spline.places().size(); ++q) {
        const BeltSpline::Local& b = spline.locals()[q];
        const double weight = spline.weights()[q] * 2.0 / belt.width * spline.places()[q];
        for (std::size_t r = 0; r < kLocal; ++r)
            for (std::size_t s = 0; s < kLocal; ++s)
                leaning_(b.first + static_cast<int>(r), b.first + static_cast<int>(s)) +=
                    weight * b.value[r] * b.value[s];
    }
}

BeltBands BeltSheet::bending(const BeltColumns& columns) const {
    const int n = columns.count(), m = spline_.count();
    BeltBands matrix(n, m);
    const Matrix mixed = ratio_ * bending_ * spline_.value_curvature();
    const CurvedForm form = {BeltBands::band_of(bending_ * spline_.values()),
                             BeltBands::band_of(mixed), BeltBands::band_of(mixed.transpose())};
    const Band c = BeltBands::band_of(bending_ * spline_.curvatures());
    const Band twist = BeltBands::band_of(2.0 * (1.0 - ratio_) * bending_ * spline_.slopes());
    for (int i = 0; i < n; ++i) {
        matrix.block(i, 0) += columns.width[static_cast<std::size_t>(i)] * c;
        add_curved(columns, i, form, matrix);
    }
    for (int border = 0; border <= n; ++border) add_sloped(columns, border, twist, matrix);
    return matrix;
}

void BeltSheet::add_stress(const BeltColumns& columns, const BeltForces& forces,
                           BeltBands& to) const {
    const int n = columns.count(), m = spline_.count();
    const auto value = [](const BeltSpline::Local& b) -> const auto& {
        return b.value;
    };
    const auto slope = [](const BeltSpline::Local& b) -> const auto& {
        return b.slope;
    };
    const auto curvature = [](const BeltSpline::Local& b) -> const auto& {
        return b.curvature;
    };
    // Its work on w_xy^2 - w_xx w_yy, and on the belt's elongation.
    Band own(BeltBands::kDiagonals, m), transposed = own;
    for (int i = 0; i < n; ++i) {
        const std::array<double, 3> k = columns.curvature(i);
        if (k[1] == 0.0) continue;
        const Eigen::ArrayXd f = -columns.apart(i) * forces.function.col(i);
        own.setZero();
        transposed.setZero();
        integrate(spline_, f, value, curvature, own);
        integrate(spline_, f, curvature, value, transposed);
        to.block(i - 1, 1) += k[0] * transposed;
        to.block(i, 0) += k[1] * (own + transposed);
        to.block(i, 1) += k[2] * own;
    }
    const Band even = BeltBands::band_of(forces.mean * spline_.values() + forces.lean * leaning_);
    for (int border = 0; border <= n; ++border) {
        const Eigen::ArrayXd f = forces.function.col(std::max(border - 1, 0)) +
                                 forces.function.col(std::min(border, n - 1));
        own = even;
        integrate(spline_, f, slope, slope, own);
        add_sloped(columns, border, own, to);
    }
}

Eigen::MatrixXd BeltSheet::path_load(const BeltPath& path) const {
    const BeltColumns& columns = path.columns;
    const int n = columns.count(), m = spline_.count();
    Matrix load = Matrix::Zero(m, n);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(m);
    const Eigen::VectorXd even = bending_ * spline_.values() * ones;
    const Eigen::VectorXd across = ratio_ * bending_ * spline_.value_curvature().transpose() * ones;
    for (int i = 0; i < n; ++i) {
        const std::array<double, 3> weights = columns.curvature(i);
        if (weights[1] == 0.0) continue;
        const double bent = columns.apart(i) * path.turn[static_cast<std::size_t>(i)];
        for (int p = 0; p < 3; ++p)
            load.col(i - 1 + p) -= bent * weights[static_cast<std::size_t>(p)] * even;
        load.col(i) -= bent * across;
    }
    return load;
}

}  // namespace beltgrinding

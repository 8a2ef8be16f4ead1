#include "belt_sheet.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;
constexpr int kLocal = BeltSpline::kLocal;

/// A matrix of the splines across, by its seven diagonals: row d of column s is its row s - 3 + d.
using Band = Eigen::Array<double, 2 * kLocal - 1, Eigen::Dynamic>;

Band band_of(const Matrix& matrix) {
    Band band = Band::Zero(2 * kLocal - 1, matrix.cols());
    for (int s = 0; s < matrix.cols(); ++s)
        for (int r = std::max(0, s - kLocal + 1); r < std::min<int>(s + kLocal, matrix.rows()); ++r)
            band(r - s + kLocal - 1, s) = matrix(r, s);
    return band;
}

void add(const Band& band, double factor, Eigen::Map<Matrix, 0, Eigen::OuterStride<>> to) {
    const int m = static_cast<int>(to.cols());
    for (int s = 0; s < m; ++s) {
        const double* from = &band(0, s);
        double* column = to.data() + static_cast<std::ptrdiff_t>(s) * to.outerStride() + s;
        const int low = std::max(0, kLocal - 1 - s),
                  high = std::min(2 * kLocal - 1, m - s + kLocal - 1);
        for (int d = low; d < high; ++d) column[d - kLocal + 1] += factor * from[d];
    }
}

/// A form of the second derivative k along the belt and of the value c itself: 1/2 k' A k + k' B c
/// + 1/2 c' C c.
struct CurvedForm {
    Band a, b, b_transposed;
};

/// Adds A and B of the form in one column.
void add_curved(const BeltColumns& columns, int i, const CurvedForm& form, BlockBanded& matrix) {
    const std::array<double, 3> k = columns.curvature(i);
    if (k[1] == 0.0) return;
    const double h = columns.apart(i);
    for (int q = 0; q < 3; ++q) {
        for (int p = q; p < 3; ++p) {
            const auto to = matrix.block(i - 1 + q, p - q);
            const double kp = k[static_cast<std::size_t>(p)];
            const double kq = k[static_cast<std::size_t>(q)];
            add(form.a, h * kp * kq, to);
            if (q == 1) add(form.b, h * kp, to);
            if (p == 1) add(form.b_transposed, h * kq, to);
        }
    }
}

/// Adds 1/2 s' P s + s' Q (mean of c), s the slope along the belt, at a border. At the ends the
/// belt is held. `even` and `odd`: half of Q + Q' and of Q - Q'.
void add_sloped(const BeltColumns& columns, int border, const Band& p, const Band& even,
                const Band& odd, BlockBanded& matrix) {
    const double square = 1.0 / columns.between[static_cast<std::size_t>(border)];
    const bool first = border == 0, last = border == columns.count();
    if (!last) {
        add(p, square, matrix.block(border, 0));
        if (!first) add(even, 1.0, matrix.block(border, 0));
    }
    if (first) return;
    add(p, square, matrix.block(border - 1, 0));
    if (last) return;
    add(even, -1.0, matrix.block(border - 1, 0));
    // Row: the column behind the border; column: that before it.
    add(p, -square, matrix.block(border - 1, 1));
    add(odd, 1.0, matrix.block(border - 1, 1));
}

/// Values at the spline's places of what has the coefficients `c`; `part` picks value or a
/// derivative.
template <class Part>
Eigen::ArrayXd at_places(const BeltSpline& spline, const Eigen::Ref<const Eigen::VectorXd>& c,
                         Part part) {
    const auto& locals = spline.locals();
    Eigen::ArrayXd result(static_cast<Eigen::Index>(locals.size()));
    for (std::size_t q = 0; q < locals.size(); ++q) {
        const auto& b = part(locals[q]);
        double sum = 0.0;
        for (int r = 0; r < kLocal; ++r)
            sum += b[static_cast<std::size_t>(r)] * c[locals[q].first + r];
        result[static_cast<Eigen::Index>(q)] = sum;
    }
    return result;
}

const auto kValue = [](const BeltSpline::Local& b) -> const auto& {
    return b.value;
};
const auto kSlope = [](const BeltSpline::Local& b) -> const auto& {
    return b.slope;
};
const auto kCurvature = [](const BeltSpline::Local& b) -> const auto& {
    return b.curvature;
};

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

Eigen::VectorXd slope_at(const BeltColumns& columns, const Matrix& c, int border) {
    const double d = columns.between[static_cast<std::size_t>(border)];
    if (border == 0) return c.col(0) / d;
    if (border == columns.count()) return -c.col(border - 1) / d;
    return (c.col(border) - c.col(border - 1)) / d;
}

Eigen::VectorXd curvature_at(const BeltColumns& columns, const Matrix& c, int i) {
    const std::array<double, 3> k = columns.curvature(i);
    if (k[1] == 0.0) return Eigen::VectorXd::Zero(c.rows());
    return k[0] * c.col(i - 1) + k[1] * c.col(i) + k[2] * c.col(i + 1);
}

}  // namespace

BeltSheet::BeltSheet(const AbrasiveBelt& belt, const BeltSpline& spline)
    : bending_(belt.bending()), ratio_(belt.poissons_ratio), spline_(spline) {}

void BeltSheet::stiffness(const BeltColumns& columns, const BeltForces& forces,
                          BlockBanded& matrix) const {
    const int n = columns.count(), m = spline_.count();
    matrix.set_zero();
    const Matrix mixed = ratio_ * bending_ * spline_.value_curvature();
    const CurvedForm form = {band_of(bending_ * spline_.values()), band_of(mixed),
                             band_of(mixed.transpose())};
    const Band c = band_of(bending_ * spline_.curvatures());
    const Band twist = band_of(2.0 * (1.0 - ratio_) * bending_ * spline_.slopes());
    Band own, even(2 * kLocal - 1, m), odd(2 * kLocal - 1, m);
    for (int i = 0; i < n; ++i) {
        own = c;
        integrate(spline_, forces.across.col(i), kSlope, kSlope, own);
        add(own, columns.width[static_cast<std::size_t>(i)], matrix.block(i, 0));
        add_curved(columns, i, form, matrix);
    }
    for (int border = 0; border <= n; ++border) {
        own = twist;
        integrate(spline_, forces.along.col(border), kValue, kValue, own);
        even.setZero();
        integrate(spline_, forces.shear.col(border), kValue, kSlope, even);
        odd = even;
        const Eigen::ArrayXd half = 0.5 * forces.shear.col(border);
        even *= 0.5;
        odd *= 0.5;
        integrate(spline_, half, kSlope, kValue, even);
        integrate(spline_, -half, kSlope, kValue, odd);
        add_sloped(columns, border, own, even, odd, matrix);
    }
}

Eigen::MatrixXd BeltSheet::path_load(const BeltPath& path, const BeltForces& forces) const {
    const BeltColumns& columns = path.columns;
    const int n = columns.count(), m = spline_.count();
    Matrix load = Matrix::Zero(m, n);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(m);
    const Eigen::VectorXd even = bending_ * spline_.values() * ones;
    const Eigen::VectorXd across = ratio_ * bending_ * spline_.value_curvature().transpose() * ones;
    const auto& locals = spline_.locals();
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double by_width = columns.width[k] * path.turn[k];
        const Eigen::ArrayXd along = 0.5 * (forces.along.col(i) + forces.along.col(i + 1));
        for (std::size_t q = 0; q < locals.size(); ++q)
            for (int r = 0; r < kLocal; ++r)
                load(locals[q].first + r, i) += by_width * spline_.weights()[q] *
                                                along[static_cast<Eigen::Index>(q)] *
                                                locals[q].value[static_cast<std::size_t>(r)];
        const std::array<double, 3> weights = columns.curvature(i);
        if (weights[1] == 0.0) continue;
        const double bent = columns.apart(i) * path.turn[k];
        for (int p = 0; p < 3; ++p)
            load.col(i - 1 + p) -= bent * weights[static_cast<std::size_t>(p)] * even;
        load.col(i) -= bent * across;
    }
    return load;
}

BeltStress::BeltStress(const AbrasiveBelt& belt, const BeltSpline& spline, const BeltPath& path)
    : belt_(belt), spline_(spline), path_(path) {
    // (1 - e^2)^2 times Legendre's polynomials of e = 2 y / width, by their coefficients.
    const auto places = static_cast<Eigen::Index>(spline.places().size());
    for (Matrix* m : {&value_, &slope_, &curvature_}) m->setZero(places, kTerms);
    const double by_y = 2.0 / belt.width;
    for (Eigen::Index q = 0; q < places; ++q) {
        const double e = by_y * spline.places()[static_cast<std::size_t>(q)];
        const double edge = (1.0 - e * e) * (1.0 - e * e), edge1 = -4.0 * e * (1.0 - e * e),
                     edge2 = 12.0 * e * e - 4.0;
        // Legendre's recurrence, and its derivatives.
        std::array<double, kTerms> l{1.0, e}, l1{0.0, 1.0}, l2{0.0, 0.0};
        for (std::size_t k = 2; k < kTerms; ++k) {
            const auto d = static_cast<double>(k);
            l[k] = ((2.0 * d - 1.0) * e * l[k - 1] - (d - 1.0) * l[k - 2]) / d;
            l1[k] = l1[k - 2] + (2.0 * d - 1.0) * l[k - 1];
            l2[k] = l2[k - 2] + (2.0 * d - 1.0) * l1[k - 1];
        }
        for (std::size_t k = 0; k < kTerms; ++k) {
            const auto column = static_cast<Eigen::Index>(k);
            value_(q, column) = edge * l[k];
            slope_(q, column) = by_y * (edge1 * l[k] + edge * l1[k]);
            curvature_(q, column) =
                by_y * by_y * (edge2 * l[k] + 2.0 * edge1 * l1[k] + edge * l2[k]);
        }
    }
    const Eigen::Map<const Eigen::VectorXd> weights(spline.weights().data(), places);
    const Matrix a = value_.transpose() * weights.asDiagonal() * value_;
    const Matrix b = value_.transpose() * weights.asDiagonal() * curvature_;
    const Matrix c = curvature_.transpose() * weights.asDiagonal() * curvature_;
    factor_ = BlockBanded(path.columns.count(), kTerms);
    for (int i = 0; i < path.columns.count(); ++i) {
        const double h = path.columns.width[static_cast<std::size_t>(i)];
        factor_.block(i, 0) += h * c;
        const std::array<double, 3> k = path.columns.curvature(i);
        if (k[1] == 0.0) continue;
        const double apart = path.columns.apart(i);
        for (int q = 0; q < 3; ++q) {
            for (int p = q; p < 3; ++p) {
                auto to = factor_.block(i - 1 + q, p - q);
                const double kp = k[static_cast<std::size_t>(p)];
                const double kq = k[static_cast<std::size_t>(q)];
                to += apart * kp * kq * a;
                if (q == 1) to += apart * kp * b;
                if (p == 1) to += apart * kq * b.transpose();
            }
        }
    }
    if (!factor_.factorise()) throw std::logic_error("BeltStress: not positive definite");
}

Eigen::MatrixXd BeltStress::function(const Matrix& deflection) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count();
    const auto places = static_cast<Eigen::Index>(spline_.places().size());
    Eigen::ArrayXXd twist(places, n + 1);
    for (int border = 0; border <= n; ++border)
        twist.col(border) =
            at_places(spline_, slope_at(columns, deflection, border), kSlope).square();
    Matrix right(kTerms, n);
    const Eigen::Map<const Eigen::ArrayXd> weights(spline_.weights().data(), places);
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Eigen::ArrayXd along =
            path_.turn[k] + at_places(spline_, curvature_at(columns, deflection, i), kValue);
        const Eigen::ArrayXd across = at_places(spline_, deflection.col(i), kCurvature);
        const Eigen::ArrayXd gauss = 0.5 * (twist.col(i) + twist.col(i + 1)) - along * across;
        right.col(i) =
            belt_.membrane() * columns.width[k] * (value_.transpose() * (weights * gauss).matrix());
    }
    Matrix all = Eigen::Map<Matrix>(right.data(), right.size(), 1);
    factor_.solve(all);
    return Eigen::Map<Matrix>(all.data(), kTerms, n);
}

Eigen::ArrayXd BeltStress::elongation(const Matrix& deflection) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count();
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(spline_.places().size()));
    for (int border = 0; border <= n; ++border)
        sum += 0.5 * columns.between[static_cast<std::size_t>(border)] *
               at_places(spline_, slope_at(columns, deflection, border), kValue).square();
    Eigen::VectorXd turned = Eigen::VectorXd::Zero(deflection.rows());
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        turned += columns.width[k] * path_.turn[k] * deflection.col(i);
    }
    return sum - at_places(spline_, turned, kValue);
}

BeltForces BeltStress::forces(const Matrix& function, double mean, double lean) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count();
    const auto places = static_cast<Eigen::Index>(spline_.places().size());
    const Eigen::Map<const Eigen::ArrayXd> y(spline_.places().data(), places);
    BeltForces forces;
    forces.along.resize(places, n + 1);
    forces.shear.resize(places, n + 1);
    forces.across.resize(places, n);
    const Eigen::ArrayXd pull = mean + lean * 2.0 / belt_.width * y;
    for (int border = 0; border <= n; ++border) {
        Eigen::VectorXd f = Eigen::VectorXd::Zero(kTerms);
        if (border > 0 && border < n) f = 0.5 * (function.col(border - 1) + function.col(border));
        forces.along.col(border) = pull + (curvature_ * f).array();
        forces.shear.col(border) = -(slope_ * slope_at(columns, function, border)).array();
    }
    for (int i = 0; i < n; ++i)
        forces.across.col(i) = (value_ * curvature_at(columns, function, i)).array();
    return forces;
}

}  // namespace beltgrinding

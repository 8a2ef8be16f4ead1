#include "belt_plate.h"

#include <array>
#include <stdexcept>

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;
constexpr int kLocal = BeltSpline::kLocal;

/// Adds a form of the second derivative along the belt and of the value itself, in one column:
/// 1/2 k' A k + k' B c + 1/2 c' C c, k the second derivative.
void add_curved(const BeltColumns& columns, int i, const Matrix& a, const Matrix& b,
                const Matrix& c, BlockBanded& matrix) {
    const std::array<double, 3> k = columns.curvature(i);
    matrix.block(i, 0) += columns.width[static_cast<std::size_t>(i)] * c;
    if (k[1] == 0.0) return;
    const double h = columns.width[static_cast<std::size_t>(i)];
    for (int q = 0; q < 3; ++q) {
        for (int p = q; p < 3; ++p) {
            auto to = matrix.block(i - 1 + q, p - q);
            const double kp = k[static_cast<std::size_t>(p)], kq = k[static_cast<std::size_t>(q)];
            to += h * kp * kq * a;
            if (q == 1) to += h * kp * b;
            if (p == 1) to += h * kq * b.transpose();
        }
    }
}

/// Adds 1/2 s' P s + s' Q (mean of c), s the slope along the belt, at a border. At the ends the
/// belt is held.
void add_sloped(const BeltColumns& columns, int border, const Matrix& p, const Matrix& q,
                BlockBanded& matrix) {
    const auto k = static_cast<std::size_t>(border);
    const double d = columns.between[k], square = 1.0 / d;  // d times 1 / d^2
    const bool first = border == 0, last = border == columns.count();
    const Matrix own = 0.5 * (q + q.transpose());
    if (!last) {
        auto to = matrix.block(border, 0);
        to += square * p;
        if (!first) to += own;
    }
    if (!first) {
        auto to = matrix.block(border - 1, 0);
        to += square * p;
        if (!last) to -= own;
    }
    // Row: the column behind the border; column: that before it.
    if (!first && !last) matrix.block(border - 1, 1) += -square * p + 0.5 * (q - q.transpose());
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

const auto kValue = [](const BeltSpline::Local& b) -> const auto& { return b.value; };
const auto kSlope = [](const BeltSpline::Local& b) -> const auto& { return b.slope; };
const auto kCurvature = [](const BeltSpline::Local& b) -> const auto& { return b.curvature; };

/// Integral of f times the products of two splines' parts.
template <class Row, class Column, class Values>
void integrate(const BeltSpline& spline, const Values& f, Row row, Column column, Matrix& to) {
    const auto& locals = spline.locals();
    for (std::size_t q = 0; q < locals.size(); ++q) {
        const auto& local = locals[q];
        const auto &a = row(local), &b = column(local);
        const double weight = spline.weights()[q] * f[static_cast<Eigen::Index>(q)];
        for (std::size_t s = 0; s < kLocal; ++s)
            for (std::size_t r = 0; r < kLocal; ++r)
                to(local.first + static_cast<int>(r), local.first + static_cast<int>(s)) +=
                    weight * a[r] * b[s];
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

BeltPlate::BeltPlate(const AbrasiveBelt& belt, const BeltSpline& spline)
    : bending_(belt.bending()), ratio_(belt.poissons_ratio), spline_(spline) {}

void BeltPlate::stiffness(const BeltColumns& columns, const BeltForces& forces,
                          BlockBanded& matrix) const {
    const int n = columns.count(), m = spline_.count();
    matrix.set_zero();
    const Matrix a = bending_ * spline_.values();
    const Matrix b = ratio_ * bending_ * spline_.value_curvature();
    const Matrix c = bending_ * spline_.curvatures();
    const Matrix twist = 2.0 * (1.0 - ratio_) * bending_ * spline_.slopes();
    Matrix own(m, m), p(m, m), q(m, m);
    for (int i = 0; i < n; ++i) {
        own = c;
        integrate(spline_, forces.across.col(i), kSlope, kSlope, own);
        add_curved(columns, i, a, b, own, matrix);
    }
    for (int border = 0; border <= n; ++border) {
        p = twist;
        integrate(spline_, forces.along.col(border), kValue, kValue, p);
        q.setZero();
        integrate(spline_, forces.shear.col(border), kValue, kSlope, q);
        add_sloped(columns, border, p, q, matrix);
    }
}

Eigen::MatrixXd BeltPlate::path_load(const BeltPath& path, const BeltForces& forces) const {
    const BeltColumns& columns = path.columns;
    const int n = columns.count(), m = spline_.count();
    Matrix load = Matrix::Zero(m, n);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(m);
    const Eigen::VectorXd even = bending_ * spline_.values() * ones;
    const Eigen::VectorXd across =
        ratio_ * bending_ * spline_.value_curvature().transpose() * ones;
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
        for (int p = 0; p < 3; ++p)
            load.col(i - 1 + p) -= by_width * weights[static_cast<std::size_t>(p)] * even;
        load.col(i) -= by_width * across;
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
    for (int i = 0; i < path.columns.count(); ++i) add_curved(path.columns, i, a, b, c, factor_);
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
            path_.turn[k] +
            at_places(spline_, curvature_at(columns, deflection, i), kValue);
        const Eigen::ArrayXd across = at_places(spline_, deflection.col(i), kCurvature);
        const Eigen::ArrayXd gauss =
            0.5 * (twist.col(i) + twist.col(i + 1)) - along * across;
        right.col(i) = belt_.membrane() * columns.width[k] *
                       (value_.transpose() * (weights * gauss).matrix());
    }
    Matrix all = Eigen::Map<Matrix>(right.data(), right.size(), 1);
    factor_.solve(all);
    return Eigen::Map<Matrix>(all.data(), kTerms, n);
}

Eigen::ArrayXd BeltStress::elongation(const Matrix& deflection) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count();
    Eigen::ArrayXd sum =
        Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(spline_.places().size()));
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
        forces.shear.col(border) =
            -(slope_ * slope_at(columns, function, border)).array();
    }
    for (int i = 0; i < n; ++i)
        forces.across.col(i) = (value_ * curvature_at(columns, function, i)).array();
    return forces;
}

}  // namespace beltgrinding

#include "belt_stress.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;
constexpr int kLocal = BeltSpline::kLocal;

/// Values at the spline's places of what has the coefficients `c`.
template <class To>
void at_places(const BeltSpline& spline, const double* c,
               const std::array<double, kLocal> BeltSpline::Local::*part, To to) {
    const auto& locals = spline.locals();
    for (std::size_t q = 0; q < locals.size(); ++q) {
        const auto& b = locals[q].*part;
        const double* at = c + locals[q].first;
        to[static_cast<Eigen::Index>(q)] =
            (b[0] * at[0] + b[1] * at[1]) + (b[2] * at[2] + b[3] * at[3]);
    }
}

Eigen::VectorXd slope_at(const BeltColumns& columns, const Matrix& c, int border) {
    const double d = columns.between[static_cast<std::size_t>(border)];
    if (border == 0) return c.col(0) / d;
    if (border == columns.count()) return -c.col(border - 1) / d;
    return (c.col(border) - c.col(border - 1)) / d;
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

BeltStress::BeltStress(const AbrasiveBelt& belt, const BeltSpline& spline, const BeltPath& path,
                       double resting, double stretching, double run_length)
    : membrane_(belt.membrane()),
      width_(belt.width),
      resting_(resting),
      stretching_(stretching),
      leaning_(3.0 * belt.membrane() / (belt.width * run_length)),
      spline_(spline),
      path_(path) {
    // (1 - e^2)^2 times Legendre's polynomials of e = 2 y / width.
    const auto places = static_cast<Eigen::Index>(spline.places().size());
    Terms curvature(kTerms, places);
    value_.resize(kTerms, places);
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
            const auto row = static_cast<Eigen::Index>(k);
            value_(row, q) = edge * l[k];
            curvature(row, q) = by_y * by_y * (edge2 * l[k] + 2.0 * edge1 * l1[k] + edge * l2[k]);
        }
    }
    const Eigen::Map<const Eigen::VectorXd> weights(spline.weights().data(), places);
    const Matrix a = value_ * weights.asDiagonal() * value_.transpose();
    const Matrix b = value_ * weights.asDiagonal() * curvature.transpose();
    const Matrix c = curvature * weights.asDiagonal() * curvature.transpose();
    compliance_ = BlockBanded(path.columns.count(), kTerms);
    for (int i = 0; i < path.columns.count(); ++i) {
        const double h = path.columns.width[static_cast<std::size_t>(i)];
        compliance_.block(i, 0) += h * c;
        const std::array<double, 3> k = path.columns.curvature(i);
        if (k[1] == 0.0) continue;
        const double apart = path.columns.apart(i);
        for (int q = 0; q < 3; ++q) {
            for (int p = q; p < 3; ++p) {
                auto to = compliance_.block(i - 1 + q, p - q);
                const double kp = k[static_cast<std::size_t>(p)];
                const double kq = k[static_cast<std::size_t>(q)];
                to += apart * kp * kq * a;
                if (q == 1) to += apart * kp * b;
                if (p == 1) to += apart * kq * b.transpose();
            }
        }
    }
    factor_ = compliance_;
    if (!factor_.factorise()) throw std::logic_error("BeltStress: not positive definite");
    weighted_ = value_ * weights.asDiagonal();
    bent_.setZero(kTerms, spline.count());
    even_.setZero(spline.count());
    odd_.setZero(spline.count());
    for (Eigen::Index q = 0; q < places; ++q) {
        const BeltSpline::Local& local = spline.locals()[static_cast<std::size_t>(q)];
        const double y = by_y * spline.places()[static_cast<std::size_t>(q)];
        for (std::size_t r = 0; r < kLocal; ++r) {
            const Eigen::Index s = local.first + static_cast<Eigen::Index>(r);
            bent_.col(s) += local.curvature[r] * weighted_.col(q);
            even_[s] += weights[q] * local.value[r];
            odd_[s] += weights[q] * y * local.value[r];
        }
    }
}

BeltStress::Shape BeltStress::shape(const Matrix& deflection) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count();
    const auto places = static_cast<Eigen::Index>(spline_.places().size());
    Shape shape;
    shape.x.resize(places, n + 1);
    shape.xy.resize(places, n + 1);
    shape.xx.resize(places, n);
    shape.yy.resize(places, n);
    for (int border = 0; border <= n; ++border) {
        const Eigen::VectorXd slope = slope_at(columns, deflection, border);
        at_places(spline_, slope.data(), &BeltSpline::Local::value, shape.x.col(border));
        at_places(spline_, slope.data(), &BeltSpline::Local::slope, shape.xy.col(border));
    }
    for (int i = 0; i < n; ++i) {
        at_places(spline_, deflection.col(i).data(), &BeltSpline::Local::curvature,
                  shape.yy.col(i));
        const std::array<double, 3> k = columns.curvature(i);
        if (k[1] == 0.0) {
            shape.xx.col(i).setZero();
            continue;
        }
        const Eigen::VectorXd curvature = k[0] * deflection.col(i - 1) +
                                          k[1] * deflection.col(i) + k[2] * deflection.col(i + 1);
        at_places(spline_, curvature.data(), &BeltSpline::Local::value, shape.xx.col(i));
    }
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
        gauss.col(i) -= 0.5 * columns.apart(i) *
                        (a.xx.col(i) * b.yy.col(i) + b.xx.col(i) * a.yy.col(i));
    strain.function = weighted_ * gauss.matrix();
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
        strain.mean -= turn * even_.dot(deflection.col(i));
        strain.lean -= turn * odd_.dot(deflection.col(i));
        strain.function.col(i) =
            -columns.apart(i) * path_.turn[k] * (bent_ * deflection.col(i));
    }
    return strain;
}

BeltModes BeltStress::stress(const BeltModes& strain) const {
    BeltModes stress;
    Matrix all =
        membrane_ * Eigen::Map<const Matrix>(strain.function.data(), strain.function.size(), 1);
    factor_.solve(all);
    stress.function = Eigen::Map<Matrix>(all.data(), kTerms, strain.function.cols());
    stress.mean = mean_stiffness() * strain.mean;
    stress.lean = lean_stiffness() * strain.lean;
    return stress;
}

BeltForces BeltStress::forces(const BeltModes& stress, double share) const {
    return {pull(stress), share * stress.lean,
            share * (value_.transpose() * stress.function).array()};
}

BeltStress::Coupling BeltStress::coupling(const Shape& shape) const {
    const BeltColumns& columns = path_.columns;
    const int n = columns.count(), m = spline_.count();
    const auto& locals = spline_.locals();
    Coupling coupling;
    coupling.function.setZero(kTerms, 3 * m * n);
    coupling.mean.setZero(m, n);
    coupling.lean.setZero(m, n);
    // Of the function in column i by the deflection in column j.
    const auto to = [&](int i, int j) {
        return coupling.function.middleCols((3 * i + j - i + 1) * m, m);
    };
    Terms first(kTerms, m), second(kTerms, m);
    for (int border = 0; border <= n; ++border) {
        const Share share = share_of(columns, border);
        const double by =
            2.0 * share.length / columns.between[static_cast<std::size_t>(border)];
        first.setZero();
        for (std::size_t q = 0; q < locals.size(); ++q) {
            const auto place = static_cast<Eigen::Index>(q);
            const BeltSpline::Local& local = locals[q];
            const double weighted = spline_.weights()[q] * shape.x(place, border);
            const double leaning = weighted * 2.0 / width_ * spline_.places()[q];
            const double twist = by * shape.xy(place, border);
            for (std::size_t r = 0; r < kLocal; ++r) {
                const Eigen::Index s = local.first + static_cast<Eigen::Index>(r);
                if (border < n) {
                    coupling.mean(s, border) += weighted * local.value[r];
                    coupling.lean(s, border) += leaning * local.value[r];
                }
                if (border > 0) {
                    coupling.mean(s, border - 1) -= weighted * local.value[r];
                    coupling.lean(s, border - 1) -= leaning * local.value[r];
                }
                first.col(s) += twist * local.slope[r] * weighted_.col(place);
            }
        }
        for (int i = share.first; i <= share.last; ++i) {
            if (border > 0) to(i, border - 1) -= first;
            if (border < n) to(i, border) += first;
        }
    }
    for (int i = 0; i < n; ++i) {
        const auto c = static_cast<std::size_t>(i);
        const double width = columns.width[c], apart = columns.apart(i), turn = path_.turn[c];
        coupling.mean.col(i) -= width * turn * even_;
        coupling.lean.col(i) -= width * turn * odd_;
        first.setZero();
        second.setZero();
        for (std::size_t q = 0; q < locals.size(); ++q) {
            const auto place = static_cast<Eigen::Index>(q);
            const BeltSpline::Local& local = locals[q];
            const double xx = apart * (turn + shape.xx(place, i)), yy = apart * shape.yy(place, i);
            for (std::size_t r = 0; r < kLocal; ++r) {
                const Eigen::Index s = local.first + static_cast<Eigen::Index>(r);
                first.col(s) += xx * local.curvature[r] * weighted_.col(place);
                second.col(s) += yy * local.value[r] * weighted_.col(place);
            }
        }
        to(i, i) -= first;
        const std::array<double, 3> k = columns.curvature(i);
        if (k[1] == 0.0) continue;
        for (int p = 0; p < 3; ++p) to(i, i - 1 + p) -= k[static_cast<std::size_t>(p)] * second;
    }
    return coupling;
}

Eigen::MatrixXd BeltStress::resistance(const Coupling& coupling, const BeltModes& stress) const {
    const int n = path_.columns.count(), m = spline_.count();
    Matrix result = pull(stress) * coupling.mean + stress.lean * coupling.lean;
    for (int i = 0; i < n; ++i)
        for (int j = std::max(i - 1, 0); j <= std::min(i + 1, n - 1); ++j)
            result.col(j) += coupling.function.middleCols((3 * i + j - i + 1) * m, m).transpose() *
                             stress.function.col(i);
    return result;
}

void BeltStress::add_to(BlockBanded& matrix, const Coupling& coupling) const {
    const int n = path_.columns.count(), m = spline_.count();
    const auto from = [&](int i, int j) {
        return coupling.function.middleCols((3 * i + j - i + 1) * m, m);
    };
    for (int i = 0; i < n; ++i) {
        for (int below = 0; below < std::min(3, n - i); ++below) {
            auto to = matrix.block(i, below);
            to.topLeftCorner(kTerms, kTerms) -= compliance_.block(i, below) / membrane_;
            if (below > 1) continue;
            // Rows: deflection of column i + below; columns: function of column i.
            to.bottomLeftCorner(m, kTerms) += from(i, i + below).transpose();
            if (below == 1) to.topRightCorner(kTerms, m) += from(i + 1, i);
        }
    }
}

}  // namespace beltgrinding

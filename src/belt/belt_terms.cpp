#include "belt_terms.h"

#include <array>

#include "registers.h"

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;
constexpr int kLocal = BeltSpline::kLocal;
constexpr int kPlaces = BeltSpline::kPlaces;
constexpr int kPadded = BeltTerms::kPadded;

/// What a rule's places have of a spline, by its intervals; see BeltTerms.
struct Part {
    const double* values;
    std::ptrdiff_t intervals;
};

/// Some rows of the moments, as many as a register has. Splines of an interval are summed side by
/// side, and the first one has all of it then.
template <class Vector>
[[gnu::always_inline]] inline void add_moments(const Part& part, const double* weighted,
                                               const double* factors, double* to) {
    const std::ptrdiff_t n = part.intervals;
    Vector sums[kLocal] = {};
    for (std::ptrdiff_t k = 0; k < n; ++k) {
        for (int p = 0; p < kPlaces; ++p) {
            const Vector terms =
                read<Vector>(weighted + (p * n + k) * kPadded) * factors[p * n + k];
            for (int r = 0; r < kLocal; ++r)
                sums[r] += part.values[(p * kLocal + r) * n + k] * terms;
        }
        write<Vector>(to + k * kPadded) = sums[0];
        for (int r = 0; r + 1 < kLocal; ++r) sums[r] = sums[r + 1];
        sums[kLocal - 1] = Vector{};
    }
    for (int r = 0; r + 1 < kLocal; ++r) write<Vector>(to + (n + r) * kPadded) = sums[r];
}

#ifdef BELTGRINDING_CLONES
__attribute__((target("avx512f"))) void moments_512(const Part& part, const double* weighted,
                                                    const double* factors, double* to) {
    add_moments<Eight>(part, weighted, factors, to);
}

__attribute__((target_clones("avx2", "default")))
#endif
void moments_256(const Part& part, const double* weighted, const double* factors, double* to) {
    constexpr int kHalf = kPadded / 2;
    add_moments<Four>(part, weighted, factors, to);
    add_moments<Four>(part, weighted + kHalf, factors, to + kHalf);
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void values_at_places(const Part& part, const double* coefficients, double* to) {
    const std::ptrdiff_t n = part.intervals;
    for (int p = 0; p < kPlaces; ++p) {
        const double* b = part.values + p * kLocal * n;
        double* __restrict__ at = to + p * n;
        for (std::ptrdiff_t k = 0; k < n; ++k)
            at[k] = (b[k] * coefficients[k] + b[n + k] * coefficients[k + 1]) +
                    (b[2 * n + k] * coefficients[k + 2] + b[3 * n + k] * coefficients[k + 3]);
    }
}

/// The splines of an interval side by side, each over all intervals.
#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void add_place_moments(const Part& part, const double* factors, double* to) {
    const std::ptrdiff_t n = part.intervals;
    for (int r = 0; r < kLocal; ++r) {
        const double *b = part.values + r * n, *f = factors;
        double* __restrict__ at = to + r;
        static_assert(kPlaces == 3);
        for (std::ptrdiff_t k = 0; k < n; ++k)
            at[k] +=
                b[k] * f[k] + b[kLocal * n + k] * f[n + k] + b[2 * kLocal * n + k] * f[2 * n + k];
    }
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void sum_terms(const double* values, std::ptrdiff_t count, const double* c,
               double* __restrict__ to) {
    static_assert(BeltTerms::kTerms == 6);
    for (std::ptrdiff_t q = 0; q < count; ++q) {
        const double* v = values + q;
        to[q] = (v[0] * c[0] + v[count] * c[1]) + (v[2 * count] * c[2] + v[3 * count] * c[3]) +
                (v[4 * count] * c[4] + v[5 * count] * c[5]);
    }
}

}  // namespace

BeltTerms::BeltTerms(double width, const BeltSpline& given) : spline(given) {
    // (1 - e^2)^2 times Legendre's polynomials of e = 2 y / width.
    const auto places = static_cast<Eigen::Index>(spline.places().size());
    const int m = spline.count();
    Matrix value(kTerms, places), curvature(kTerms, places);
    const double by_y = 2.0 / width;
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
            value(row, q) = edge * l[k];
            curvature(row, q) = by_y * by_y * (edge2 * l[k] + 2.0 * edge1 * l1[k] + edge * l2[k]);
        }
    }
    const Eigen::Map<const Eigen::VectorXd> weights(spline.weights().data(), places);
    value_value = value * weights.asDiagonal() * value.transpose();
    value_curvature = value * weights.asDiagonal() * curvature.transpose();
    curvature_curvature = curvature * weights.asDiagonal() * curvature.transpose();
    weighted.setZero(kPadded, places);
    weighted.topRows(kTerms) = value * weights.asDiagonal();
    weighted.row(kEven) = weights.transpose();
    bent.setZero(kPadded, m);
    even.setZero(m);
    odd.setZero(m);
    for (Matrix* bands : {&along, &across, &twisted})
        bands->setZero(BeltBands::kDiagonals * m, kTerms);
    Matrix leans = Matrix::Zero(m, m);
    for (Eigen::Index q = 0; q < places; ++q) {
        const BeltSpline::Local& local = spline.locals()[static_cast<std::size_t>(q)];
        const double y = by_y * spline.places()[static_cast<std::size_t>(q)];
        weighted(kOdd, q) = weights[q] * y;
        for (std::size_t c = 0; c < kLocal; ++c) {
            const Eigen::Index s = local.first + static_cast<Eigen::Index>(c);
            bent.col(s) += local.curvature[c] * weighted.col(q);
            even[s] += weights[q] * local.value[c];
            odd[s] += weights[q] * y * local.value[c];
            for (std::size_t r = 0; r < kLocal; ++r) {
                const Eigen::Index row = local.first + static_cast<Eigen::Index>(r);
                const Eigen::Index at = (row - s + kLocal - 1) * m + s;
                const auto terms = weighted.col(q).head<kTerms>().transpose();
                along.row(at) += local.value[r] * local.curvature[c] * terms;
                across.row(at) += local.curvature[r] * local.value[c] * terms;
                twisted.row(at) += local.slope[r] * local.slope[c] * terms;
                leans(row, s) += weights[q] * y * local.value[r] * local.value[c];
            }
        }
    }
    by_place = weighted.topRows<kTerms>().transpose();
    const Eigen::Index intervals = places / BeltSpline::kPlaces;
    for (Eigen::ArrayXXd& part : parts_) part.resize(intervals, BeltSpline::kPlaces * kLocal);
    for (Eigen::Index q = 0; q < places; ++q) {
        const BeltSpline::Local& local = spline.locals()[static_cast<std::size_t>(q)];
        const Eigen::Index k = q % intervals, first = q / intervals * kLocal;
        for (Eigen::Index r = 0; r < kLocal; ++r) {
            const auto at = static_cast<std::size_t>(r);
            parts_[0](k, first + r) = local.value[at];
            parts_[1](k, first + r) = local.slope[at];
            parts_[2](k, first + r) = local.curvature[at];
        }
    }
    stretched = BeltBands::band_of(spline.values());
    leaning = BeltBands::band_of(leans);
}

void BeltTerms::moments(Of part, const double* factors, double* to) const {
    const Eigen::ArrayXXd& of = parts_[static_cast<std::size_t>(part)];
    const Part given = {of.data(), of.rows()};
#ifdef BELTGRINDING_CLONES
    if (__builtin_cpu_supports("avx512f")) return moments_512(given, weighted.data(), factors, to);
#endif
    moments_256(given, weighted.data(), factors, to);
}

void BeltTerms::add_moments(Of part, const double* factors, double* to) const {
    const Eigen::ArrayXXd& of = parts_[static_cast<std::size_t>(part)];
    add_place_moments({of.data(), of.rows()}, factors, to);
}

void BeltTerms::sum(const Matrix& by_term, const Eigen::Ref<const Eigen::VectorXd>& terms,
                    double* to) {
    sum_terms(by_term.data(), by_term.rows(), terms.data(), to);
}

void BeltTerms::at_places(Of part, const Matrix& coefficients, Eigen::ArrayXXd& to) const {
    const Eigen::ArrayXXd& of = parts_[static_cast<std::size_t>(part)];
    to.resize(kPlaces * of.rows(), coefficients.cols());
    for (Eigen::Index i = 0; i < coefficients.cols(); ++i)
        values_at_places({of.data(), of.rows()}, coefficients.col(i).data(), to.col(i).data());
}

}  // namespace beltgrinding

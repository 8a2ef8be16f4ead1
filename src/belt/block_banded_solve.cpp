// What a factor makes of right-hand sides.
#include <algorithm>

#include "block_banded.h"
#include "block_banded_factor.h"
#include "registers.h"

namespace beltgrinding {
namespace {

constexpr int kEight = 8;  // rows that sums are made of apart

/// The square of the columns from `first` to `end` at the top of a panel, for several right-hand
/// sides.
template <int together>
[[gnu::always_inline]] inline void substitute_square(const double* l, std::ptrdiff_t height,
                                                     const double* inverse, int first, int end,
                                                     double* x, std::ptrdiff_t length) {
    if constexpr (together == kTogether) {
        static_assert(kTogether == 4);
        Four own[kWidest];
        for (int k = first; k < end; ++k)
            own[k - first] = Four{x[k], x[length + k], x[2 * length + k], x[3 * length + k]};
        for (int k = first; k < end; ++k) {
            const double* column = l + k * height;
            const Four value = own[k - first] *= inverse[k];
            for (int r = k + 1; r < end; ++r) own[r - first] -= value * column[r];
        }
        for (int k = first; k < end; ++k)
            for (int c = 0; c < together; ++c) x[c * length + k] = own[k - first][c];
    } else {
        for (int c = 0; c < together; ++c) {
            double* own = x + c * length;
            for (int k = first; k < end; ++k) {
                const double* column = l + k * height;
                const double value = own[k] *= inverse[k];
                for (int r = k + 1; r < end; ++r) own[r] -= value * column[r];
            }
        }
    }
}

/// Solves by the factor's left half for several right-hand sides, `length` apart.
template <class Vector, int together>
[[gnu::always_inline]] inline void substitute_forward(const Factor& factor, double* values,
                                                      std::ptrdiff_t length) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    const int m = factor.size;
    for (int i = factor.begin; i < factor.count; ++i) {
        const double* l = factor.blocks + i * factor.height * m;
        const double* inverse = factor.inverse + std::ptrdiff_t{i} * m;
        double* x = values + std::ptrdiff_t{i} * m;
        for (int first = 0, end = 0; first < m; first = end) {
            end = factor.end(first);
            substitute_square<together>(l, factor.height, inverse, first, end, x, length);
            // Whole registers: the panel has zeros below its rows.
            const int rows = factor.rows(i, end, kLanes);
            int row = end;
            for (; row + kLanes <= rows; row += kLanes) {
                Vector left[together];
                for (int c = 0; c < together; ++c) left[c] = read<Vector>(x + c * length + row);
                for (int k = first; k < end; ++k) {
                    const Vector from = read<Vector>(l + k * factor.height + row);
                    for (int c = 0; c < together; ++c) left[c] -= from * x[c * length + k];
                }
                for (int c = 0; c < together; ++c) write<Vector>(x + c * length + row) = left[c];
            }
            for (; row < rows; ++row)
                for (int c = 0; c < together; ++c)
                    for (int k = first; k < end; ++k)
                        x[c * length + row] -= l[k * factor.height + row] * x[c * length + k];
        }
    }
}

template <class Vector>
[[gnu::always_inline]] inline void substitute_forward(const Factor& factor, double* values,
                                                      std::ptrdiff_t length, int count) {
    int c = 0;
    for (; c + kTogether <= count; c += kTogether)
        substitute_forward<Vector, kTogether>(factor, values + c * length, length);
    for (; c < count; ++c) substitute_forward<Vector, 1>(factor, values + c * length, length);
}

#ifdef BELTGRINDING_CLONES
__attribute__((target("avx512f"))) void forward_512(const Factor& factor, double* values,
                                                    std::ptrdiff_t length, int count) {
    substitute_forward<Eight>(factor, values, length, count);
}

__attribute__((target_clones("avx2", "default")))
#endif
void forward_256(const Factor& factor, double* values, std::ptrdiff_t length, int count) {
    substitute_forward<Four>(factor, values, length, count);
}

/// The sums over the rows from `row` to `rows` of some columns times x.
template <class Vector, int width>
[[gnu::always_inline]] inline void dot_columns(const double* l, std::ptrdiff_t height,
                                               const double* x, int row, int rows, double* sums) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double), kParts = kEight / kLanes;
    Vector sum[width][kParts] = {};
    for (; row + kEight <= rows; row += kEight) {
        for (int p = 0; p < kParts; ++p) {
            const Vector value = read<Vector>(x + row + p * kLanes);
            for (int k = 0; k < width; ++k)
                sum[k][p] += read<Vector>(l + k * height + row + p * kLanes) * value;
        }
    }
    for (int k = 0; k < width; ++k) {
        double lanes[kEight];
        for (int p = 0; p < kEight; ++p) lanes[p] = sum[k][p / kLanes][p % kLanes];
        double rest = ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
                      ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
        for (int r = row; r < rows; ++r) rest += l[k * height + r] * x[r];
        sums[k] = rest;
    }
}

/// Solves by the factor's right half.
template <class Vector>
[[gnu::always_inline]] inline void substitute_backward(const Factor& factor, double* values) {
    const int m = factor.size;
    for (int i = factor.count; i-- > 0;) {
        const double* l = factor.blocks + i * factor.height * m;
        const double* inverse = factor.inverse + std::ptrdiff_t{i} * m;
        double* x = values + std::ptrdiff_t{i} * m;
        for (int end = m; end > 0;) {
            const int first =
                end > factor.negative
                    ? factor.negative + (end - 1 - factor.negative) / kWidest * kWidest
                    : (end - 1) / kWidest * kWidest;
            const double* columns = l + first * factor.height;
            const int rows = factor.rows(i, end, kEight);
            double sums[kWidest];
            if (end - first == kWidest)
                dot_columns<Vector, kWidest>(columns, factor.height, x, end, rows, sums);
            else
                for (int k = first; k < end; ++k)
                    dot_columns<Vector, 1>(l + k * factor.height, factor.height, x, end, rows,
                                           sums + (k - first));
            const double sign = first < factor.negative ? -1.0 : 1.0;
            for (int k = end; k-- > first;) {
                const double* column = l + k * factor.height;
                double sum = sums[k - first];
                for (int r = k + 1; r < end; ++r) sum += column[r] * x[r];
                x[k] = (sign * x[k] - sum) * inverse[k];
            }
            end = first;
        }
    }
}

#ifdef BELTGRINDING_CLONES
__attribute__((target("avx512f"))) void backward_512(const Factor& factor, double* values) {
    substitute_backward<Eight>(factor, values);
}

__attribute__((target_clones("avx2", "default")))
#endif
void backward_256(const Factor& factor, double* values) {
    substitute_backward<Four>(factor, values);
}

}  // namespace

void BlockBanded::forward(Eigen::Ref<Eigen::MatrixXd> values, int first) const {
    const Factor factor = {blocks_.data(), inverse_.data(), count_,  size_,
                           negative_,      reach_,          height_, first};
    const auto count = static_cast<int>(values.cols());
#ifdef BELTGRINDING_CLONES
    if (__builtin_cpu_supports("avx512f"))
        return forward_512(factor, values.data(), values.outerStride(), count);
#endif
    forward_256(factor, values.data(), values.outerStride(), count);
}

void BlockBanded::backward(Eigen::MatrixXd& values) const {
    const Factor factor = {blocks_.data(), inverse_.data(), count_, size_,
                           negative_,      reach_,          height_};
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
#ifdef BELTGRINDING_CLONES
        if (__builtin_cpu_supports("avx512f")) {
            backward_512(factor, values.col(c).data());
            continue;
        }
#endif
        backward_256(factor, values.col(c).data());
    }
}

namespace {

template <class Vector>
[[gnu::always_inline]] inline void product_column(const double* a, std::ptrdiff_t length,
                                                  int columns, const double* x, int rows,
                                                  double* to) {
    int c = 0;
    for (; c + kTogether <= columns; c += kTogether)
        dot_columns<Vector, kTogether>(a + c * length, length, x, 0, rows, to + c);
    for (; c < columns; ++c) dot_columns<Vector, 1>(a + c * length, length, x, 0, rows, to + c);
}

#ifdef BELTGRINDING_CLONES
__attribute__((target("avx512f"))) void product_column_512(const double* a, std::ptrdiff_t length,
                                                           int columns, const double* x, int rows,
                                                           double* to) {
    product_column<Eight>(a, length, columns, x, rows, to);
}

__attribute__((target_clones("avx2", "default")))
#endif
void product_column_256(const double* a, std::ptrdiff_t length, int columns, const double* x,
                        int rows, double* to) {
    product_column<Four>(a, length, columns, x, rows, to);
}

}  // namespace

Eigen::MatrixXd BlockBanded::products(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                      const Eigen::Ref<const Eigen::MatrixXd>& b) const {
    Eigen::MatrixXd result(a.cols(), b.cols());
    std::vector<double> signed_rows(static_cast<std::size_t>(a.rows()));
    const auto columns = static_cast<int>(a.cols()), rows = static_cast<int>(a.rows());
    for (Eigen::Index c = 0; c < b.cols(); ++c) {
        double* x = signed_rows.data();
        std::copy_n(b.col(c).data(), rows, x);
        for (int block = 0; block < rows; block += size_)
            for (int r = block; r < block + negative_; ++r) x[r] = -x[r];
        double* to = result.col(c).data();
#ifdef BELTGRINDING_CLONES
        if (__builtin_cpu_supports("avx512f")) {
            product_column_512(a.data(), a.outerStride(), columns, x, rows, to);
            continue;
        }
#endif
        product_column_256(a.data(), a.outerStride(), columns, x, rows, to);
    }
    return result;
}

void BlockBanded::solve(Eigen::MatrixXd& values) const {
    forward(values);
    backward(values);
}

}  // namespace beltgrinding

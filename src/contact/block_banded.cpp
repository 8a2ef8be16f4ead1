#include "block_banded.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace beltgrinding {
namespace {

using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));
constexpr int kFour = 4;
constexpr int kStrip = 4;  // registers of a column that are summed at a time
constexpr int kPair = 2;   // columns that share what is loaded

/// to[rows, columns] -= L[rows, :] L[columns, :]', `pairs` columns of one strip of so many
/// `Vector`s of rows; both have the outer stride `height`.
template <class Vector, int vectors, int pairs>
[[gnu::always_inline]] inline void subtract_strip(const double* l, std::ptrdiff_t height, int depth,
                                                  int row, int column, double* to,
                                                  std::ptrdiff_t to_height, double sign) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    Vector sum[pairs][vectors] = {};
    for (int k = 0; k < depth; ++k) {
        const double* from = l + k * height;
        Vector values[vectors];
        for (int v = 0; v < vectors; ++v)
            std::memcpy(&values[v], from + row + v * kLanes, sizeof(Vector));
        for (int p = 0; p < pairs; ++p)
            for (int v = 0; v < vectors; ++v) sum[p][v] += values[v] * from[column + p];
    }
    for (int p = 0; p < pairs; ++p) {
        double* at = to + (column + p) * to_height + row;
        for (int v = 0; v < vectors; ++v) {
            Vector old;
            std::memcpy(&old, at + v * kLanes, sizeof(Vector));
            old -= sign * sum[p][v];
            std::memcpy(at + v * kLanes, &old, sizeof(Vector));
        }
    }
}

/// `strip` vectors of rows at a time, then one, then single registers of four.
template <class Vector, int strip, int pairs>
[[gnu::always_inline]] inline void subtract_columns(const double* l, std::ptrdiff_t height,
                                                    int depth, int first_row, int rows, int column,
                                                    double* to, std::ptrdiff_t to_height,
                                                    double sign) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    int row = first_row;
    for (; row + strip * kLanes <= rows; row += strip * kLanes)
        subtract_strip<Vector, strip, pairs>(l, height, depth, row, column, to, to_height, sign);
    for (; row + kLanes <= rows; row += kLanes)
        subtract_strip<Vector, 1, pairs>(l, height, depth, row, column, to, to_height, sign);
    for (; row < rows; row += kFour)
        subtract_strip<Four, 1, pairs>(l, height, depth, row, column, to, to_height, sign);
}

/// The lower triangle of to -= L L', for the columns from `first` to `end`; rows are padded to a
/// multiple of four.
template <class Vector, int strip>
[[gnu::always_inline]] inline void subtract_triangle(const double* l, std::ptrdiff_t height,
                                                     int depth, int rows, int first, int end,
                                                     double* to, std::ptrdiff_t to_height,
                                                     double sign) {
    int column = first;
    for (; column + kPair <= end; column += kPair)
        subtract_columns<Vector, strip, kPair>(l, height, depth, column / kFour * kFour, rows,
                                               column, to, to_height, sign);
    for (; column < end; ++column)
        subtract_columns<Vector, strip, 1>(l, height, depth, column / kFour * kFour, rows, column,
                                           to, to_height, sign);
}

// GCC's spelling of clones, which Clang does not read; and the sanitizers are not yet there when
// the loader chooses between them.
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define BELTGRINDING_AVX
#endif

#ifdef BELTGRINDING_AVX
__attribute__((target("avx512f"))) void subtract_square_512(const double* l, std::ptrdiff_t height,
                                                            int depth, int rows, int first, int end,
                                                            double* to, std::ptrdiff_t to_height,
                                                            double sign) {
    subtract_triangle<Eight, kStrip>(l, height, depth, rows, first, end, to, to_height, sign);
}

__attribute__((target_clones("avx2", "default")))
#endif
void subtract_square_256(const double* l, std::ptrdiff_t height, int depth, int rows, int first,
                         int end, double* to, std::ptrdiff_t to_height, double sign) {
    subtract_triangle<Four, kStrip>(l, height, depth, rows, first, end, to, to_height, sign);
}

void subtract_square(const double* l, std::ptrdiff_t height, int depth, int rows, int first,
                     int end, double* to, std::ptrdiff_t to_height, double sign) {
#ifdef BELTGRINDING_AVX
    if (__builtin_cpu_supports("avx512f"))
        return subtract_square_512(l, height, depth, rows, first, end, to, to_height, sign);
#endif
    subtract_square_256(l, height, depth, rows, first, end, to, to_height, sign);
}

/// Cholesky's factor of the columns from `first` to `end` of a panel, all of one sign, and what
/// that makes of the rows below.
#ifdef BELTGRINDING_AVX
__attribute__((target_clones("avx2", "default")))
#endif
bool factorise_columns(double* panel, std::ptrdiff_t height, int first, int end, int rows,
                       double sign) {
    for (int j = first; j < end; ++j) {
        double* column = panel + j * height;
        for (int k = first; k < j; ++k) {
            const double* before = panel + k * height;
            const double factor = sign * before[j];
            for (int r = j; r < rows; ++r) column[r] -= factor * before[r];
        }
        const double pivot = sign * column[j];
        if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
        const double inverse = sign / std::sqrt(pivot);
        for (int r = j; r < rows; ++r) column[r] *= inverse;
    }
    return true;
}

constexpr int kBlock = 8;  // columns of a panel that are factorised at a time

}  // namespace

BlockBanded::BlockBanded(int count, int size, int negative)
    : count_(count),
      size_(size),
      negative_(negative),
      height_((3 * size + kFour - 1) / kFour * kFour) {
    blocks_.assign(static_cast<std::size_t>(count) * static_cast<std::size_t>(height_) *
                       static_cast<std::size_t>(size),
                   0.0);
}

void BlockBanded::set_zero() {
    std::fill(blocks_.begin(), blocks_.end(), 0.0);
}

bool BlockBanded::factorise() {
    const int m = size_;
    const auto padded = [](int rows) { return (rows + kFour - 1) / kFour * kFour; };
    // to -= L J L', of the columns of L before `end_depth`.
    const auto subtract = [this](const double* l, std::ptrdiff_t height, int depth, int rows,
                                 int first, int end, double* to) {
        const int less = std::min(negative_, depth);
        if (less > 0) subtract_square(l, height, less, rows, first, end, to, height, -1.0);
        if (depth > less)
            subtract_square(l + less * height, height, depth - less, rows, first, end, to, height,
                            1.0);
    };
    for (int i = 0; i < count_; ++i) {
        double* own = panel(i);
        for (int first = 0, end = 0; first < m; first = end) {
            const bool less = first < negative_;
            end = std::min(first + kBlock, less ? negative_ : m);
            if (first > 0) subtract(own, height_, first, height_, first, end, own);
            if (!factorise_columns(own, height_, first, end, height_, less ? -1.0 : 1.0))
                return false;
        }
        // What is left of the two panels behind: their blocks (0, 0), (1, 0) and (1, 1).
        const int behind = std::min(2, count_ - 1 - i);
        if (behind == 0) break;
        const int rows = padded(behind * m);
        corner_.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(behind * m), 0.0);
        // The rows from m on need not start at a whole register.
        shifted_.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(m));
        for (int k = 0; k < m; ++k) {
            double* to = shifted_.data() + std::ptrdiff_t{k} * rows;
            std::copy_n(own + std::ptrdiff_t{k} * height_ + m, behind * m, to);
            std::fill(to + behind * m, to + rows, 0.0);
        }
        subtract(shifted_.data(), rows, m, rows, 0, behind * m, corner_.data());
        const auto add = [&](int row, int column, double* to) {
            for (int k = 0; k < m; ++k) {
                const double* from = corner_.data() + (std::ptrdiff_t{column} * m + k) * rows +
                                     std::ptrdiff_t{row} * m;
                double* at = to + std::ptrdiff_t{k} * height_;
                for (int r = row == column ? k : 0; r < m; ++r) at[r] += from[r];
            }
        };
        add(0, 0, panel(i + 1));
        if (behind == 2) {
            add(1, 0, panel(i + 1) + m);
            add(1, 1, panel(i + 2));
        }
    }
    return true;
}

void BlockBanded::solve(Eigen::MatrixXd& values) const {
    const int m = size_;
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
        double* x = values.data() + c * values.rows();
        for (int i = 0; i < count_; ++i) {
            const int rows = m * std::min(3, count_ - i);
            double* at = x + std::ptrdiff_t{i} * m;
            for (int k = 0; k < m; ++k) {
                const double* column = panel(i) + std::ptrdiff_t{k} * height_;
                const double value = at[k] /= column[k];
                for (int r = k + 1; r < rows; ++r) at[r] -= value * column[r];
            }
        }
        for (int i = count_; i-- > 0;) {
            const int rows = m * std::min(3, count_ - i);
            double* at = x + std::ptrdiff_t{i} * m;
            for (int k = 0; k < negative_; ++k) at[k] = -at[k];
            for (int k = m; k-- > 0;) {
                const double* column = panel(i) + std::ptrdiff_t{k} * height_;
                const Eigen::Map<const Eigen::VectorXd> below(column + k + 1, rows - k - 1);
                const Eigen::Map<const Eigen::VectorXd> known(at + k + 1, rows - k - 1);
                at[k] = (at[k] - below.dot(known)) / column[k];
            }
        }
    }
}

}  // namespace beltgrinding

#include "block_banded.h"

#include <algorithm>
#include <cmath>

#include "registers.h"

namespace beltgrinding {
namespace {

constexpr int kFour = 4;
constexpr int kStrip = 4;  // registers of a column that are summed at a time
constexpr int kPair = 2;   // columns that share what is loaded

/// The lower triangle of to -= sign L L', for the columns from `first` to `end`; both have the
/// outer stride `height`, and rows are padded to a multiple of four.
struct Update {
    const double* l;
    std::ptrdiff_t height;
    int depth;  // columns of L
    int rows, first, end;
    double* to;
    double sign;
    int full;  // row k + full of L and those below are 0 in the columns before k
};

/// `pairs` columns of one strip of so many `Vector`s of rows.
template <class Vector, int vectors, int pairs>
[[gnu::always_inline]] inline void subtract_strip(const Update& update, int row, int column) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    Vector sum[pairs][vectors] = {};
    for (int k = std::max(0, row - update.full); k < update.depth; ++k) {
        const double* from = update.l + k * update.height;
        Vector values[vectors];
        for (int v = 0; v < vectors; ++v) values[v] = read<Vector>(from + row + v * kLanes);
        for (int p = 0; p < pairs; ++p)
            for (int v = 0; v < vectors; ++v) sum[p][v] += values[v] * from[column + p];
    }
    for (int p = 0; p < pairs; ++p) {
        double* at = update.to + (column + p) * update.height + row;
        for (int v = 0; v < vectors; ++v) write<Vector>(at + v * kLanes) -= update.sign * sum[p][v];
    }
}

/// `strip` vectors of rows at a time, then one, then single registers of four.
template <class Vector, int strip, int pairs>
[[gnu::always_inline]] inline void subtract_columns(const Update& update, int column) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    int row = column / kFour * kFour;
    for (; row + strip * kLanes <= update.rows; row += strip * kLanes)
        subtract_strip<Vector, strip, pairs>(update, row, column);
    for (; row + kLanes <= update.rows; row += kLanes)
        subtract_strip<Vector, 1, pairs>(update, row, column);
    for (; row < update.rows; row += kFour) subtract_strip<Four, 1, pairs>(update, row, column);
}

template <class Vector, int strip>
[[gnu::always_inline]] inline void subtract_triangle(const Update& update) {
    int column = update.first;
    for (; column + kPair <= update.end; column += kPair)
        subtract_columns<Vector, strip, kPair>(update, column);
    for (; column < update.end; ++column) subtract_columns<Vector, strip, 1>(update, column);
}

#ifdef BELTGRINDING_CLONES
__attribute__((target("avx512f"))) void subtract_square_512(const Update& update) {
    subtract_triangle<Eight, kStrip>(update);
}

__attribute__((target_clones("avx2", "default")))
#endif
void subtract_square_256(const Update& update) {
    subtract_triangle<Four, kStrip>(update);
}

void subtract_square(const Update& update) {
#ifdef BELTGRINDING_CLONES
    if (__builtin_cpu_supports("avx512f")) return subtract_square_512(update);
#endif
    subtract_square_256(update);
}

/// Cholesky's factor of the columns from `first` to `end` of a panel, all of one sign, and what
/// that makes of the rows below.
#ifdef BELTGRINDING_CLONES
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

/// A factor's panels, one behind the other.
struct Factor {
    const double* blocks;
    int count, size, negative, reach;
    std::ptrdiff_t height;

    /// Rows of column k of panel i that may not be 0.
    int rows(int i, int k) const {
        const int two = size * std::min(2, count - i);
        return i + 2 < count ? two + std::min(size, std::max(k + reach + 1, negative)) : two;
    }
};

constexpr int kEight = 8;
constexpr int kTogether = 4;  // right-hand sides that are solved for at a time

/// The sums of L[:, from to end]' x of several right-hand sides, `length` apart.
template <int together>
[[gnu::always_inline]] inline void add_dots(const double* column, const double* x,
                                            std::ptrdiff_t length, int from, int end,
                                            double* sums) {
    Eight sum[together] = {};
    int r = from;
    for (; r + kEight <= end; r += kEight) {
        const Eight l = read<Eight>(column + r);
        for (int c = 0; c < together; ++c) sum[c] += l * read<Eight>(x + c * length + r);
    }
    for (int c = 0; c < together; ++c) {
        double rest = ((sum[c][0] + sum[c][1]) + (sum[c][2] + sum[c][3])) +
                      ((sum[c][4] + sum[c][5]) + (sum[c][6] + sum[c][7]));
        for (int k = r; k < end; ++k) rest += column[k] * x[c * length + k];
        sums[c] += rest;
    }
}

/// Solves by the factor for several right-hand sides, `length` apart.
template <int together>
[[gnu::always_inline]] inline void substitute(const Factor& factor, double* values,
                                              std::ptrdiff_t length) {
    const int m = factor.size;
    const std::ptrdiff_t height = factor.height;
    for (int i = 0; i < factor.count; ++i) {
        const double* l = factor.blocks + std::ptrdiff_t{i} * height * m;
        double* x = values + std::ptrdiff_t{i} * m;
        const int rows = m * std::min(3, factor.count - i);
        for (int k = 0; k < m; ++k) {
            const double* column = l + k * height;
            for (int c = 0; c < together; ++c) {
                double* own = x + c * length;
                const double value = own[k] /= column[k];
                for (int r = k + 1; r < m; ++r) own[r] -= value * column[r];
            }
        }
        int row = m;
        for (; row + kEight <= rows; row += kEight) {
            Eight left[together];
            for (int c = 0; c < together; ++c) left[c] = read<Eight>(x + c * length + row);
            for (int k = row < 2 * m + factor.negative ? 0
                                                       : std::max(0, row - 2 * m - factor.reach);
                 k < m; ++k) {
                const Eight from = read<Eight>(l + k * height + row);
                for (int c = 0; c < together; ++c) left[c] -= from * x[c * length + k];
            }
            for (int c = 0; c < together; ++c) write<Eight>(x + c * length + row) = left[c];
        }
        for (; row < rows; ++row)
            for (int c = 0; c < together; ++c)
                for (int k = 0; k < m; ++k)
                    x[c * length + row] -= l[k * height + row] * x[c * length + k];
    }
    for (int i = factor.count; i-- > 0;) {
        const double* l = factor.blocks + std::ptrdiff_t{i} * height * m;
        double* x = values + std::ptrdiff_t{i} * m;
        for (int k = m; k-- > 0;) {
            const double* column = l + k * height;
            double sums[together] = {};
            add_dots<together>(column, x, length, m, factor.rows(i, k), sums);
            add_dots<together>(column, x, length, k + 1, m, sums);
            const double sign = k < factor.negative ? -1.0 : 1.0;
            for (int c = 0; c < together; ++c)
                x[c * length + k] = (sign * x[c * length + k] - sums[c]) / column[k];
        }
    }
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void substitute_four(const Factor& factor, double* values, std::ptrdiff_t length) {
    substitute<kTogether>(factor, values, length);
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void substitute_one(const Factor& factor, double* values, std::ptrdiff_t length) {
    substitute<1>(factor, values, length);
}

constexpr int kBlock = 8;  // columns of a panel that are factorised at a time

}  // namespace

BlockBanded::BlockBanded(int count, int size, int negative, int reach)
    : count_(count),
      size_(size),
      negative_(negative),
      reach_(std::min(reach, size)),
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
    // `second`: the row of L at which the second block below begins.
    const auto subtract = [this](const double* l, std::ptrdiff_t height, int depth, int rows,
                                 int first, int end, double* to, int second) {
        const int less = std::min(negative_, depth);
        if (less > 0)
            subtract_square({l, height, less,
                             std::min(rows, (second + negative_ + kFour - 1) / kFour * kFour),
                             first, end, to, -1.0, second + reach_ + negative_});
        if (depth > less)
            subtract_square({l + less * height, height, depth - less, rows, first, end, to, 1.0,
                             second + reach_ + negative_});
    };
    for (int i = 0; i < count_; ++i) {
        double* own = panel(i);
        for (int first = 0, end = 0; first < m; first = end) {
            const bool less = first < negative_;
            end = std::min(first + kBlock, less ? negative_ : m);
            const int rows = padded(rows_of(end - 1));
            if (first > 0) subtract(own, height_, first, rows, first, end, own, 2 * m);
            if (!factorise_columns(own, height_, first, end, rows, less ? -1.0 : 1.0)) return false;
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
        subtract(shifted_.data(), rows, m, rows, 0, behind * m, corner_.data(), m);
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
    for (Eigen::Index c = 0; c < values.cols();) {
        const bool together = c + kTogether <= values.cols();
        const Factor factor = {blocks_.data(), count_, size_, negative_, reach_, height_};
        (together ? substitute_four : substitute_one)(factor, values.col(c).data(), values.rows());
        c += together ? kTogether : 1;
    }
}

}  // namespace beltgrinding

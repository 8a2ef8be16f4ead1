#include "block_banded.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "registers.h"

namespace beltgrinding {
namespace {

constexpr int kEight = 8;     // rows that sums are made of apart
constexpr int kWidest = 8;    // columns of a panel that are factorised at a time
constexpr int kTogether = 4;  // columns, or right-hand sides, that share what is loaded

/// Columns of a factor that have been found, of which products are taken from those that are next:
/// `l` is the row of the first of these, columns before `positive` are of negative rows.
struct Source {
    const double* l;
    std::ptrdiff_t height;
    int begin, positive, end;
};

/// to -= the sum of L J L' over the sources, in some columns from `column` on and the rows of some
/// registers from `row` on.
struct Update {
    std::array<Source, 3> sources;
    int count;
    double* to;
    std::ptrdiff_t height;
};

template <class Vector, int vectors, int columns>
[[gnu::always_inline]] inline void subtract(const Update& update, int row, int column) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    Vector sum[columns][vectors] = {};
    for (int s = 0; s < update.count; ++s) {
        const Source& source = update.sources[static_cast<std::size_t>(s)];
        const double* from = source.l + source.begin * source.height;
        int k = source.begin;
        for (; k < source.positive; ++k, from += source.height) {
            Vector values[vectors];
            for (int v = 0; v < vectors; ++v) values[v] = read<Vector>(from + row + v * kLanes);
            for (int c = 0; c < columns; ++c)
                for (int v = 0; v < vectors; ++v) sum[c][v] -= values[v] * from[column + c];
        }
        for (; k < source.end; ++k, from += source.height) {
            Vector values[vectors];
            for (int v = 0; v < vectors; ++v) values[v] = read<Vector>(from + row + v * kLanes);
            for (int c = 0; c < columns; ++c)
                for (int v = 0; v < vectors; ++v) sum[c][v] += values[v] * from[column + c];
        }
    }
    for (int c = 0; c < columns; ++c) {
        double* at = update.to + (column + c) * update.height + row;
        for (int v = 0; v < vectors; ++v) write<Vector>(at + v * kLanes) -= sum[c][v];
    }
}

template <class Vector, int vectors>
[[gnu::always_inline]] inline void subtract_rows(const Update& update, int row, int first,
                                                 int end) {
    int column = first;
    for (; column + kTogether <= end; column += kTogether)
        subtract<Vector, vectors, kTogether>(update, row, column);
    for (; column < end; ++column) subtract<Vector, vectors, 1>(update, row, column);
}

/// A panel whose columns from `first` to `end` are next, and the two panels before.
struct Panel {
    double* own;
    const double *before, *second;  ///< null: none
    std::ptrdiff_t height;
    int size, negative, reach;
    int first, end, rows;  ///< rows that may not be 0
};

/// From which column on a row of the second block below is not 0, and those under it.
[[gnu::always_inline]] inline int begin_of(const Panel& panel, int row) {
    return row < panel.negative ? 0 : std::clamp(row - panel.reach, 0, panel.size);
}

/// Takes what is left of the columns before from those of a panel. Registers begin at the first
/// row; where one reaches into the next block, what it reads there for the block before is 0.
template <class Vector, int widest>
[[gnu::always_inline]] inline void subtract_before(const Panel& panel) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    const int m = panel.size, less = panel.negative;
    for (int row = panel.first; row < panel.rows;) {
        Update update{{}, 0, panel.own, panel.height};
        const auto add = [&](const double* l, int begin, int end) {
            if (begin < end)
                update.sources[static_cast<std::size_t>(update.count++)] = {
                    l, panel.height, begin, std::clamp(less, begin, end), end};
        };
        if (panel.second != nullptr && row < m) add(panel.second + 2 * m, begin_of(panel, row), m);
        if (panel.before != nullptr && row < 2 * m) add(panel.before + m, 0, m);
        add(panel.own, row < 2 * m ? 0 : begin_of(panel, row - 2 * m), panel.first);
        // Up to where a source ends.
        const int until = row < m ? m : row < 2 * m ? 2 * m : panel.rows;
        const int vectors = (std::min(until, panel.rows) - row + kLanes - 1) / kLanes;
        if (widest >= 4 && vectors >= 4) {
            subtract_rows<Vector, 4>(update, row, panel.first, panel.end);
            row += 4 * kLanes;
        } else if (widest >= 2 && vectors >= 2) {
            subtract_rows<Vector, 2>(update, row, panel.first, panel.end);
            row += 2 * kLanes;
        } else {
            subtract_rows<Vector, 1>(update, row, panel.first, panel.end);
            row += kLanes;
        }
    }
}

#ifdef BELTGRINDING_CLONES
__attribute__((target("avx512f"))) void subtract_before_512(const Panel& panel) {
    subtract_before<Eight, 4>(panel);
}

__attribute__((target_clones("avx2", "default")))
#endif
void subtract_before_256(const Panel& panel) {
    subtract_before<Four, 2>(panel);
}

void subtract_before(const Panel& panel) {
#ifdef BELTGRINDING_CLONES
    if (__builtin_cpu_supports("avx512f")) return subtract_before_512(panel);
#endif
    subtract_before_256(panel);
}

/// Cholesky's factor of the square at the top of a panel's columns, all of one sign; `inverse` is
/// that of its diagonal.
bool factorise_square(const Panel& panel, double sign, double* inverse) {
    for (int j = panel.first; j < panel.end; ++j) {
        double* column = panel.own + j * panel.height;
        for (int k = panel.first; k < j; ++k) {
            const double* before = panel.own + k * panel.height;
            const double factor = sign * before[j];
            for (int r = j; r < panel.end; ++r) column[r] -= factor * before[r];
        }
        const double pivot = sign * column[j];
        if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
        const double root = std::sqrt(pivot);
        inverse[j] = 1.0 / root;
        const double scale = sign / root;
        for (int r = j; r < panel.end; ++r) column[r] *= scale;
    }
    return true;
}

/// What that makes of the rows below.
template <class Vector, int width>
[[gnu::always_inline]] inline void divide(const Panel& panel, double sign, const double* inverse) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    double factor[width][width];
    double scale[width];
    for (int j = 0; j < width; ++j) {
        scale[j] = sign * inverse[panel.first + j];
        for (int k = 0; k < j; ++k)
            factor[j][k] = sign * panel.own[(panel.first + k) * panel.height + panel.first + j];
    }
    for (int row = panel.end; row < panel.rows; row += kLanes) {
        double* at = panel.own + panel.first * panel.height + row;
        Vector values[width];
        for (int j = 0; j < width; ++j) {
            Vector value = read<Vector>(at + j * panel.height);
            for (int k = 0; k < j; ++k) value -= factor[j][k] * values[k];
            values[j] = value * scale[j];
            write<Vector>(at + j * panel.height) = values[j];
        }
    }
}

template <class Vector>
[[gnu::always_inline]] inline void divide_rows(const Panel& panel, double sign,
                                               const double* inverse) {
    switch (panel.end - panel.first) {
        case 1:
            return divide<Vector, 1>(panel, sign, inverse);
        case 2:
            return divide<Vector, 2>(panel, sign, inverse);
        case 3:
            return divide<Vector, 3>(panel, sign, inverse);
        case 4:
            return divide<Vector, 4>(panel, sign, inverse);
        case 5:
            return divide<Vector, 5>(panel, sign, inverse);
        case 6:
            return divide<Vector, 6>(panel, sign, inverse);
        case 7:
            return divide<Vector, 7>(panel, sign, inverse);
        default:
            return divide<Vector, kWidest>(panel, sign, inverse);
    }
}

#ifdef BELTGRINDING_CLONES
__attribute__((target("avx512f"))) void divide_512(const Panel& panel, double sign,
                                                   const double* inverse) {
    divide_rows<Eight>(panel, sign, inverse);
}

__attribute__((target_clones("avx2", "default")))
#endif
void divide_256(const Panel& panel, double sign, const double* inverse) {
    divide_rows<Four>(panel, sign, inverse);
}

void divide(const Panel& panel, double sign, const double* inverse) {
#ifdef BELTGRINDING_CLONES
    if (__builtin_cpu_supports("avx512f")) return divide_512(panel, sign, inverse);
#endif
    divide_256(panel, sign, inverse);
}

/// A factor's panels, one behind the other.
struct Factor {
    const double *blocks, *inverse;
    int count, size, negative, reach;
    std::ptrdiff_t height;

    /// Rows of the columns before `end` of panel i that may not be 0.
    int rows(int i, int end) const {
        const int two = size * std::min(2, count - i);
        return i + 2 < count ? two + std::min(size, std::max(end + reach, negative)) : two;
    }
    /// Where the columns end that are looked at together with `first`.
    int end(int first) const {
        return first < negative ? std::min(first + kWidest, negative)
                                : std::min(first + kWidest, size);
    }
};

/// Solves by the factor's left half for several right-hand sides, `length` apart.
template <class Vector, int together>
[[gnu::always_inline]] inline void substitute_forward(const Factor& factor, double* values,
                                                      std::ptrdiff_t length) {
    constexpr int kLanes = sizeof(Vector) / sizeof(double);
    const int m = factor.size;
    for (int i = 0; i < factor.count; ++i) {
        const double* l = factor.blocks + i * factor.height * m;
        const double* inverse = factor.inverse + std::ptrdiff_t{i} * m;
        double* x = values + std::ptrdiff_t{i} * m;
        for (int first = 0, end = 0; first < m; first = end) {
            end = factor.end(first);
            for (int c = 0; c < together; ++c) {
                double* own = x + c * length;
                for (int k = first; k < end; ++k) {
                    const double* column = l + k * factor.height;
                    const double value = own[k] *= inverse[k];
                    for (int r = k + 1; r < end; ++r) own[r] -= value * column[r];
                }
            }
            const int rows = factor.rows(i, end);
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
            const int rows = factor.rows(i, end);
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

BlockBanded::BlockBanded(int count, int size, int negative, int reach)
    : count_(count),
      size_(size),
      negative_(negative),
      reach_(std::min(reach, size)),
      height_((3 * size + kEight - 1) / kEight * kEight + kEight) {
    const auto blocks = static_cast<std::size_t>(count) * static_cast<std::size_t>(size);
    blocks_.assign(blocks * static_cast<std::size_t>(height_), 0.0);
    inverse_.assign(blocks, 0.0);
}

void BlockBanded::clear(int i) {
    std::fill_n(panel(i), std::ptrdiff_t{height_} * size_, 0.0);
}

bool BlockBanded::factorise(int i) {
    const Factor factor = {blocks_.data(), inverse_.data(), count_, size_,
                           negative_,      reach_,          height_};
    for (int first = 0, end = 0; first < size_; first = end) {
        end = factor.end(first);
        const double sign = first < negative_ ? -1.0 : 1.0;
        const Panel next = {panel(i),
                            i > 0 ? panel(i - 1) : nullptr,
                            i > 1 ? panel(i - 2) : nullptr,
                            height_,
                            size_,
                            negative_,
                            reach_,
                            first,
                            end,
                            factor.rows(i, end)};
        subtract_before(next);
        double* inverse = inverse_.data() + std::ptrdiff_t{i} * size_;
        if (!factorise_square(next, sign, inverse)) return false;
        divide(next, sign, inverse);
    }
    return true;
}

bool BlockBanded::factorise() {
    for (int i = 0; i < count_; ++i)
        if (!factorise(i)) return false;
    return true;
}

void BlockBanded::forward(Eigen::MatrixXd& values) const {
    const Factor factor = {blocks_.data(), inverse_.data(), count_, size_,
                           negative_,      reach_,          height_};
    const auto count = static_cast<int>(values.cols());
#ifdef BELTGRINDING_CLONES
    if (__builtin_cpu_supports("avx512f"))
        return forward_512(factor, values.data(), values.rows(), count);
#endif
    forward_256(factor, values.data(), values.rows(), count);
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

void BlockBanded::solve(Eigen::MatrixXd& values) const {
    forward(values);
    backward(values);
}

}  // namespace beltgrinding

#include "block_banded.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "block_banded_factor.h"
#include "registers.h"

namespace beltgrinding {
namespace {

constexpr int kEight = 8;  // rows that sums are made of apart

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

}  // namespace beltgrinding

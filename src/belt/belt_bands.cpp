#include "belt_bands.h"

#include <algorithm>

#include "registers.h"

namespace beltgrinding {
namespace {

/// The columns whose diagonal d has a row of the block.
struct Range {
    int low, high;
};

Range within(int d, int splines) {
    const int below = d - BeltBands::kLocal + 1;
    return {std::max(0, -below), std::min(splines, splines - below)};
}

/// y += a block times x, and transposed. Beside x lie kLocal - 1 zeros.
#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void add_block(const double* block, std::ptrdiff_t m, const double* x, double* __restrict__ y) {
    static_assert(BeltBands::kDiagonals == 7);
    // Of diagonal d, the columns from this on are those of the rows from 0 on.
    const auto from = [&](std::ptrdiff_t d) { return block + d * m - d + 3; };
    const double *d0 = from(0), *d1 = from(1), *d2 = from(2), *d3 = from(3), *d4 = from(4),
                 *d5 = from(5), *d6 = from(6);
    for (std::ptrdiff_t r = 0; r < m; ++r)
        y[r] += ((d0[r] * x[r + 3] + d1[r] * x[r + 2]) + (d2[r] * x[r + 1] + d3[r] * x[r])) +
                ((d4[r] * x[r - 1] + d5[r] * x[r - 2]) + d6[r] * x[r - 3]);
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void add_transposed(const double* block, std::ptrdiff_t m, const double* x,
                    double* __restrict__ y) {
    for (std::ptrdiff_t c = 0; c < m; ++c) {
        const double* d = block + c;
        y[c] += ((d[0] * x[c - 3] + d[m] * x[c - 2]) + (d[2 * m] * x[c - 1] + d[3 * m] * x[c])) +
                ((d[4 * m] * x[c + 1] + d[5 * m] * x[c + 2]) + d[6 * m] * x[c + 3]);
    }
}

/// to += a x + b y.
#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void add_two(double* __restrict__ to, std::ptrdiff_t count, double a, const double* x, double b,
             const double* y) {
    for (std::ptrdiff_t e = 0; e < count; ++e) to[e] += a * x[e] + b * y[e];
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void add_one(double* __restrict__ to, std::ptrdiff_t count, double a, const double* x) {
    for (std::ptrdiff_t e = 0; e < count; ++e) to[e] += a * x[e];
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void set_sum(double* __restrict__ to, std::ptrdiff_t count, const double* shares,
             const double* const* from) {
    static_assert(BeltBands::kShares == 5);
    const double *a = from[0], *b = from[1], *c = from[2], *d = from[3], *e = from[4];
    const double sa = shares[0], sb = shares[1], sc = shares[2], sd = shares[3], se = shares[4];
    for (std::ptrdiff_t k = 0; k < count; ++k)
        to[k] = ((sa * a[k] + sb * b[k]) + (sc * c[k] + sd * d[k])) + se * e[k];
}

}  // namespace

BeltBands::BeltBands(int columns, int splines) : columns_(columns), splines_(splines) {
    values_.assign(
        static_cast<std::size_t>(columns) * 3 * kDiagonals * static_cast<std::size_t>(splines),
        0.0);
}

BeltBands::Band BeltBands::band_of(const Eigen::MatrixXd& matrix) {
    const int m = static_cast<int>(matrix.cols());
    Band band = Band::Zero(m, kDiagonals);
    for (int d = 0; d < kDiagonals; ++d)
        for (int s = within(d, m).low; s < within(d, m).high; ++s)
            band(s, d) = matrix(s + d - kLocal + 1, s);
    return band;
}

void BeltBands::set(int i, int below, const Shares& shares,
                    const std::array<Band, kShares>& bands) {
    std::array<const double*, kShares> from{};
    for (std::size_t k = 0; k < kShares; ++k) from[k] = bands[k].data();
    set_sum(at(i, below), bands[0].size(), shares.data(), from.data());
}

void BeltBands::add(int i, int below, double a, const Band& x) {
    add_one(at(i, below), x.size(), a, x.data());
}

void BeltBands::add(int i, int below, double a, const Band& x, double b, const Band& y) {
    add_two(at(i, below), x.size(), a, x.data(), b, y.data());
}

Eigen::MatrixXd BeltBands::times(const Eigen::MatrixXd& x) const {
    constexpr int kBeside = kLocal - 1;
    const std::ptrdiff_t stride = splines_ + kBeside;
    std::vector<double> apart(static_cast<std::size_t>(kBeside + stride * columns_), 0.0);
    const auto column = [&](int i) { return apart.data() + kBeside + stride * i; };
    for (int i = 0; i < columns_; ++i) std::copy_n(x.col(i).data(), splines_, column(i));
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(splines_, columns_);
    for (int i = 0; i < columns_; ++i) {
        for (int below = 0; below < std::min(3, columns_ - i); ++below) {
            add_block(at(i, below), splines_, column(i), y.col(i + below).data());
            if (below > 0)
                add_transposed(at(i, below), splines_, column(i + below), y.col(i).data());
        }
    }
    return y;
}

void BeltBands::add_to(BlockBanded& matrix, int i, int offset) const {
    for (int below = 0; below < std::min(3, columns_ - i); ++below) {
        const double* from = at(i, below);
        auto block = matrix.block(i, below);
        for (int d = 0; d < kDiagonals; ++d, from += splines_) {
            const Range range = within(d, splines_);
            const int shift = d - kLocal + 1;
            for (int s = range.low; s < range.high; ++s)
                block(offset + s + shift, offset + s) += from[s];
        }
    }
}

}  // namespace beltgrinding

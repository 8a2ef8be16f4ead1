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

/// y += a diagonal times x.
#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void add_diagonal(const double* __restrict__ diagonal, int count, const double* __restrict__ x,
                  double* __restrict__ y) {
    for (int s = 0; s < count; ++s) y[s] += diagonal[s] * x[s];
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

Eigen::MatrixXd BeltBands::times(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(splines_, columns_);
    for (int i = 0; i < columns_; ++i) {
        for (int below = 0; below < std::min(3, columns_ - i); ++below) {
            const double* from = at(i, below);
            const double* own = x.col(i).data();
            const double* under = x.col(i + below).data();
            for (int d = 0; d < kDiagonals; ++d, from += splines_) {
                const Range range = within(d, splines_);
                const int count = range.high - range.low, shift = range.low + d - kLocal + 1;
                add_diagonal(from + range.low, count, own + range.low,
                             y.col(i + below).data() + shift);
                if (below > 0)
                    add_diagonal(from + range.low, count, under + shift,
                                 y.col(i).data() + range.low);
            }
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

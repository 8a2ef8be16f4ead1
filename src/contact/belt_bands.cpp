#include "belt_bands.h"

#include <algorithm>

namespace beltgrinding {
namespace {

/// The diagonals of column s that are rows of the block.
struct Range {
    int low, high;
};

Range within(int s, int splines) {
    return {std::max(0, BeltBands::kLocal - 1 - s),
            std::min(BeltBands::kDiagonals, splines - s + BeltBands::kLocal - 1)};
}

}  // namespace

BeltBands::BeltBands(int columns, int splines) : columns_(columns), splines_(splines) {
    values_.assign(
        static_cast<std::size_t>(columns) * 3 * kDiagonals * static_cast<std::size_t>(splines),
        0.0);
}

BeltBands::Band BeltBands::band_of(const Eigen::MatrixXd& matrix) {
    const int m = static_cast<int>(matrix.cols());
    Band band = Band::Zero(kDiagonals, m);
    for (int s = 0; s < m; ++s)
        for (int d = within(s, m).low; d < within(s, m).high; ++d)
            band(d, s) = matrix(s + d - kLocal + 1, s);
    return band;
}

Eigen::MatrixXd BeltBands::times(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(splines_, columns_);
    for (int i = 0; i < columns_; ++i) {
        for (int below = 0; below < std::min(3, columns_ - i); ++below) {
            const double* from = at(i, below);
            const double* right = x.data() + std::ptrdiff_t{i} * splines_;
            const double* under = right + std::ptrdiff_t{below} * splines_;
            double* own = y.data() + std::ptrdiff_t{i} * splines_;
            double* to = own + std::ptrdiff_t{below} * splines_;
            for (int s = 0; s < splines_; ++s, from += kDiagonals) {
                const Range range = within(s, splines_);
                double sum = 0.0;
                for (int d = range.low; d < range.high; ++d) {
                    const int r = s + d - kLocal + 1;
                    to[r] += from[d] * right[s];
                    if (below > 0) sum += from[d] * under[r];
                }
                own[s] += sum;
            }
        }
    }
    return y;
}

void BeltBands::add_to(BlockBanded& matrix, int i, int offset) const {
    for (int below = 0; below < std::min(3, columns_ - i); ++below) {
        const double* from = at(i, below);
        auto block = matrix.block(i, below);
        for (int s = 0; s < splines_; ++s, from += kDiagonals) {
            const Range range = within(s, splines_);
            double* to = &block(offset, offset + s) + s - kLocal + 1;
            for (int d = range.low; d < range.high; ++d) to[d] += from[d];
        }
    }
}

}  // namespace beltgrinding

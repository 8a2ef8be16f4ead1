#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "belt_spline.h"
#include "block_banded.h"

namespace beltgrinding {

/// A symmetric matrix between the splines of each column and of the two behind it. Splines that are
/// more than three apart do not meet: of each block, seven diagonals.
class BeltBands {
  public:
    static constexpr int kLocal = BeltSpline::kLocal;
    static constexpr int kDiagonals = 2 * kLocal - 1;
    /// One block: what column s has in row s - 3 + d is in row s of column d.
    using Band = Eigen::Array<double, Eigen::Dynamic, kDiagonals>;

    BeltBands() = default;
    /// All zero.
    BeltBands(int columns, int splines);

    static Band band_of(const Eigen::MatrixXd& matrix);

    int columns() const { return columns_; }
    int splines() const { return splines_; }
    /// The block in row `i + below` and column `i`; `below`: 0 to 2.
    Eigen::Map<Band> block(int i, int below) { return {at(i, below), splines_, kDiagonals}; }
    /// Adds w a b' at the splines from `first` on, to the block in row `i + below`, column `i`.
    void add_product(int i, int below, int first, double w, const std::array<double, kLocal>& a,
                     const std::array<double, kLocal>& b) {
        double* to = at(i, below) + first;
        for (std::size_t c = 0; c < kLocal; ++c)
            for (std::size_t r = 0; r < kLocal; ++r)
                to[(kLocal - 1 + r - c) * static_cast<std::size_t>(splines_) + c] +=
                    w * a[r] * b[c];
    }
    /// Times (splines, columns).
    Eigen::MatrixXd times(const Eigen::MatrixXd& x) const;
    /// Adds its blocks in column i to those of a matrix, from their row and column `offset` on.
    void add_to(BlockBanded& matrix, int i, int offset) const;

  private:
    double* at(int i, int below) {
        return values_.data() + (std::ptrdiff_t{i} * 3 + below) * kDiagonals * splines_;
    }
    const double* at(int i, int below) const {
        return values_.data() + (std::ptrdiff_t{i} * 3 + below) * kDiagonals * splines_;
    }

    int columns_ = 0, splines_ = 0;
    std::vector<double> values_;
};

}  // namespace beltgrinding

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
    /// The block in row `i + below`, column `i`, as a sum of shares of bands.
    static constexpr std::size_t kShares = 5;
    using Shares = std::array<double, kShares>;
    void set(int i, int below, const Shares& shares, const std::array<Band, kShares>& bands);
    /// Adds a x, or a x + b y, to the block in row `i + below`, column `i`.
    void add(int i, int below, double a, const Band& x);
    void add(int i, int below, double a, const Band& x, double b, const Band& y);
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

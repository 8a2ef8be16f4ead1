#pragma once

#include <Eigen/Core>
#include <vector>

namespace beltgrinding {

/// A symmetric, positive definite matrix of square blocks, of which the diagonal ones and the two
/// below are not zero: what finite differences of the fourth order along one direction make of
/// columns of unknowns. Bits are the same on every machine: nothing is fused, sums have one order.
class BlockBanded {
  public:
    BlockBanded() = default;
    /// `count` blocks of `size` rows in the diagonal; all zero.
    BlockBanded(int count, int size);

    int count() const { return count_; }
    int size() const { return size_; }
    void set_zero();
    /// The block in row `i + below`, column `i`; `below`: 0 to 2. In the diagonal only the lower
    /// triangle counts.
    Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>> block(int i, int below) {
        return {panel(i) + std::ptrdiff_t{below} * size_, size_, size_,
                Eigen::OuterStride<>(height_)};
    }

    /// The factor of Cholesky in place of the matrix. False if that is not positive definite.
    bool factorise();
    /// Solves for the columns of `values`, with the factor.
    void solve(Eigen::MatrixXd& values) const;

  private:
    /// The blocks of a column, one below the other, column by column.
    double* panel(int i) { return blocks_.data() + std::ptrdiff_t{i} * height_ * size_; }
    const double* panel(int i) const {
        return blocks_.data() + std::ptrdiff_t{i} * height_ * size_;
    }

    int count_ = 0, size_ = 0;
    int height_ = 0;  // of a panel: three blocks, rounded up to whole registers
    std::vector<double> blocks_, corner_, shifted_;
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>
#include <vector>

namespace beltgrinding {

/// A symmetric, positive definite matrix of square blocks, of which the diagonal ones and the two
/// below are not zero: what finite differences of the fourth order along one direction make of
/// columns of unknowns.
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
    Eigen::Map<Eigen::MatrixXd> block(int i, int below) {
        return {blocks_.data() + offset(i, below), size_, size_};
    }
    Eigen::Map<const Eigen::MatrixXd> block(int i, int below) const {
        return {blocks_.data() + offset(i, below), size_, size_};
    }

    /// The factor of Cholesky in place of the matrix. False if that is not positive definite.
    bool factorise();
    /// Solves for the columns of `values`, with the factor.
    void solve(Eigen::MatrixXd& values) const;

  private:
    std::ptrdiff_t offset(int i, int below) const {
        return (std::ptrdiff_t{3} * i + below) * size_ * size_;
    }

    int count_ = 0, size_ = 0;
    std::vector<double> blocks_;
};

}  // namespace beltgrinding

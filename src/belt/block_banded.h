#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace beltgrinding {

/// A symmetric matrix of square blocks, of which the diagonal ones and the two below are not zero:
/// what finite differences of the fourth order along one direction make of columns of unknowns. It
/// is positive definite, or a saddle: negative in the first rows of each block and, with these
/// eliminated, positive in the others. Bits are the same on every machine: nothing is fused, sums
/// have one order.
class BlockBanded {
  public:
    BlockBanded() = default;
    /// `count` blocks of `size` rows in the diagonal, the first `negative` of each negative; all
    /// zero. In the second block below, what is more than `reach` rows below its column's own has
    /// to stay so, and in the columns of negative rows all but these rows.
    BlockBanded(int count, int size, int negative = 0, int reach = std::numeric_limits<int>::max());

    int count() const { return count_; }
    int size() const { return size_; }
    int negative() const { return negative_; }
    /// Sets the blocks in column i to zero.
    void clear(int i);
    /// The block in row `i + below`, column `i`; `below`: 0 to 2. In the diagonal only the lower
    /// triangle counts.
    Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>> block(int i, int below) {
        return {panel(i) + std::ptrdiff_t{below} * size_, size_, size_,
                Eigen::OuterStride<>(height_)};
    }
    Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>> block(int i, int below) const {
        return {panel(i) + std::ptrdiff_t{below} * size_, size_, size_,
                Eigen::OuterStride<>(height_)};
    }

    /// The factor of Cholesky in place of the matrix, L J L' with J = -1 in negative rows, else 1.
    /// False if there is none.
    bool factorise();
    /// The same for the blocks in column i alone, where those before have been factorised.
    bool factorise(int i);
    /// Solves for the columns of `values`, with the factor.
    void solve(Eigen::MatrixXd& values) const;
    /// The halves of that: L^-1 and L'^-1 J times `values`. The rows of the blocks before `first`
    /// are zero.
    void forward(Eigen::Ref<Eigen::MatrixXd> values, int first = 0) const;
    void backward(Eigen::MatrixXd& values) const;
    /// a' J b, of what `forward` has made.
    Eigen::MatrixXd products(const Eigen::Ref<const Eigen::MatrixXd>& a,
                             const Eigen::Ref<const Eigen::MatrixXd>& b) const;

  private:
    /// The blocks of a column, one below the other, column by column.
    double* panel(int i) { return blocks_.data() + std::ptrdiff_t{i} * height_ * size_; }
    const double* panel(int i) const {
        return blocks_.data() + std::ptrdiff_t{i} * height_ * size_;
    }

    int count_ = 0, size_ = 0, negative_ = 0, reach_ = 0;
    int height_ = 0;  // of a panel: three blocks, and zeros that a register may reach into
    std::vector<double> blocks_;
    std::vector<double> inverse_;  // of the factor's diagonal
};

}  // namespace beltgrinding

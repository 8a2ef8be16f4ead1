#include "block_banded.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace beltgrinding {
namespace {

struct Sizes {
    int count, size, negative, reach;
};

class BlockBandedOf : public ::testing::TestWithParam<Sizes> {
  protected:
    /// A saddle, and the same as a full matrix.
    static BlockBanded saddle(Eigen::MatrixXd& full) {
        const auto [count, size, negative, reach] = GetParam();
        BlockBanded matrix(count, size, negative, reach);
        std::mt19937 random(7);
        std::uniform_real_distribution<> some(-0.1, 0.1);
        full.setZero(count * size, count * size);
        for (int i = 0; i < count; ++i) {
            matrix.clear(i);
            for (int below = 0; below < std::min(3, count - i); ++below) {
                auto block = matrix.block(i, below);
                for (int c = 0; c < size; ++c) {
                    for (int r = below == 0 ? c : 0; r < size; ++r) {
                        if (below == 2 && r >= negative && (c < negative || r > c + reach)) break;
                        block(r, c) = some(random);
                    }
                    if (below == 0) block(c, c) = c < negative ? -8.0 : 8.0;
                }
                full.block((i + below) * size, i * size, size, size) = block;
            }
        }
        full = Eigen::MatrixXd(full.selfadjointView<Eigen::Lower>());
        return matrix;
    }
};

TEST_P(BlockBandedOf, SolvesForAnyNumberOfRightHandSides) {
    Eigen::MatrixXd full;
    BlockBanded matrix = saddle(full);
    ASSERT_TRUE(matrix.factorise());
    for (const int sides : {1, 3, 4, 9}) {
        const Eigen::MatrixXd right = Eigen::MatrixXd::Random(full.rows(), sides);
        Eigen::MatrixXd solution = right;
        matrix.solve(solution);
        EXPECT_LT((full * solution - right).cwiseAbs().maxCoeff(), 1e-12);
    }
}

TEST_P(BlockBandedOf, HalvesGiveTheProductsOfSchurComplements) {
    Eigen::MatrixXd full;
    BlockBanded matrix = saddle(full);
    ASSERT_TRUE(matrix.factorise());
    const Eigen::MatrixXd right = Eigen::MatrixXd::Random(full.rows(), 4);
    Eigen::MatrixXd half = right, whole = right;
    matrix.forward(half);
    matrix.solve(whole);
    EXPECT_LT((matrix.products(half, half) - right.transpose() * whole).cwiseAbs().maxCoeff(),
              1e-12);
    // Of some of them, and of rows from a later block on.
    const Eigen::Index rows = half.rows() - matrix.size();
    Eigen::MatrixXd with_signs = half.bottomRows(rows);
    for (Eigen::Index r = 0; r < rows; ++r)
        if (r % matrix.size() < matrix.negative()) with_signs.row(r) *= -1.0;
    EXPECT_LT((matrix.products(half.leftCols(3).bottomRows(rows), half.bottomRows(rows)) -
               half.leftCols(3).bottomRows(rows).transpose() * with_signs)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
}

TEST_P(BlockBandedOf, HasNoFactorWhereAPivotHasTheOtherSign) {
    Eigen::MatrixXd full;
    BlockBanded matrix = saddle(full);
    const int last = matrix.size() - 1;
    matrix.block(matrix.count() - 1, 0)(last, last) = -8.0;
    EXPECT_FALSE(matrix.factorise());
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, BlockBandedOf,
    ::testing::Values(Sizes{5, 37, 6, 3}, Sizes{4, 27, 6, 3}, Sizes{3, 16, 0, 16},
                      Sizes{6, 6, 0, 6}, Sizes{2, 9, 6, 3}, Sizes{1, 5, 2, 3}, Sizes{7, 19, 11, 3}),
    [](const auto& one) {
        return std::to_string(one.param.count) + "Of" + std::to_string(one.param.size);
    });

}  // namespace
}  // namespace beltgrinding

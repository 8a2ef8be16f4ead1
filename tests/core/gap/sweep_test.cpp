#include "gap/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beltgrinding {
namespace {

constexpr double kRadius = 1e4;  // mm: hardly any curvature

ContactGrid grid_of(int nx, int ny) {
    return {nx, ny, 1.0, 1.0};
}

/// A hump of some cells around column and row.
Eigen::ArrayXd hump(const ContactGrid& grid, double column, double row, double half) {
    Eigen::ArrayXd values(grid.cells());
    for (int cell = 0; cell < grid.cells(); ++cell) {
        const double s = (cell % grid.nx - column) / half, y = (cell / grid.nx - row) / half;
        values[cell] = std::sqrt(std::max(0.0, 1.0 - s * s - y * y));
    }
    return values;
}

TEST(Sweep, KeepsWhatIsEvenAndWhatRisesEvenly) {
    const ContactGrid grid = grid_of(33, 17);
    const Eigen::ArrayXd whole = Eigen::ArrayXd::Ones(grid.cells());
    Eigen::ArrayXd slope(grid.cells());
    for (int cell = 0; cell < grid.cells(); ++cell)
        slope[cell] = 0.3 * (cell % grid.nx) - 0.2 * (cell / grid.nx);
    for (const Vec3& moved : {Vec3(4, 0, 0), Vec3(0, 3, 0), Vec3(-2.5, 1.5, 0)}) {
        const Sweep sweep{moved, Vec3::Zero()};
        EXPECT_LT((sweep.mean(grid, kRadius, whole, slope) - slope).abs().maxCoeff(), 1e-5);
    }
    EXPECT_TRUE((Sweep{}.mean(grid, kRadius, whole, slope) == slope).all());
}

TEST(Sweep, IsTheMeanOfStampsAlongTheWay) {
    const ContactGrid grid = grid_of(49, 49);
    const Eigen::ArrayXd whole = Eigen::ArrayXd::Ones(grid.cells());
    const Eigen::ArrayXd values = hump(grid, 24, 24, 9.0);
    for (const Vec3& moved : {Vec3(4, 0, 0), Vec3(0, -4, 0), Vec3(3, 3, 0)}) {
        const Eigen::ArrayXd mean = Sweep{moved, Vec3::Zero()}.mean(grid, kRadius, whole, values);
        Eigen::ArrayXd stamps = Eigen::ArrayXd::Zero(grid.cells());
        constexpr int kStamps = 200;
        for (int k = 0; k < kStamps; ++k) {
            const double share = (k + 0.5) / kStamps - 0.5;
            stamps += hump(grid, 24 + share * moved.x(), 24 + share * moved.y(), 9.0) / kStamps;
        }
        EXPECT_NEAR(mean.sum(), values.sum(), 1e-7 * values.sum());
        // Of the sum: what it is between cells is as if straight.
        EXPECT_LT((mean - stamps).abs().sum(), 0.02 * values.sum());
        EXPECT_GT((values - stamps).abs().sum(), 0.06 * values.sum());
    }
}

TEST(Sweep, TurnsRoundTheContact) {
    const ContactGrid grid = grid_of(49, 49);
    const Eigen::ArrayXd whole = Eigen::ArrayXd::Ones(grid.cells());
    const Sweep sweep{Vec3::Zero(), Vec3(0, 0, 0.2)};
    const Eigen::Vector2d way = sweep.way(10.0, 5.0, kRadius);
    EXPECT_NEAR(way.x(), -1.0, 1e-12);
    EXPECT_NEAR(way.y(), 2.0, 1e-12);
    const Eigen::ArrayXd round = hump(grid, 24, 24, 12.0);
    EXPECT_LT((sweep.mean(grid, kRadius, whole, round) - round).abs().sum(), 0.01 * round.sum());
}

TEST(Sweep, StopsAtEdges) {
    const ContactGrid grid = grid_of(33, 9);
    Eigen::ArrayXd coverage = Eigen::ArrayXd::Ones(grid.cells()), values = hump(grid, 16, 4, 8.0);
    for (int cell = 0; cell < grid.cells(); ++cell)
        if (cell % grid.nx > 19) coverage[cell] = values[cell] = 0.0;
    values[4 * grid.nx + 19] = 3.0;  // as at a sharp edge
    const Eigen::ArrayXd mean =
        Sweep{{4, 0, 0}, Vec3::Zero()}.mean(grid, kRadius, coverage, values);
    for (int cell = 0; cell < grid.cells(); ++cell) {
        const int column = cell % grid.nx;
        if (column > 19) {
            EXPECT_EQ(mean[cell], 0.0);
        }
        if (column == 19) {
            EXPECT_EQ(mean[cell], values[cell]);
        }
    }
    EXPECT_EQ(values[4 * grid.nx + 8], 0.0);
    EXPECT_GT(mean[4 * grid.nx + 8], 0.0);  // far from the edge it is swept
}

}  // namespace
}  // namespace beltgrinding

#include "contact/peak_pressure.h"

#include <gtest/gtest.h>

namespace beltgrinding {
namespace {

/// The peak of a load of 6 N on the middle cell of a grid.
double of_one_cell(int nx, int ny, double ds, double dy) {
    const ContactGrid grid{nx, ny, ds, dy};
    Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(grid.cells());
    pressure[(ny / 2) * nx + nx / 2] = 6.0 / grid.cell_area();
    return peak_pressure(grid, pressure, Eigen::ArrayXd::Ones(grid.cells()));
}

TEST(PeakPressure, IsTheMeanOfASquareOfOneMillimetre) {
    EXPECT_NEAR(of_one_cell(21, 21, 0.2, 0.2), 6.0, 1e-9);
    EXPECT_NEAR(of_one_cell(21, 11, 0.1, 0.25), 6.0, 1e-9);
}

TEST(PeakPressure, IsTheMeanOfACellWhereThatIsLonger) {
    EXPECT_NEAR(of_one_cell(5, 5, 2.0, 3.0), 1.0, 1e-9);
    EXPECT_NEAR(of_one_cell(5, 21, 2.0, 0.2), 3.0, 1e-9);  // along only
    EXPECT_NEAR(of_one_cell(21, 5, 0.2, 3.0), 2.0, 1e-9);  // across only
}

TEST(PeakPressure, ReachesNoFurtherThanTheGrid) {
    for (const int cell : {0, 4, 20, 24}) {
        const ContactGrid grid{5, 5, 0.2, 0.2};
        Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(grid.cells());
        pressure[cell] = 6.0 / grid.cell_area();
        const double peak = peak_pressure(grid, pressure, Eigen::ArrayXd::Ones(grid.cells()));
        EXPECT_NEAR(peak, 6.0, 1e-9) << cell;
    }
}

}  // namespace
}  // namespace beltgrinding

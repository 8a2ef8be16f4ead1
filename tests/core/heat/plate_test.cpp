// A thin plate under a band that dwells, runs and comes back, against CalculiX
// (tests/validation/heat_plate.py).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "plate.h"

namespace beltgrinding {
namespace {

struct Row {
    double x, peak, end;
};
constexpr Row kCalculix[] = {
#include "calculix_plate.inc"
};

TEST(ThinPlate, ABandThatDwellsAndComesBackHeatsItAsCalculixSays) {
    const double h = 0.5, flux = 2000.0, half = 3.0;
    const HeightField field = plate(121, 3, h);
    PartHeat part(field, h, steel());
    part.set_thickness(std::vector<float>(part.size(), 3.0f));
    std::vector<double> places(10, 15.0);
    for (double x = 15.5; x < 40.01; x += 1.0) places.push_back(x);
    for (double x = 39.5; x > 24.99; x -= 1.0) places.push_back(x);
    Conduction conduction(part);
    for (const double middle : places) {
        for (std::uint32_t k = 0; k < part.size(); ++k) {
            const double x = field.point[part.samples()[k]].x() - middle;
            const double share = (std::min(x + 0.5 * h, half) - std::max(x - 0.5 * h, -half)) / h;
            if (share > 0.0) conduction.add(k, flux * share * part.nodes().area[k]);
        }
        conduction.advance(0.05, 0);
    }
    const HeatState& state = conduction.settle();
    double most = 0.0, hottest = 0.0;
    for (const Row& row : kCalculix) most = std::max(most, row.peak);
    ASSERT_EQ(3 * std::size(kCalculix), part.size());
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const double x = field.point[part.samples()[k]].x();
        const Row& row = kCalculix[std::lround(x / h)];
        ASSERT_NEAR(row.x, x, 1e-9);
        hottest = std::max<double>(hottest, state.peak[k]);
        EXPECT_NEAR(state.peak[k], row.peak, 0.03 * most) << x;
        EXPECT_NEAR(conduction.rise(k), row.end, 0.03 * most) << x;
    }
    EXPECT_NEAR(hottest, most, 0.03 * most);
}

}  // namespace
}  // namespace beltgrinding

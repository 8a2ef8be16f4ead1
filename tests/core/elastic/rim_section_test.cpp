#include "elastic/rim_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace beltgrinding {
namespace {

constexpr Elasticity kRubber{5.0, 0.45};
constexpr int kCells = 12;

WheelRimDesign design() {
    WheelRimDesign rim;
    rim.outer_radius = 60.0;
    rim.width = 30.0;
    rim.layers = {{12.0, kRubber}};
    return rim;
}

Eigen::MatrixXd even_part(const WheelRimDesign& rim, double k, bool even = true) {
    Eigen::MatrixXd symmetric, other;
    RimSection(rim, kCells, 1.0).compliance(k, symmetric, other);
    return even ? symmetric : other;
}

TEST(RimSection, TurnedDownEvenlyItIsASmallerWheelWithAThinnerRim) {
    WheelRimDesign turned = design(), small = design();
    turned.drop = {2.0, 2.0};
    small.outer_radius -= 2.0;
    small.layers.front().thickness -= 2.0;
    const double ratio = turned.outer_radius / small.outer_radius;
    for (const double k : {0.02, 0.2, 1.0}) {
        for (const bool even : {true, false}) {
            // The same whole waves; pressure is per area of the surface before it was turned.
            const Eigen::MatrixXd is = even_part(turned, k, even).topLeftCorner<6, 6>();
            const Eigen::MatrixXd should =
                ratio * even_part(small, k * ratio, even).topLeftCorner<6, 6>();
            EXPECT_LT((is - should).norm(), 5e-3 * should.norm()) << k;
        }
    }
    turned.drop = {0.0, 0.0, 0.0};
    EXPECT_LT((even_part(turned, 0.2) - even_part(design(), 0.2)).norm(), 1e-12);
}

TEST(RimSection, ACrownStiffensTheSidesAndHardlyTheMiddle) {
    WheelRimDesign crowned = design();
    for (int i = 0; i <= 32; ++i) crowned.drop.push_back(1.9 * i * i / (32.0 * 32.0));
    const Eigen::MatrixXd before = even_part(design(), 0.2), after = even_part(crowned, 0.2);
    EXPECT_NEAR(after(0, 0), before(0, 0), 0.01 * before(0, 0));
    EXPECT_LT(after(5, 5), 0.96 * before(5, 5));
    EXPECT_LT((after - after.transpose()).norm(), 1e-12 * after.norm());
}

TEST(RimSection, OnlyTheOutermostLayerIsThinnerAndSomeOfItIsLeft) {
    WheelRimDesign turned = design(), small = design();
    turned.layers = {{10.0, {2.0, 0.45}}, {4.0, kRubber}};
    small.layers = {{10.0, {2.0, 0.45}}, {0.4, kRubber}};
    turned.outer_radius = 60.0;
    small.outer_radius = 56.4;
    turned.drop = {20.0, 20.0};
    const double ratio = 60.0 / 56.4;
    const Eigen::MatrixXd is = even_part(turned, 0.1).topLeftCorner<6, 6>();
    const Eigen::MatrixXd should = ratio * even_part(small, 0.1 * ratio).topLeftCorner<6, 6>();
    EXPECT_LT((is - should).norm(), 0.02 * should.norm());
    turned.drop = {1.0, std::nan("")};
    EXPECT_THROW(turned.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace beltgrinding

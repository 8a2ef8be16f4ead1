#include "beltgrinding/curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beltgrinding/belt_wear.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

TEST(Curve, GoesThroughItsPointsAndNeverPastThem) {
    const std::vector<Eigen::Vector2d> points{{1, 0.2}, {2, 0.2}, {3, 1.0}, {5, 1.1}, {6, 0.4}};
    const Curve curve(points, "curve");
    for (const auto& point : points) EXPECT_NEAR(curve(point.x()), point.y(), 1e-14);
    for (std::size_t k = 1; k < points.size(); ++k) {
        const double low = std::min(points[k - 1].y(), points[k].y());
        const double high = std::max(points[k - 1].y(), points[k].y());
        double last = points[k - 1].y();
        for (double t = 0.0; t <= 1.0; t += 0.01) {
            const double value = curve(points[k - 1].x() + t * (points[k].x() - points[k - 1].x()));
            EXPECT_GE(value, low - 1e-14);
            EXPECT_LE(value, high + 1e-14);
            if (points[k].y() >= points[k - 1].y()) {
                EXPECT_GE(value, last - 1e-14);
            }
            last = value;
        }
    }
    EXPECT_EQ(curve(0.0), 0.2);  // the ends' values beyond the measurements
    EXPECT_EQ(curve(9.0), 0.4);
    EXPECT_FALSE(curve.measured(0.9));
    EXPECT_TRUE(curve.measured(6.0));
}

TEST(Curve, IsExactOnALineAndThirdOrderOnASmoothFunction) {
    const Curve line({{0, 1}, {1, 3}, {4, 9}}, "line");
    EXPECT_NEAR(line(2.7), 6.4, 1e-12);
    EXPECT_NEAR(Curve({{0, 1}, {2, 2}}, "two")(0.5), 1.25, 1e-12);
    const auto error = [](int n) {
        std::vector<Eigen::Vector2d> points;
        for (int k = 0; k <= n; ++k) points.emplace_back(k * 2.0 / n, std::exp(k * 2.0 / n));
        const Curve curve(points, "exp");
        double worst = 0.0;
        for (double x = 0.0; x < 2.0; x += 0.003) {
            worst = std::max(worst, std::abs(curve(x) - std::exp(x)));
        }
        return worst;
    };
    EXPECT_NEAR(std::log2(error(40) / error(80)), 3.0, 0.1);
}

TEST(Curve, RefusesPointsThatAreNone) {
    EXPECT_TRUE(Curve().empty());
    EXPECT_THROW(Curve({{1, 1}}, "c"), InputError);
    EXPECT_THROW(Curve({{1, 1}, {1, 2}}, "c"), InputError);
    EXPECT_THROW(Curve({{1, 1}, {2, -1}}, "c"), InputError);
    EXPECT_THROW(Curve({{1, 1}, {2, std::nan("")}}, "c"), InputError);
}

TEST(BeltWear, FallsByWorkOrVolume) {
    BeltWear::Parameters p;
    EXPECT_EQ(BeltWear(p).remaining({1e9, 1e9, 0}), 1.0);
    p.model = BeltWear::Model::kExponential;
    p.scale = 1000.0;
    p.rest = 0.25;
    EXPECT_NEAR(BeltWear(p).remaining({1000.0, 0, 0}), 0.25 + 0.75 / std::exp(1.0), 1e-12);
    EXPECT_EQ(BeltWear(p).remaining({0, 500.0, 0}), 1.0);
    p.variable = BeltWear::Variable::kVolume;
    EXPECT_LT(BeltWear(p).remaining({0, 500.0, 0}), 1.0);
    p.model = BeltWear::Model::kTwoStage;
    p.first_share = 0.5;
    p.first_scale = 10.0;
    const BeltWear two(p);
    EXPECT_EQ(two.remaining({}), 1.0);
    EXPECT_NEAR(two.remaining({0, 100.0, 0}), 0.25 + 0.5 * std::exp(-10.0) + 0.25 * std::exp(-0.1),
                1e-12);
    p.model = BeltWear::Model::kPower;
    p.scale = 50.0;
    p.exponent = 0.3;
    EXPECT_NEAR(BeltWear(p).remaining({0, 100.0, 0}), std::pow(3.0, -0.3), 1e-12);
    EXPECT_EQ(BeltWear(p).remaining({}), 1.0);
    p.model = BeltWear::Model::kCurve;
    p.curve = Curve({{0, 1}, {2000, 0.4}}, "wear");
    EXPECT_NEAR(BeltWear(p).remaining({0, 1000, 0}), 0.7, 1e-12);
    EXPECT_TRUE(BeltWear(p).measured({0, 2000, 0}));
    EXPECT_FALSE(BeltWear(p).measured({0, 2001, 0}));
}

TEST(BeltWear, RefusesNonsense) {
    BeltWear::Parameters p;
    p.model = BeltWear::Model::kCurve;
    EXPECT_THROW(BeltWear{p}, InputError);
    p.model = BeltWear::Model::kTwoStage;
    p.rest = 0.7;
    p.first_share = 0.5;
    EXPECT_THROW(BeltWear{p}, InputError);
    p.model = BeltWear::Model::kExponential;
    p.scale = 0.0;
    EXPECT_THROW(BeltWear{p}, InputError);
    p.model = BeltWear::Model::kPower;
    EXPECT_THROW(BeltWear{p}, InputError);
    p.scale = 1.0;
    p.exponent = -0.1;
    EXPECT_THROW(BeltWear{p}, InputError);
    EXPECT_THROW((BeltState{-1.0, 0, 0}.validate()), InputError);
}

TEST(Curve, PointsTooNearOneAnotherAreRefused) {
    EXPECT_THROW(Curve({{0.0, 0.0}, {1e-300, 1e200}}, "a"), InputError);
    EXPECT_THROW(Curve({{0.0, 0.0}, {1e-300, 1e200}, {1.0, 1e200}}, "a"), InputError);
}

TEST(BeltWear, ModelsAndVariablesHaveNames) {
    EXPECT_EQ(BeltWear::model_named("none"), BeltWear::Model::kNone);
    EXPECT_EQ(BeltWear::model_named("exponential"), BeltWear::Model::kExponential);
    EXPECT_EQ(BeltWear::model_named("two_stage"), BeltWear::Model::kTwoStage);
    EXPECT_EQ(BeltWear::model_named("power"), BeltWear::Model::kPower);
    EXPECT_EQ(BeltWear::model_named("curve"), BeltWear::Model::kCurve);
    EXPECT_EQ(BeltWear::variable_named("work"), BeltWear::Variable::kWork);
    EXPECT_EQ(BeltWear::variable_named("volume"), BeltWear::Variable::kVolume);
    EXPECT_THROW(BeltWear::model_named(""), InputError);
    EXPECT_THROW(BeltWear::variable_named("time"), InputError);
}

}  // namespace
}  // namespace beltgrinding

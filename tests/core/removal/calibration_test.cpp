#include "removal/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "beltgrinding/belt_wear.h"
#include "beltgrinding/error.h"
#include "beltgrinding/removal_law.h"
#include "support/hammann.h"

namespace beltgrinding {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

MeasuredGrinds some(Eigen::Index n) {
    std::srand(1);  // the same for a test alone and among others
    MeasuredGrinds g;
    g.force = 30.0 + 20.0 * Eigen::ArrayXd::Random(n);
    g.area = 150.0 + 60.0 * Eigen::ArrayXd::Random(n);
    g.speed = 20e3 + 8e3 * Eigen::ArrayXd::Random(n);
    g.feed = Eigen::ArrayXd::Zero(n);
    g.time = 10.0 + 6.0 * Eigen::ArrayXd::Random(n);
    g.wear = 2e5 + 2e5 * Eigen::ArrayXd::Random(n);
    g.spread = g.measured = Eigen::ArrayXd::Ones(n);
    return g;
}

GrindVector linear() {
    GrindVector x = GrindVector::Zero();
    x[kPressureExponent] = x[kSpeedExponent] = x[kTimeExponent] = 1.0;
    x[kLnWearScale] = x[kLnSaturation] = x[kWearExponent] = kInf;
    return x;
}

TEST(Calibration, AGrindOnAWearingBeltIsThatOfItsLaw) {
    MeasuredGrinds g = some(8);
    GrindVector x = linear();
    x[kLnWearScale] = std::log(3e5);
    x[kWearRest] = 0.3;
    x[kFirstShare] = 0.4;
    x[kLnFirstRatio] = std::log(0.05);
    BeltWear::Parameters two;
    two.model = BeltWear::Model::kTwoStage;
    two.scale = 3e5;
    two.rest = 0.3;
    two.first_share = 0.4 * 0.7;
    two.first_scale = 0.05 * 3e5;
    const BeltWear wear(two);
    for (Eigen::Index i = 0; i < 8; ++i) {
        const double worn = log_grind(x, {}, g, i, g.area[i], nullptr);
        const double fresh = log_grind(linear(), {}, g, i, g.area[i], nullptr);
        EXPECT_NEAR(std::exp(worn - fresh), wear.remaining({g.wear[i], 0.0, 0.0}), 1e-12);
    }
}

TEST(Calibration, LinearGrindIsHammannsDepth) {
    MeasuredGrinds g = some(1);
    g.feed[0] = 40.0;
    g.time[0] = 1.0 / 40.0;  // per mm of the pass
    g.spread[0] = 25.0;
    GrindVector x = linear();
    x[kLnCoefficient] = std::log(1e-5);
    const double depth = std::exp(log_grind(x, {}, g, 0, g.area[0], nullptr));
    EXPECT_NEAR(depth, testing::hammann_depth(1e-5, 1.0, g.speed[0], g.force[0], 40.0, 25.0),
                1e-12);
}

TEST(Calibration, GradientIsThatOfDifferences) {
    MeasuredGrinds g = some(6);
    g.feed[4] = 30.0;
    g.spread[5] = kNan;
    g.relative = Eigen::ArrayXXd(6, 3);
    g.relative.rowwise() = Eigen::Array3d(1.6, 1.0, 0.4).transpose();
    g.grit = 120.0 + 60.0 * Eigen::ArrayXd::Random(6);
    g.cut = 0.6 + 0.3 * Eigen::ArrayXd::Random(6);
    g.loading = 0.5 + 0.4 * Eigen::ArrayXd::Random(6);
    GrindVector x = linear();
    x << -11.0, 1.4, 1.2, 0.1, 1.3, 0.2, std::log(3e5), 0.3, 0.01, std::log(0.4), kInf, -0.8, 0.3,
        0.4, std::log(0.2), 0.35;
    constexpr double kStep = 1e-6;
    for (Eigen::Index i = 0; i < 6; ++i) {
        GrindVector gradient;
        log_grind(x, {}, g, i, g.area[i], &gradient);
        for (int k = 0; k < kGrindParameters; ++k) {
            GrindVector up = x, down = x;
            up[k] += kStep;
            down[k] -= kStep;
            const double slope = (log_grind(up, {}, g, i, g.area[i], nullptr) -
                                  log_grind(down, {}, g, i, g.area[i], nullptr)) /
                                 (2.0 * kStep);
            EXPECT_NEAR(gradient[k], slope, 1e-5 * (1.0 + std::abs(slope))) << k;
        }
        x[kWearExponent] = 0.4;  // and of a power of the wear
        log_grind(x, {}, g, i, g.area[i], &gradient);
        for (const int k : {kLnWearScale, kWearRest, kWearExponent}) {
            GrindVector up = x, down = x;
            up[k] += kStep;
            down[k] -= kStep;
            const double slope = (log_grind(up, {}, g, i, g.area[i], nullptr) -
                                  log_grind(down, {}, g, i, g.area[i], nullptr)) /
                                 (2.0 * kStep);
            EXPECT_NEAR(gradient[k], slope, 1e-5 * (1.0 + std::abs(slope))) << k;
        }
        x[kWearExponent] = kInf;
    }
}

// Of a linear model with normal scatter the likeliest parameter is known in closed form.
TEST(Calibration, APriorCountsAsAMeasurement) {
    MeasuredGrinds g = some(30);
    GrindVector truth = linear();
    truth[kPressureExponent] = 2.0;
    Eigen::ArrayXd slope(30), left(30);
    for (Eigen::Index i = 0; i < 30; ++i) {
        const double noise = 0.1 * std::sin(7.0 * static_cast<double>(i));
        g.measured[i] = std::exp(log_grind(truth, {}, g, i, g.area[i], nullptr) + noise);
        slope[i] = std::log(g.force[i] / g.area[i] / GrindReferences{}.pressure);
        left[i] = std::log(g.measured[i]) - log_grind(linear(), {}, g, i, g.area[i], nullptr);
    }
    CalibrationSettings settings;
    settings.start = linear();
    settings.lower = settings.upper = GrindVector::Zero();
    settings.free[kPressureExponent] = true;
    settings.lower[kPressureExponent] = -5.0;
    settings.upper[kPressureExponent] = 5.0;
    settings.prior_mean[kPressureExponent] = 1.0;
    settings.prior_deviation[kPressureExponent] = 0.02;
    const Calibration found = calibrate(g, {}, settings);
    const double known = std::pow(found.scatter / 0.02, 2);
    const double expected = 1.0 + (slope * left).sum() / (slope.square().sum() + known);
    EXPECT_NEAR(found.parameters[kPressureExponent], expected, 1e-4);
    EXPECT_LT(std::sqrt(found.covariance(kPressureExponent, kPressureExponent)), 0.02);
    EXPECT_LT(found.parameters[kPressureExponent], 1.95);
}

TEST(Calibration, AnUnevenPressureRemovesMoreThanItsMean) {
    MeasuredGrinds g = some(1);
    GrindVector x = linear();
    x[kPressureExponent] = 2.0;
    const double even = log_grind(x, {}, g, 0, g.area[0], nullptr);
    g.relative = Eigen::ArrayXXd(1, 2);
    g.relative << 1.5, 0.5;
    EXPECT_NEAR(log_grind(x, {}, g, 0, g.area[0], nullptr) - even, std::log(1.25), 1e-12);
    x[kPressureExponent] = 1.0;
    const double uneven = log_grind(x, {}, g, 0, g.area[0], nullptr);
    g.relative.resize(0, 0);
    EXPECT_NEAR(uneven, log_grind(x, {}, g, 0, g.area[0], nullptr), 1e-12);
    g.relative = Eigen::ArrayXXd::Constant(2, 2, 1.0);
    EXPECT_THROW(g.validate(), InputError);
}

TEST(Calibration, UnknownAreasAreFoundByTheRemoval) {
    MeasuredGrinds g = some(40);
    g.areas = Eigen::ArrayXd(2);
    g.areas << 100.0, 200.0;
    for (Eigen::Index i = 0; i < 40; ++i) g.area[i] = g.areas[i % 2];
    GrindVector truth = linear();
    truth[kLnCoefficient] = std::log(1e-5);
    truth[kPressureExponent] = 2.0;
    for (Eigen::Index i = 0; i < 40; ++i) {
        const double noise = 0.02 * std::sin(7.0 * static_cast<double>(i));
        g.measured[i] = std::exp(log_grind(truth, {}, g, i, g.area[i], nullptr) + noise);
    }
    g.area[10] = g.area[11] = kNan;
    CalibrationSettings settings;
    settings.start = linear();
    settings.lower = settings.upper = GrindVector::Zero();
    settings.free[kLnCoefficient] = settings.free[kPressureExponent] = true;
    settings.lower[kLnCoefficient] = -40.0;
    settings.upper[kPressureExponent] = 5.0;
    const Calibration found = calibrate(g, {}, settings);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.parameters[kPressureExponent], 2.0, 0.03);
    EXPECT_GT(found.posterior(10, 0), 0.95);
    EXPECT_GT(found.posterior(11, 1), 0.95);
    EXPECT_GT(found.covariance(kPressureExponent, kPressureExponent), 0.0);
}

TEST(Calibration, WrongGrindsAreRefused) {
    CalibrationSettings settings;
    settings.start = settings.lower = settings.upper = linear();
    MeasuredGrinds g = some(5);
    g.force[2] = -1.0;
    EXPECT_THROW(calibrate(g, {}, settings), InputError);
    g = some(5);
    g.area[1] = kNan;
    EXPECT_THROW(calibrate(g, {}, settings), InputError);
    g = some(5);
    g.time.resize(4);
    EXPECT_THROW(calibrate(g, {}, settings), InputError);
    settings.free[kSpeedExponent] = true;  // without bounds
    EXPECT_THROW(calibrate(some(5), {}, settings), InputError);
}

}  // namespace
}  // namespace beltgrinding

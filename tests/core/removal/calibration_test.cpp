#include "removal/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "beltgrinding/error.h"
#include "beltgrinding/removal_law.h"

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
    x[kLnWearScale] = x[kLnSaturation] = kInf;
    return x;
}

TEST(Calibration, LinearGrindIsHammannsDepth) {
    MeasuredGrinds g = some(1);
    g.feed[0] = 40.0;
    g.time[0] = 1.0 / 40.0;  // per mm of the pass
    g.spread[0] = 25.0;
    GrindVector x = linear();
    x[kLnCoefficient] = std::log(1e-5);
    const double depth = std::exp(log_grind(x, {}, g, 0, g.area[0], nullptr));
    EXPECT_NEAR(depth, hammann_depth(1e-5, 1.0, g.speed[0], g.force[0], 40.0, 25.0), 1e-12);
}

TEST(Calibration, GradientIsThatOfDifferences) {
    MeasuredGrinds g = some(6);
    g.feed[4] = 30.0;
    g.spread[5] = kNan;
    GrindVector x = linear();
    x << -11.0, 1.4, 1.2, 0.1, 1.3, 0.2, std::log(3e5), 0.3, 0.01, std::log(0.4);
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
    }
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

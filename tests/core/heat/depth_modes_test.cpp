#include "heat/depth_modes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beltgrinding {
namespace {

/// mm: what a constant flux does until tau, by the modes.
double response(const DepthModes::Weights& weights, double tau) {
    double sum = weights.direct + weights.modes[0] * tau;
    for (std::size_t j = 1; j < DepthModes::kModes; ++j) {
        const double rate = DepthModes::rates()[j];
        sum += weights.modes[j] * -std::expm1(-rate * tau) / rate;
    }
    return sum;
}

/// The same of a plate, by the cosine series (Carslaw & Jaeger, 3.8).
double series(double d, double tau, bool opposite) {
    double sum = tau / d + (opposite ? -d / 6.0 : d / 3.0);
    for (int n = 20000; n > 0; --n) {
        const double rate = std::pow(n * M_PI / d, 2);
        if (rate * tau > 100.0) continue;
        sum -= 2.0 / d * (opposite && n % 2 == 1 ? -1.0 : 1.0) * std::exp(-rate * tau) / rate;
    }
    return sum;
}

TEST(DepthModes, AHalfSpaceWarmsAsTheRootOfTime) {
    for (double tau = 0.01; tau < 1000.0; tau *= 1.3) {
        const double exact = 2.0 * std::sqrt(tau / M_PI);
        EXPECT_NEAR(response(DepthModes::own(NAN), tau), exact, 0.005 * exact) << tau;
        EXPECT_EQ(response(DepthModes::opposite(NAN), tau), 0.0);
    }
}

TEST(DepthModes, APlateWarmsAsItsSeriesOnBothSides) {
    for (double d = 0.06; d < 140.0; d *= 1.37) {
        for (double tau = 0.01; tau < 1000.0; tau *= 1.7) {
            const double exact = series(d, tau, false);
            EXPECT_NEAR(response(DepthModes::own(d), tau), exact, 0.005 * exact) << d << ' ' << tau;
            EXPECT_NEAR(response(DepthModes::opposite(d), tau), series(d, tau, true), 0.01 * exact)
                << d << ' ' << tau;
        }
    }
}

// While the heat arrives there, each mode of the series counts with its sign: what is wrong by one
// of them is wrong by 0.7 % or more.
TEST(DepthModes, TheOppositeSideFollowsItsSeriesWhileTheHeatArrives) {
    for (double d = 0.2; d < 40.0; d *= 1.37) {
        for (double tau = 0.1 * d * d; tau < 2.0 * d * d; tau *= 1.05) {
            if (tau < 0.01 || tau > 1000.0) continue;
            EXPECT_NEAR(response(DepthModes::opposite(d), tau), series(d, tau, true),
                        0.005 * series(d, tau, false))
                << d << ' ' << tau;
        }
    }
}

TEST(DepthModes, WhatIsStoredInAPlateIsItsHeat) {
    for (const double d : {0.3, 2.0, 40.0}) {
        EXPECT_FLOAT_EQ(DepthModes::own(d).modes[0], static_cast<float>(1.0 / d));
        EXPECT_FLOAT_EQ(DepthModes::opposite(d).modes[0], static_cast<float>(1.0 / d));
    }
}

}  // namespace
}  // namespace beltgrinding

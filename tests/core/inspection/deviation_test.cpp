#include "beltgrinding/deviation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "beltgrinding/error.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

TEST(DeviationStatistics, OfAKnownField) {
    HeightField field = testing::plate(100.0, 10.0, 0.5, 0.3);
    for (std::size_t i = 0; i < field.size(); ++i)
        field.height[i] = field.point[i].x() / 100.0 - 0.5;
    const DeviationStatistics s = deviation_statistics(field, {-0.1, 0.2});
    EXPECT_NEAR(s.min, -0.5, 1e-12);
    EXPECT_NEAR(s.max, 0.5, 1e-12);
    EXPECT_NEAR(s.mean, 0.0, 1e-6);
    EXPECT_NEAR(s.rms, 1.0 / std::sqrt(12.0), 1e-3);
    EXPECT_NEAR(s.p05, -0.45, 0.01);
    EXPECT_NEAR(s.p50, 0.0, 0.01);
    EXPECT_NEAR(s.p95, 0.45, 0.01);
    EXPECT_NEAR(s.in_tolerance_share, 0.3, 0.01);
    EXPECT_NEAR(s.above_share + s.below_share + s.in_tolerance_share, 1.0, 1e-9);
    EXPECT_NEAR(s.design_area, 1000.0, 1e-3);
    EXPECT_NEAR(s.stock_volume, 300.0, 1e-3);
    // Up to x = 80 mm, beyond which the heights lie above the stock: nothing was removed there.
    EXPECT_NEAR(s.removed_volume, 320.0, 1e-2);
}

TEST(DeviationStatistics, MissedSamplesAreCountedAndLeftOut) {
    HeightField field = testing::plate(10.0, 10.0, 1.0, 0.1);
    field.flags[3] |= kMissed;
    field.height[3] = 100.0;
    field.flags[4] |= kDefective;
    const DeviationStatistics s = deviation_statistics(field, {});
    EXPECT_EQ(s.missed, 1u);
    EXPECT_EQ(s.defective, 1u);
    EXPECT_NEAR(s.max, 0.1, 1e-12);
    EXPECT_THROW(deviation_statistics(field, {0.1, -0.1}), InputError);
}

using Rgb = std::array<double, 3>;

Rgb linear(std::uint32_t packed) {
    Rgb c{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double v = (packed >> (24 - 8 * k) & 255U) / 255.0;
        c[k] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    return c;
}

/// CIE Lab (D65) of linear sRGB.
Rgb lab(const Rgb& c) {
    const Rgb xyz{(0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.95047,
                  0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2],
                  (0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.08883};
    Rgb f{};
    for (std::size_t k = 0; k < 3; ++k) {
        f[k] = xyz[k] > 0.008856 ? std::cbrt(xyz[k]) : 7.787 * xyz[k] + 16.0 / 116.0;
    }
    return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

/// Full dichromacy, Machado, Oliveira, Fernandes 2009, severity 1.0, on linear RGB.
Rgb seen_by(const std::array<double, 9>& m, const Rgb& c) {
    Rgb out{};
    for (std::size_t r = 0; r < 3; ++r) {
        out[r] = std::clamp(m[3 * r] * c[0] + m[3 * r + 1] * c[1] + m[3 * r + 2] * c[2], 0.0, 1.0);
    }
    return out;
}

TEST(ColourScale, AboveBelowAndGoodAreToldApartByTheColourBlind) {
    const std::array<std::array<double, 9>, 3> eyes{
        {{1, 0, 0, 0, 1, 0, 0, 0, 1},
         {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
          1.051998},
         {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
          0.968881}}};
    const ColourScale scale{{-0.05, 0.05}, 0.5};
    const auto distance = [](const Rgb& a, const Rgb& b) {
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    for (const auto& eye : eyes) {
        const Rgb good = lab(seen_by(eye, linear(scale.colour(0.0))));
        for (double d = 0.06; d <= 0.5; d += 0.02) {
            const Rgb above = lab(seen_by(eye, linear(scale.colour(d))));
            const Rgb below = lab(seen_by(eye, linear(scale.colour(-d))));
            EXPECT_GT(distance(above, below), 20.0) << d;
            EXPECT_GT(distance(above, good), 20.0) << d;
            EXPECT_GT(distance(below, good), 15.0) << d;
        }
    }
}

constexpr std::array<double, 9> kProtan{0.152286, 1.052583,  -0.204868, 0.114503, 0.786281,
                                        0.099216, -0.003882, -0.048116, 1.051998};
constexpr std::array<double, 9> kDeutan{0.367322, 0.860646,  -0.227968, 0.280085, 0.672501,
                                        0.047413, -0.011820, 0.042940,  0.968881};
constexpr std::array<double, 9> kTritan{1.255528, -0.076749, -0.178779, -0.078411, 0.930809,
                                        0.147602, 0.004733,  0.691367,  0.303900};
constexpr std::array<double, 9> kNormal{1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr double kToldApart = 5.0;  // CIE76 distance; about twice what is just noticed

TEST(ColourScale, NeighbouringStepsAreToldApartByTheColourBlind) {
    const auto distance = [](const Rgb& a, const Rgb& b) {
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    for (const auto& eye : {kNormal, kProtan, kDeutan, kTritan}) {
        for (int bands = 2; bands <= 8; ++bands) {
            const ColourScale scale{{-0.05, 0.05}, 0.5, bands};
            const double step = 0.45 / bands;
            for (const double sign : {1.0, -1.0}) {
                Rgb last = lab(seen_by(eye, linear(scale.colour(0.0))));
                for (int k = 0; k < bands; ++k) {
                    const double d = 0.05 + (k + 0.5) * step;
                    const Rgb here = lab(seen_by(eye, linear(scale.colour(sign * d))));
                    const Rgb other = lab(seen_by(eye, linear(scale.colour(-sign * d))));
                    EXPECT_GT(distance(here, last), kToldApart) << bands << " " << sign * d;
                    EXPECT_GT(distance(here, other), 2 * kToldApart) << bands << " " << sign * d;
                    last = here;
                }
            }
        }
    }
}

TEST(ColourScale, StepsAreEqualAndReachBothEnds) {
    const ColourScale scale{{-0.1, 0.1}, 0.5, 4}, smooth{{-0.1, 0.1}, 0.5};
    EXPECT_EQ(scale.colour(0.11), scale.colour(0.19));
    EXPECT_NE(scale.colour(0.19), scale.colour(0.21));
    EXPECT_EQ(scale.colour(-0.41), scale.colour(-7.0));
    EXPECT_EQ(scale.colour(0.45), smooth.colour(0.5));
    EXPECT_EQ(scale.colour(0.0), smooth.colour(0.0));
    EXPECT_EQ(ColourScale({{-0.1, 0.1}, 0.5, 1}).colour(0.11), smooth.colour(0.3));
}

TEST(ColourScale, OneCalmColourInsideTheBand) {
    const ColourScale scale{{-0.05, 0.1}, 0.5};
    EXPECT_EQ(scale.colour(-0.05), scale.colour(0.1));
    EXPECT_NE(scale.colour(0.101), scale.colour(0.1));
    EXPECT_NE(scale.colour(-0.051), scale.colour(0.0));
    EXPECT_EQ(scale.colour(5.0), scale.colour(0.5));
    EXPECT_EQ(scale.colour(std::nan("")), scale.missed_colour());
    EXPECT_EQ(scale.colour(0.0) & 255U, 255U);
}

TEST(ColourScale, ChosenColoursStandInTheMiddleOfTheirRamps) {
    const ColourScale scale{
        {-0.1, 0.1}, 0.5, 0, ColourScale::Choice{0x10C020FF, 0xC02010FF, 0x2010C0FF}};
    EXPECT_EQ(scale.colour(0.0), 0x10C020FFU);
    EXPECT_EQ(scale.colour(0.3), 0xC02010FFU);
    EXPECT_EQ(scale.colour(-0.3), 0x2010C0FFU);
    EXPECT_EQ(scale.colour(0.5), 0x4D0D06FFU);  // two fifths as bright
    EXPECT_EQ(scale.colour(std::nan("")), scale.missed_colour());
}

}  // namespace
}  // namespace beltgrinding

// Moving sources on a half-space: Jaeger, Moving sources of heat and the temperature at sliding
// contacts (J. Proc. Roy. Soc. New South Wales 76, 1942); Carslaw & Jaeger, 2nd ed., 10.7. The
// closed forms are integrated here, by themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "plate.h"

namespace beltgrinding {
namespace {

/// Integral of exp(-u) K0(|u|) from a to b. The singular middle by its series, the rest by the
/// midpoint rule.
double jaeger_integral(double a, double b) {
    if (a < 0.0 && b > 0.0) return jaeger_integral(a, 0.0) + jaeger_integral(0.0, b);
    const double sign = b > 0.0 ? 1.0 : -1.0;
    double low = std::min(std::abs(a), std::abs(b)), high = std::max(std::abs(a), std::abs(b));
    high = std::min(high, low + 400.0);
    // u = v^2: the logarithm at 0 is smoothed away.
    constexpr int kParts = 3000;
    const double from = std::sqrt(low), step = (std::sqrt(high) - from) / kParts;
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) {
        const double v = from + (k + 0.5) * step, u = v * v;
        // exp(u) K0(u), without overflow
        const double scaled = u < 300.0 ? std::exp(u) * std::cyl_bessel_k(0.0, u)
                                        : std::sqrt(M_PI / (2.0 * u)) * (1.0 - 1.0 / (8.0 * u));
        sum += std::exp(-(1.0 + sign) * u) * scaled * 2.0 * v * step;
    }
    return sum;
}

/// K: of a band of half length l mm that moves along +x at `speed` mm/s, x mm from its middle; flux
/// q N/(mm s).
double band(const HeatMaterial& m, double q, double speed, double l, double x) {
    const double scale = speed / (2.0 * m.diffusivity());
    return 2.0 * q * m.diffusivity() / (M_PI * m.conductivity * speed) *
           jaeger_integral(scale * (x - l), scale * (x + l));
}

struct Band {
    const char* name;
    double peclet;  // V l / (2 alpha)
};

class JaegerBand : public testing::TestWithParam<Band> {};

TEST_P(JaegerBand, TheTemperatureUnderItAndBehindItIsTheClosedForms) {
    const HeatMaterial m = steel();
    const double l = 6.0, h = 0.25, q = 20.0;
    const double speed = 2.0 * m.diffusivity() * GetParam().peclet / l;
    const int along = 521;  // 130 mm
    const HeightField field = plate(along, 3, h);
    const PartHeat part(field, h, m);
    Conduction conduction(part);
    const double step = std::min(h, speed * 0.05);
    double middle = 15.0;
    // Until it is stationary, and to the end of the plate at most.
    for (; middle < 100.0; middle += step) {
        for (std::uint32_t k = 0; k < part.size(); ++k) {
            const double x = field.point[part.samples()[k]].x() - middle - 0.5 * step;
            // A node has the share of its cell that lies under the band.
            const double share = (std::min(x + 0.5 * h, l) - std::max(x - 0.5 * h, -l)) / h;
            if (share > 0.0) conduction.add(k, q * share * part.nodes().area[k]);
        }
        conduction.advance(step / speed, 3);
    }
    const HeatState& state = conduction.settle();
    std::vector<double> now(part.size());
    for (std::uint32_t k = 0; k < part.size(); ++k) now[k] = conduction.rise(k);
    double most = 0.0, sought = 0.0;
    for (double x = -3.0 * l; x <= 2.0 * l; x += h)
        sought = std::max(sought, band(m, q, speed, l, x));
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const double x = field.point[part.samples()[k]].x() - middle;
        if (x < -2.5 * l || x > 1.6 * l) continue;
        most = std::max(most, now[k]);
        if (std::abs(std::abs(x) - l) < 2.0 * h) continue;  // the flux jumps there
        // Further behind, what goes over the border of the zone lags.
        const double share = std::abs(x) < l + 1.5 ? 0.01 : 0.03;
        EXPECT_NEAR(now[k], band(m, q, speed, l, x), share * sought) << x;
    }
    EXPECT_NEAR(most, sought, 0.01 * sought);
    // What every sample saw is the same, once the band has gone by.
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const double x = field.point[part.samples()[k]].x();
        if (x < 70.0 || x > 90.0) continue;
        EXPECT_NEAR(state.peak[k], sought, 0.01 * sought);
        EXPECT_EQ(state.source[k], 3u);
    }
}

INSTANTIATE_TEST_SUITE_P(Peclet, JaegerBand,
                         testing::Values(Band{"Half", 0.5}, Band{"Two", 2.0}, Band{"Ten", 10.0},
                                         Band{"Thirty", 30.0}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(JaegerPoint, TheTemperatureRoundItIsTheClosedForm) {
    const HeatMaterial m = steel();
    const double h = 0.25, power = 4000.0;  // N mm/s
    const double speed = 2.0, middle = 12.0;
    const int along = 221, across = 97;  // 55 mm by 24 mm
    const HeightField field = plate(along, across, h);
    const PartHeat part(field, h, m);
    Conduction conduction(part, 100);  // all is conducted at every step
    std::vector<std::uint32_t> track(along);
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const Vec3& p = field.point[part.samples()[k]];
        if (std::abs(p.y() - middle) < 1e-6)
            track[static_cast<std::size_t>(std::lround(p.x() / h))] = k;
    }
    double at = 10.0;
    const double step = 0.0625;
    for (; at < 43.0; at += step) {
        const double place = (at + 0.5 * step) / h;
        const auto before = static_cast<std::size_t>(place);
        conduction.add(track[before], power * (1.0 - (place - static_cast<double>(before))));
        conduction.add(track[before + 1], power * (place - static_cast<double>(before)));
        conduction.advance(step / speed, 0);
    }
    int seen = 0;
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const Vec3& p = field.point[part.samples()[k]];
        const double x = p.x() - at, y = p.y() - middle, r = std::hypot(x, y);
        // Nearer to it, the nodes that it flows into are no point.
        if (r < 7.0 * h || r > 5.0) continue;
        // Its way lies between two nodes, which it flows into by turns: spread by a hat along it.
        double exact = 0.0;
        for (int n = -20; n < 20; ++n) {
            const double u = (n + 0.5) / 20.0, from = x - u * h, away = std::hypot(from, y);
            exact += (1.0 - std::abs(u)) / 20.0 * power / (2.0 * M_PI * m.conductivity * away) *
                     std::exp(-speed * (away + from) / (2.0 * m.diffusivity()));
        }
        EXPECT_NEAR(conduction.rise(k), exact, 0.01 * exact + 0.02) << x << ' ' << y;
        ++seen;
    }
    EXPECT_GT(seen, 400);
}

}  // namespace
}  // namespace beltgrinding

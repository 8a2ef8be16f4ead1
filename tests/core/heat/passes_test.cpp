// A rectangle that runs in passes over a half-space, against Green's function, which is integrated
// here by itself: Carslaw & Jaeger, 2nd ed., 10.4.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "plate.h"

namespace beltgrinding {
namespace {

constexpr double kSide = 3.0, kHalfWidth = 10.0;  // mm, along the pass and across, halves
constexpr double kFlux = 2000.0;                  // N mm/s on 1 mm2

struct Pose {
    double x, y, begin, end;
};

/// To the right and back, a node's distance a step, overlapping by half.
std::vector<Pose> passes(double speed) {
    std::vector<Pose> poses;
    double time = 0.0;
    for (const bool back : {false, true}) {
        for (int k = 0; k < 34; ++k) {
            const double x = back ? 51.5 - k : 18.5 + k;
            poses.push_back({x, back ? 28.0 : 18.0, time, time + 1.0 / speed});
            time += 1.0 / speed;
        }
    }
    return poses;
}

/// K, at (x, y) at the end of `last`.
double exact(const HeatMaterial& m, const std::vector<Pose>& poses, std::size_t last, double x,
             double y) {
    const double now = poses[last].end;
    double sum = 0.0;
    for (std::size_t i = 0; i <= last; ++i) {
        // In the root of the time since: the integrand's own root is smoothed away.
        const double to = std::sqrt(now - poses[i].begin), from = std::sqrt(now - poses[i].end);
        const int parts = i == last ? 16 : i + 4 > last ? 6 : 2;
        for (int k = 0; k < parts; ++k) {
            const double v = from + (k + 0.5) * (to - from) / parts;
            const double reach = 2.0 * v * std::sqrt(m.diffusivity());
            const auto share = [reach](double at, double half) {
                return 0.5 * (std::erf((at + half) / reach) - std::erf((at - half) / reach));
            };
            sum += share(x - poses[i].x, kSide) * share(y - poses[i].y, kHalfWidth) * 2.0 *
                   (to - from) / parts;
        }
    }
    return kFlux * sum / std::sqrt(M_PI * m.conductivity * m.capacity());
}

struct Case {
    const char* name;
    double conductivity, speed;  // W/(m K), mm/s
};

class Passes : public testing::TestWithParam<Case> {};

TEST_P(Passes, TheGreatestTemperaturesAreThoseOfGreensFunction) {
    HeatMaterial m = steel();
    m.conductivity = GetParam().conductivity;
    const HeightField field = plate(71, 51, 1.0);
    const PartHeat part(field, 1.0, m);
    const std::vector<Pose> poses = passes(GetParam().speed);
    Conduction conduction(part);
    for (const Pose& pose : poses) {
        for (std::uint32_t k = 0; k < part.size(); ++k) {
            const Vec3& p = field.point[part.samples()[k]];
            const auto share = [](double at, double half) {
                return std::clamp(std::min(at + 0.5, half) - std::max(at - 0.5, -half), 0.0, 1.0);
            };
            conduction.add(
                k, kFlux * share(p.x() - pose.x, kSide) * share(p.y() - pose.y, kHalfWidth));
        }
        conduction.advance(pose.end - pose.begin, 0);
    }
    const HeatState& state = conduction.settle();
    std::vector<double> found, sought;
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const Vec3& p = field.point[part.samples()[k]];
        // Where the flux jumps from one node to the next, and where a pass begins, it is uncertain
        // by a share of a node's distance where a node stands.
        if (std::lround(p.x()) % 8 != 0 || std::lround(p.y()) % 2 != 0) continue;
        if (p.x() < 24.0 || p.x() > 48.0 || p.y() < 10.0 || p.y() > 36.0) continue;
        if (std::abs(std::abs(p.y() - 18.0) - kHalfWidth) < 1.5) continue;
        if (std::abs(std::abs(p.y() - 28.0) - kHalfWidth) < 1.5) continue;
        double most = 0.0;
        for (std::size_t i = 0; i < poses.size(); ++i)
            if (std::abs(p.x() - poses[i].x) < kSide + 6.0)
                most = std::max(most, exact(m, poses, i, p.x(), p.y()));
        found.push_back(state.peak[k]);
        sought.push_back(most);
    }
    ASSERT_GT(found.size(), 30u);
    const double greatest = *std::max_element(sought.begin(), sought.end());
    for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], sought[k], 0.01 * greatest) << k;
}

INSTANTIATE_TEST_SUITE_P(Materials, Passes,
                         testing::Values(Case{"Steel", 16.0, 100.0}, Case{"SteelSlow", 16.0, 10.0},
                                         Case{"Aluminium", 310.0, 100.0}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace beltgrinding

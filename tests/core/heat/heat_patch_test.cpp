#include "heat/heat_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace beltgrinding {
namespace {

constexpr std::size_t kNodes = 48;
constexpr double kRate = 4.0;  // 1/s, each way: diffusivity over distance^2

/// Nodes in a ring.
HeatPatch ring() {
    HeatPatch patch;
    for (std::uint32_t k = 0; k < kNodes; ++k) {
        patch.nodes.push_back(k);
        patch.first.push_back(2 * k);
        for (const std::size_t other : {(k + kNodes - 1) % kNodes, (k + 1) % kNodes})
            patch.ways.push_back({static_cast<std::uint32_t>(other), kRate, kRate});
    }
    patch.first.push_back(2 * kNodes);
    patch.slow.assign(kNodes, 0);
    patch.most = 2.0 * kRate;
    return patch;
}

std::vector<float> wave(int number) {
    std::vector<float> rows;
    for (std::size_t k = 0; k < kNodes; ++k)
        for (std::size_t j = 0; j < RowConductor::kModes; ++j)
            rows.push_back(static_cast<float>(
                10.0 + std::cos(2.0 * M_PI * number * static_cast<double>(k) / kNodes)));
    return rows;
}

// In one dimension the dispersion is 1 / 12 of the distance squared.
TEST(RowConductor, WavesDecayAsTheDifferentialEquationSaysWhateverTheTime) {
    const HeatPatch patch = ring();
    RowConductor conductor;
    for (const double duration : {0.01, 0.1, 1.0, 10.0}) {
        for (const int number : {1, 4, 8}) {
            std::vector<float> rows = wave(number), sums;
            conductor.conduct(patch, duration, 1.0 / 12.0 / (kRate * duration), rows, sums);
            const double k = 2.0 * M_PI * number / kNodes;
            const double left = std::exp(-kRate * k * k * duration);
            // What is left out of the series is some per cent of waves that go soon anyway.
            const double most = number == 1 ? 0.004 : 0.05;
            EXPECT_NEAR(rows[0], 10.0 + left, most) << duration << ' ' << number;
            EXPECT_NEAR(sums[0], RowConductor::kModes * (10.0 + left), 16.0 * most);
            double mean = 0.0;
            for (std::size_t n = 0; n < kNodes; ++n)
                mean += rows[n * RowConductor::kModes] / kNodes;
            EXPECT_NEAR(mean, 10.0, 2e-5);
        }
    }
}

TEST(RowConductor, OfSlowNodesOnlyTheSlowerModesAreConducted) {
    HeatPatch patch = ring();
    patch.slow.assign(kNodes, 1);
    RowConductor conductor;
    std::vector<float> rows = wave(4), sums, whole = rows;
    conductor.conduct(patch, 0.1, 0.1, rows, sums);
    conductor.conduct(ring(), 0.1, 0.1, whole, sums);
    for (std::size_t k = 0; k < rows.size(); ++k)
        EXPECT_EQ(rows[k], k % RowConductor::kModes < 8 ? whole[k] : 0.0f);
}

}  // namespace
}  // namespace beltgrinding

// What a verdict costs on a million samples: the judgement with its clusters, an edge zone, the
// thickness by rays, the waviness by sections.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>

#include "beltgrinding/verdict.h"
#include "inspection/waviness.h"
#include "support/synthetic_field.h"
#include "thickness/thickness.h"

namespace beltgrinding {
namespace {

constexpr double kSide = 200.0;     // mm
constexpr double kSpacing = 0.2;    // mm: a million samples
constexpr double kDistance = 10.0;  // mm, between passes

/// A wavy plate, ground in passes along x, with excess and gouges on every wave and specks besides.
HeightField ground() {
    HeightField field = testing::plate(kSide, kSide, kSpacing, 0.3);
    field.trace.reset(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3& p = field.point[i];
        field.height[i] =
            0.06 * std::sin(2.0 * M_PI * p.y() / kDistance) * std::sin(2.0 * M_PI * p.x() / 50.0) +
            (i % 997 == 0 ? 0.1 : 0.0);
        const auto motion = static_cast<std::uint32_t>(2.0 * std::floor(p.y() / kDistance)) + 1;
        field.trace.first[i] = field.trace.dominant[i] = field.trace.last[i] = motion;
        field.trace.peak_pressure[i] = 0.1F;
    }
    return field;
}

void verdict_cost(benchmark::State& state) {
    const HeightField field = ground();
    std::vector<ToleranceZone> zones;
    if (state.range(0) != 0) zones.push_back({{-0.05, 0.05}, {}, 1.0, {}});
    std::size_t clusters = 0;
    for (auto _ : state) clusters = judge(field, zones, {-0.05, 0.05}).clusters.size();
    state.counters["clusters"] = static_cast<double>(clusters);
}
BENCHMARK(verdict_cost)->ArgName("edge_zone")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void thickness_cost(benchmark::State& state) {
    const HeightField field = ground();
    TriangleMesh others;
    const auto side = static_cast<float>(kSide);
    others.vertices = {{0, 0, -4}, {side, 0, -4}, {side, side, -4}, {0, side, -4}};
    others.triangles = {{0, 2, 1}, {0, 3, 2}};
    std::vector<std::uint32_t> samples(field.size());
    std::iota(samples.begin(), samples.end(), 0U);
    for (auto _ : state) {
        const Thickness found = measure_thickness(field, samples, others);
        benchmark::DoNotOptimize(found.deviation.data());
    }
}
BENCHMARK(thickness_cost)->Unit(benchmark::kMillisecond)->UseRealTime();

void waviness_cost(benchmark::State& state) {
    const HeightField field = ground();
    std::vector<MotionEnd> ends;
    for (double y = 0.5 * kDistance; y < kSide; y += kDistance) {
        const bool fro = ends.size() % 4 == 2;
        ends.push_back({Vec3(fro ? kSide : 0.0, y, 0.0), ends.empty()});
        ends.push_back({Vec3(fro ? 0.0 : kSide, y, 0.0), false});
    }
    double wt = 0.0;
    for (auto _ : state) wt = waviness(field, ends).front().across.value().total;
    state.counters["Wt_um"] = 1000.0 * wt;
}
BENCHMARK(waviness_cost)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace beltgrinding

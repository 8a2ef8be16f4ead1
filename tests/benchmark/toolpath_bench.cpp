// What planning a path's speed costs beside cutting it into steps: 0.1 mm apart, with zones, exact
// stops, or at constant feed.
#include <benchmark/benchmark.h>

#include <cmath>

#include "beltgrinding/tool_path.h"

namespace beltgrinding {
namespace {

std::vector<PathPose> wave(std::int64_t count, double zone) {
    std::vector<PathPose> poses;
    for (std::int64_t k = 0; k < count; ++k) {
        const double x = 0.1 * static_cast<double>(k);
        PathPose pose;
        pose.base_from_tcp = Eigen::Translation3d(x, 20.0 * std::sin(0.05 * x), 0.0) *
                             Eigen::AngleAxisd(0.3 * std::sin(0.01 * x), Vec3::UnitY());
        pose.zone = zone;
        poses.push_back(pose);
    }
    return poses;
}

TimeLaw trapezoidal() {
    TimeLaw law;
    law.timing = TimeLaw::Timing::kTrapezoidal;
    return law;
}

void plan(benchmark::State& state) {
    const auto poses = wave(state.range(0), static_cast<double>(state.range(1)));
    for (auto _ : state) {
        const ToolPath path(poses, {}, trapezoidal());
        benchmark::DoNotOptimize(path.duration());
    }
}
BENCHMARK(plan)
    ->ArgNames({"poses", "zone"})
    ->ArgsProduct({{10'000, 100'000}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

void steps(benchmark::State& state) {
    const auto poses = wave(state.range(0), 1.0);
    const ToolPath path(poses, {}, state.range(1) != 0 ? trapezoidal() : TimeLaw{});
    for (auto _ : state) benchmark::DoNotOptimize(path.steps({}).size());
}
BENCHMARK(steps)
    ->ArgNames({"poses", "trapezoidal"})
    ->ArgsProduct({{100'000}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beltgrinding

// What following bodies costs: a distance of two bodies by size, as the path is walked (near the
// last points) and anew; and a whole path of a disc that keeps its distance over a wavy sheet, as a
// wheel's body does over a part.
#include <benchmark/benchmark.h>

#include <cmath>

#include "collision/collision_check.h"
#include "collision/collision_mesh.h"

namespace beltgrinding {
namespace {

constexpr double kSide = 200.0, kWave = 5.0;  // mm

/// A wavy sheet of `n` by `n` quads over [0, kSide]^2.
TriangleMesh sheet(int n) {
    TriangleMesh mesh;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            const double x = kSide * i / n, y = kSide * j / n;
            mesh.vertices.push_back(
                Vec3(x, y, kWave * std::sin(0.05 * x) * std::cos(0.04 * y)).cast<float>());
        }
    }
    const auto row = static_cast<std::uint32_t>(n + 1);
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const auto a = static_cast<std::uint32_t>(j) * row + static_cast<std::uint32_t>(i);
            mesh.triangles.push_back({a, a + 1, a + row});
            mesh.triangles.push_back({a + 1, a + row + 1, a + row});
        }
    }
    return mesh;
}

/// A disc of 50 mm radius, 20 mm wide, axis y.
TriangleMesh disc() {
    TriangleMesh mesh;
    constexpr std::uint32_t kAround = 60;
    for (const double y : {-10.0, 10.0}) {
        for (std::uint32_t k = 0; k < kAround; ++k) {
            const double angle = 2.0 * M_PI * k / kAround;
            mesh.vertices.push_back(
                Vec3(50.0 * std::sin(angle), y, 50.0 * std::cos(angle)).cast<float>());
        }
    }
    for (std::uint32_t k = 0; k < kAround; ++k) {
        const std::uint32_t next = (k + 1) % kAround;
        mesh.triangles.push_back({k, next, kAround + k});
        mesh.triangles.push_back({next, kAround + next, kAround + k});
        mesh.triangles.push_back({0, next, k});
        mesh.triangles.push_back({kAround, kAround + k, kAround + next});
    }
    return mesh;
}

void distance_of_bodies(benchmark::State& state) {
    const CollisionMesh a(sheet(static_cast<int>(std::sqrt(state.range(0) / 2.0)))), b(disc());
    const bool known = state.range(1) != 0;
    NearestPoints last;
    int k = 0;
    for (auto _ : state) {
        const double x = 20.0 + 0.1 * (k++ % 1600);
        const Frame place = Frame(Eigen::Translation3d(x, 100.0, 65.0));
        const NearestPoints found = a.nearest(b, place, known ? last : NearestPoints());
        benchmark::DoNotOptimize(last = found);
    }
}
BENCHMARK(distance_of_bodies)
    ->ArgNames({"triangles", "known"})
    ->Args({2'000, 0})
    ->Args({2'000, 1})
    ->Args({200'000, 0})
    ->Args({200'000, 1})
    ->Unit(benchmark::kMicrosecond);

void whole_path(benchmark::State& state) {
    std::vector<PathPose> poses;
    for (int row = 0; row < 20; ++row) {
        for (int k = 0; k <= 20; ++k) {
            PathPose pose;
            pose.base_from_tcp =
                Eigen::Translation3d(10.0 * (row % 2 ? 20 - k : k), 10.0 * row, 65.0);
            poses.push_back(pose);
        }
    }
    const ToolPath path(poses, {});
    const std::vector<CollisionBody> bodies{
        {"part", Carrier::kPart, sheet(static_cast<int>(std::sqrt(state.range(0) / 2.0))), 0.0},
        {"wheel", Carrier::kTool, disc(), 0.0}};
    double least = 0.0;
    for (auto _ : state) {
        const auto found = check_collisions(path, bodies, {});
        least = found.pairs[0].distance;
    }
    state.counters["mm"] = path.duration() * poses[1].feed;
    state.counters["least"] = least;
}
BENCHMARK(whole_path)
    ->ArgName("triangles")
    ->Arg(2'000)
    ->Arg(20'000)
    ->Arg(200'000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beltgrinding

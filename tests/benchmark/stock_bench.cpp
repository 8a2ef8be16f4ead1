// Stock from a mesh: a million normal rays against half a million triangles, building Embree's tree
// included, by threads. Every sample casts two rays: to the first surface, and on behind it.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "beltgrinding/stock.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// The outer surface of stock 0.3 mm above the cylinder, half as fine as the samples.
TriangleMesh scan() {
    const HeightField field = testing::cylinder(150.0, 200.0, 200.0, 0.4, 0.3);
    TriangleMesh mesh;
    for (std::size_t i = 0; i < field.size(); ++i) {
        mesh.vertices.push_back(
            (field.point[i] + 0.3 * field.normal[i].cast<double>()).cast<float>());
    }
    mesh.triangles = field.triangles.unpacked();
    return mesh;
}

void stock_rays(benchmark::State& state) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(state.range(0)));
    HeightField field = testing::cylinder(150.0, 200.0, 200.0, 0.2, 0.0);
    const TriangleMesh mesh = scan();
    std::size_t missed = 0;
    for (auto _ : state) missed = apply_mesh(field, mesh, StockOptions{}).missed;
    state.counters["samples"] = static_cast<double>(field.size());
    state.counters["missed"] = static_cast<double>(missed);
    state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
    state.counters["rays_per_s_and_thread"] = benchmark::Counter(
        2.0 * static_cast<double>(field.size()) / static_cast<double>(state.range(0)),
        benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(stock_rays)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beltgrinding

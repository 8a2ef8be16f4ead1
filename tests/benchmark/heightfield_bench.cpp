// The k-DOP tree over a million segments: build, query of about 20 k hits, refit of what a contact
// changes; bytes a sample as a counter.
#include <benchmark/benchmark.h>

#include "heightfield/kdop_tree.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

const HeightField& million() {
    static const HeightField field = testing::cylinder(150.0, 200.0, 200.0, 0.2, 0.3);
    return field;
}

/// A wheel of radius 100 mm and width 30 mm, pressed so deep that about 20 k segments are hit.
WheelReach contact() {
    WheelReach reach;
    reach.radius = 100.0;
    reach.half_width = 15.0;
    reach.centre = Vec3(0.0, 100.0, 0.3 + 100.0 - 1.05);
    reach.direction = -Vec3::UnitZ();
    reach.min_along = 50.0;
    return reach;
}

void tree_build(benchmark::State& state) {
    for (auto _ : state) {
        const SegmentTree tree(million());
        benchmark::DoNotOptimize(tree.bytes());
    }
    const SegmentTree tree(million());
    state.counters["bytes_per_sample"] = static_cast<double>(tree.bytes() + million().bytes()) /
                                         static_cast<double>(million().size());
}
BENCHMARK(tree_build)->Unit(benchmark::kMillisecond);

void tree_query(benchmark::State& state) {
    const SegmentTree tree(million());
    std::vector<std::uint32_t> hits;
    for (auto _ : state) tree.query(million(), contact(), hits);
    state.counters["hits"] = static_cast<double>(hits.size());
}
BENCHMARK(tree_query)->Unit(benchmark::kMillisecond);

void tree_refit(benchmark::State& state) {
    SegmentTree tree(million());
    std::vector<std::uint32_t> hits;
    tree.query(million(), contact(), hits);
    for (auto _ : state) tree.refit(million(), hits);
    state.counters["hits"] = static_cast<double>(hits.size());
}
BENCHMARK(tree_refit)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beltgrinding

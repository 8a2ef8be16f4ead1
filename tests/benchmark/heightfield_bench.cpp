// The blocks over a million segments: build, query of the tree, the blocks near a wheel that holds
// about 20 k; bytes a sample as a counter.
#include <benchmark/benchmark.h>

#include "heightfield/sample_blocks.h"
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

void blocks_build(benchmark::State& state) {
    for (auto _ : state) {
        const SampleBlocks blocks(million());
        benchmark::DoNotOptimize(blocks.bytes());
    }
    const SampleBlocks blocks(million());
    state.counters["bytes_per_sample"] =
        static_cast<double>(blocks.bytes()) / static_cast<double>(million().size());
    state.counters["of_the_field"] =
        static_cast<double>(million().bytes()) / static_cast<double>(million().size());
}
BENCHMARK(blocks_build)->Unit(benchmark::kMillisecond);

void tree_query(benchmark::State& state) {
    const SegmentTree tree(million());
    std::vector<std::uint32_t> found;
    for (auto _ : state) tree.query(contact(), found);
    state.counters["leaves"] = static_cast<double>(found.size());
}
BENCHMARK(tree_query)->Unit(benchmark::kMicrosecond);

void blocks_near(benchmark::State& state) {
    const SampleBlocks blocks(million());
    NearBlocks near;
    std::vector<std::uint32_t> found;
    for (auto _ : state) near.find(blocks, contact(), found);
    state.counters["blocks"] = static_cast<double>(found.size());
}
BENCHMARK(blocks_near)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace beltgrinding

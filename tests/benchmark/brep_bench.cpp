#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "beltgrinding/shape.h"

namespace {

using namespace beltgrinding;

std::filesystem::path part(const char* name) {
    const char* named = std::getenv("BELTGRINDING_SHARED");
    const std::filesystem::path root =
        named ? std::filesystem::path(named)
              : std::filesystem::path(__FILE__).parent_path() / "../../../shared";
    return root / "data/cad" / name;
}

/// Samples the faces of a part; the argument is the spacing in micrometres. What reading a file
/// finds out of a part (areas, sides, extents) is known, or found anew each time, as for a shape
/// that FreeCAD hands over.
void sample(benchmark::State& state, const char* name, bool known) {
    if (!std::filesystem::exists(part(name))) {
        state.SkipWithError("shared data absent (set BELTGRINDING_SHARED)");
        return;
    }
    const std::string text = Shape::read(part(name).string()).write_brep();
    SamplingOptions options;
    options.spacing = 1e-3 * static_cast<double>(state.range(0));
    std::size_t samples = 0;
    for (auto _ : state) {
        state.PauseTiming();
        const Shape shape = Shape::from_brep(text, name);
        if (known) (void)shape.warnings();
        state.ResumeTiming();
        samples = sample_faces(shape, {}, options).size();
    }
    state.counters["samples"] = static_cast<double>(samples);
    state.counters["samples_per_s"] = benchmark::Counter(
        static_cast<double>(samples), benchmark::Counter::kIsIterationInvariantRate);
}

void sample_part(benchmark::State& state, const char* name) {
    sample(state, name, true);
}

void sample_new_part(benchmark::State& state, const char* name) {
    sample(state, name, false);
}

}  // namespace

BENCHMARK_CAPTURE(sample_part, airfoil, "blade_airfoil_periodic.igs")
    ->Arg(500)
    ->Arg(114)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sample_part, marine_blade, "blade_marine_solid_derived.step")
    ->Arg(130)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sample_part, housing, "housing_with_spout.brep")
    ->Arg(300)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sample_new_part, marine_blade, "blade_marine_solid_derived.step")
    ->Arg(130)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sample_new_part, housing, "housing_with_spout.brep")
    ->Arg(300)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

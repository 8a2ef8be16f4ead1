// What a step costs: localise, gap, contact, removal, on plates of 0.25, 1 and 4 million
// samples at the same spacing. The counters are microseconds a step by phase; a step must cost what
// the contact costs, so they should hardly change with the size of the field.
#include <benchmark/benchmark.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <memory>

#include "beltgrinding/simulation.h"
#include "contact/wheel_rim.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr double kSpacing = 0.2;  // mm

void step_cost(benchmark::State& state) {
    const double side = kSpacing * std::sqrt(static_cast<double>(state.range(0)));
    HeightField field = testing::plate(side, side, kSpacing, 0.3);
    ElasticFoundation foundation(0.5);
    WheelRimDesign design;
    design.layers = {{15.0, {5.0, 0.45}}};
    const auto cache = std::filesystem::temp_directory_path() / "beltgrinding-bench";
    WheelRim rim(design, {}, std::make_shared<FolderRimCache>(cache));
    const ContactModel& elastic = state.range(1) == 0 ? static_cast<const ContactModel&>(foundation)
                                                      : static_cast<const ContactModel&>(rim);
    const LocalLaw law({1e-5});
    SimulationOptions options;
    options.process.wheel = {100.0, 50.0, 0.0};
    options.process.force = 100.0;
    std::vector<PathPose> poses(2);
    for (std::size_t k = 0; k < 2; ++k) {
        poses[k].base_from_tcp =
            Eigen::Translation3d(k == 0 ? 20.0 : side - 20.0, 0.5 * side, 0.3) *
            Eigen::AngleAxisd(M_PI, Vec3::UnitX());
    }
    const ToolPath path(poses, {});
    SimulationResult result;
    {
        HeightField first = field;  // the rim is solved once, no part of a step
        simulate(first, path, elastic, law, options);
    }
    double steps = 0, localise = 0, gap = 0, contact = 0, removal = 0, segments = 0;
    for (auto _ : state) {
        result = simulate(field, path, elastic, law, options);
        steps += static_cast<double>(result.steps.size());
        localise += result.wall.localise;
        gap += result.wall.gap;
        contact += result.wall.contact;
        removal += result.wall.removal;
        for (const StepRecord& step : result.steps) segments += step.segments;
        // The tree's build is no part of a step.
        state.SetIterationTime(result.wall.localise + result.wall.gap + result.wall.contact +
                               result.wall.removal);
    }
    state.counters["segments"] = segments / steps;
    state.counters["step_us"] = 1e6 * (localise + gap + contact + removal) / steps;
    state.counters["localise_us"] = 1e6 * localise / steps;
    state.counters["gap_us"] = 1e6 * gap / steps;
    state.counters["contact_us"] = 1e6 * contact / steps;
    state.counters["removal_us"] = 1e6 * removal / steps;
}
BENCHMARK(step_cost)
    ->ArgNames({"samples", "rim"})
    ->ArgsProduct({{250'000, 1'000'000, 4'000'000}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

// The removal trace: the same path with and without it, in turns in one run, on a million samples.
// Counters: the ratio of the processor times, which other work on the machine does not disturb, and
// memory in bytes a sample.
void trace_cost(benchmark::State& state) {
    const double side = kSpacing * 1000.0;
    const HeightField before = testing::plate(side, side, kSpacing, 0.3);
    ElasticFoundation foundation(0.5);
    const LocalLaw law({1e-5});
    SimulationOptions options;
    options.process.wheel = {100.0, 50.0, 0.0};
    options.process.force = 100.0;
    std::vector<PathPose> poses;
    for (int k = 0; k < 8; ++k) {  // to and fro, neighbouring passes overlap
        PathPose pose;
        pose.base_from_tcp = Eigen::Translation3d((k / 2 + k) % 2 == 0 ? 20.0 : side - 20.0,
                                                  40.0 + 30.0 * (k / 2), 0.3) *
                             Eigen::AngleAxisd(M_PI, Vec3::UnitX());
        poses.push_back(pose);
    }
    const ToolPath path(poses, {});
    std::array<double, 2> seconds{};
    double kept = 0.0, steps = 0.0;
    for (auto _ : state) {
        for (const bool trace : {false, true}) {
            HeightField field = before;
            options.outputs.trace = trace;
            const std::clock_t start = std::clock();
            const SimulationResult result = simulate(field, path, foundation, law, options);
            const auto clocks = static_cast<double>(std::clock() - start);
            seconds[trace ? 1 : 0] += clocks / CLOCKS_PER_SEC;
            kept += result.wall.trace;
            steps += static_cast<double>(trace ? result.steps.size() : 0);
            state.counters["bytes_a_sample"] =
                static_cast<double>(field.trace.bytes()) / static_cast<double>(field.size());
        }
    }
    state.counters["ratio"] = seconds[1] / seconds[0];
    state.counters["trace_us"] = 1e6 * kept / steps;
    state.counters["step_us"] = 1e6 * seconds[1] / steps;
}
BENCHMARK(trace_cost)->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace beltgrinding

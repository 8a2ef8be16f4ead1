// What a step costs: localise, gap, contact, removal, on plates of 0.25, 1, 4 and 16 million
// samples at the same spacing, and on rough stock on a doubly curved face. The counters are
// microseconds of wall time a step by phase, with trace and events beside the sum; bytes that the
// samples in reach hold; and the step as a multiple of a limit that is measured in the same run:
// the same samples read, changed and written once with 130 operations each, without any contact.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/lanes.h"
#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "gap/placed_block.h"
#include "heightfield/sample_blocks.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr double kSpacing = 0.2;  // mm

constexpr int kRead = 9, kWritten = 2;  // numbers of four bytes: 44 bytes a sample

/// 130 operations on each of `count` (a multiple of 8) samples.
BELTGRINDING_CLONES
void touch(const float* in, float* out, std::size_t count) {
    using namespace lanes;
    for (std::size_t k = 0; k < count; k += kWide) {
        Floats sums[4] = {load(in + k), load(in + count + k), load(in + 2 * count + k),
                          load(in + 3 * count + k)};
        for (std::size_t n = 4; n < kRead; ++n) {
            const Floats more = load(in + n * count + k);
            for (Floats& sum : sums) {
                sum = sum * more + 0.5f;
                sum = sum * more + 0.25f;
                sum = sum * more + 0.125f;
            }
        }
        store(out + k, sums[0] + sums[1] * sums[2]);
        store(out + count + k, sums[2] + sums[3] * sums[0]);
    }
}

/// us for `segments` samples, the quickest of some.
double limit(double segments) {
    const std::size_t count = 8 * static_cast<std::size_t>(segments / 8.0);
    std::vector<float> in(kRead * count, 0.3f), out(kWritten * count);
    double best = 1e9;
    for (int k = 0; k < 50; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        touch(in.data(), out.data(), count);
        benchmark::DoNotOptimize(out.data());
        benchmark::ClobberMemory();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        best = std::min(best, 1e6 * took.count());
    }
    return best;
}

/// A saddle of 1 m and 0.6 m, with 0.3 mm of stock, rough by 0.1 mm over some mm.
HeightField rough_saddle(double side) {
    const auto shape = [=](double u, double v) {
        const double x = u - 0.5 * side, y = v - 0.5 * side;
        return Vec3(u, v, x * x / 2000.0 - y * y / 1200.0);
    };
    const auto normal = [=](double u, double v) {
        return Vec3(-(u - 0.5 * side) / 1000.0, (v - 0.5 * side) / 600.0, 1.0).normalized();
    };
    HeightField field = testing::mapped_field(side, side, kSpacing, 0.3, shape, normal);
    for (std::size_t k = 0; k < field.size(); ++k) {
        const Vec3& p = field.point[k];
        field.height[k] += 0.05 * std::sin(1.7 * p.x()) * std::cos(1.1 * p.y()) +
                           0.05 * std::sin(0.6 * p.x() + 0.9 * p.y());
        field.stock_height[k] = static_cast<float>(field.height[k]);
    }
    return field;
}

void run_steps(benchmark::State& state, bool rough) {
    const double side = kSpacing * std::sqrt(static_cast<double>(state.range(0)));
    HeightField field = rough ? rough_saddle(side) : testing::plate(side, side, kSpacing, 0.3);
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
            Eigen::Translation3d(k == 0 ? 0.4 * side : 0.6 * side, 0.5 * side, 0.3) *
            Eigen::AngleAxisd(M_PI, Vec3::UnitX());
    }
    const ToolPath path(poses, {});
    SimulationResult result;
    {
        HeightField first = field;  // the rim is solved once, no part of a step
        simulate(first, path, elastic, law, options);
    }
    double steps = 0, localise = 0, gap = 0, contact = 0, removal = 0, segments = 0;
    double trace = 0, events = 0;
    for (auto _ : state) {
        result = simulate(field, path, elastic, law, options);
        steps += static_cast<double>(result.steps.size());
        localise += result.wall.localise;
        gap += result.wall.gap;
        contact += result.wall.contact;
        removal += result.wall.removal;
        trace += result.wall.trace;
        events += result.wall.events;
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
    state.counters["trace_us"] = 1e6 * trace / steps;
    state.counters["events_us"] = 1e6 * events / steps;
    state.counters["bytes"] =
        segments / steps * static_cast<double>(sizeof(SampleBlocks::Block) + sizeof(PlacedBlock)) /
        SampleBlocks::kLanes;
    const double least = limit(segments / steps);
    state.counters["limit_us"] = least;
    state.counters["of_limit"] = state.counters["step_us"] / least;
}

void step_cost(benchmark::State& state) {
    run_steps(state, false);
}
void step_rough(benchmark::State& state) {
    run_steps(state, true);
}
BENCHMARK(step_rough)
    ->ArgNames({"samples", "rim"})
    ->Args({1'000'000, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK(step_cost)
    ->ArgNames({"samples", "rim"})
    ->ArgsProduct({{250'000, 1'000'000, 4'000'000, 16'000'000}, {0, 1}})
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

/// To and fro over a plate of a million samples; neighbouring passes overlap.
ToolPath overlapping_passes(double side) {
    std::vector<PathPose> poses;
    for (int k = 0; k < 8; ++k) {
        PathPose pose;
        pose.base_from_tcp = Eigen::Translation3d((k / 2 + k) % 2 == 0 ? 20.0 : side - 20.0,
                                                  40.0 + 30.0 * (k / 2), 0.3) *
                             Eigen::AngleAxisd(M_PI, Vec3::UnitX());
        poses.push_back(pose);
    }
    return ToolPath(poses, {});
}

// What the finish adds to a run: processor time with and without, in turns.
void finish_cost(benchmark::State& state) {
    const double side = kSpacing * 1000.0;
    const HeightField before = testing::plate(side, side, kSpacing, 0.3);
    ElasticFoundation foundation(0.5);
    const LocalLaw law({1e-5});
    SimulationOptions options;
    options.process.wheel = {100.0, 50.0, 0.0};
    options.process.force = 100.0;
    options.finish.roughness = 0.8;
    options.finish.pressure_exponent = 0.4;
    options.finish.rest = 0.3;
    options.finish.before = 3.2;
    const ToolPath path = overlapping_passes(side);
    std::array<double, 2> seconds{};
    double bytes = 0.0;
    for (auto _ : state) {
        for (const bool wanted : {false, true}) {
            HeightField field = before;
            options.finish.wanted = wanted;
            const std::clock_t start = std::clock();
            benchmark::DoNotOptimize(simulate(field, path, foundation, law, options));
            seconds[wanted ? 1 : 0] += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
            bytes = static_cast<double>(field.finish.bytes()) / static_cast<double>(field.size());
        }
    }
    state.counters["ratio"] = seconds[1] / seconds[0];
    state.counters["bytes_a_sample"] = bytes;
}
BENCHMARK(finish_cost)->Unit(benchmark::kMillisecond)->Iterations(2);

// What heat adds to a run, with its nodes: processor time and wall time with and without, in turns.
// Of the former, milliseconds for what is done once.
void heat_cost(benchmark::State& state) {
    const double side = kSpacing * 1000.0;
    const HeightField before = testing::plate(side, side, kSpacing, 0.3);
    ElasticFoundation foundation(0.5);
    const LocalLaw law({1e-5});
    SimulationOptions options;
    options.process.wheel = {100.0, 50.0, 0.0};
    options.process.force = 100.0;
    const ToolPath path = overlapping_passes(side);
    const HeatMaterial steel{15.0, 500.0, 7900.0}, aluminium{191.0, 911.0, 2700.0};
    const std::array materials = {steel, aluminium};
    const auto now = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    const auto wall_now = [] {
        const auto since = std::chrono::steady_clock::now().time_since_epoch();
        return std::chrono::duration<double>(since).count();
    };
    std::array<double, 3> seconds{}, wall{};
    double once = 0.0, steps = 0.0;
    for (auto _ : state) {
        for (std::size_t k = 0; k < 3; ++k) {  // without, and with either material
            HeightField field = before;
            const double start = now(), wall_start = wall_now();
            std::optional<PartHeat> part;
            if (k > 0) {
                part.emplace(field, options.resolution.contact_spacing, materials[k - 1]);
                part->set_thickness(std::vector<float>(part->size(), 8.0f));
                state.counters["nodes"] = static_cast<double>(part->size());
                state.counters["bytes_a_sample"] =
                    static_cast<double>(part->bytes()) / static_cast<double>(field.size());
                once += now() - start;
            }
            options.heat = {part ? &*part : nullptr, 0.5, 0.7};
            const SimulationResult result = simulate(field, path, foundation, law, options);
            seconds[k] += now() - start;
            wall[k] += wall_now() - wall_start;
            if (k == 0) steps += static_cast<double>(result.steps.size());
        }
    }
    state.counters["ratio_steel"] = seconds[1] / seconds[0];
    state.counters["ratio_aluminium"] = seconds[2] / seconds[0];
    state.counters["step_us"] = 1e6 * seconds[0] / steps;
    state.counters["wall_ratio_steel"] = wall[1] / wall[0];
    state.counters["wall_ratio_aluminium"] = wall[2] / wall[0];
    state.counters["once_ms"] = 1e3 * once / (2.0 * static_cast<double>(state.iterations()));
}
BENCHMARK(heat_cost)->Unit(benchmark::kMillisecond)->Iterations(2);

}  // namespace
}  // namespace beltgrinding

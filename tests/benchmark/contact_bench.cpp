// The contact's solution by operator, on the wheel's grid: cold, and warm along a rippled surface
// at 50 N. Peer: a Fourier transform of the padded grid, there and back, as one apply needs.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "convolution.h"
#include "elastic/half_space.h"
#include "elastic/wheel_rim.h"

namespace beltgrinding {
namespace {

constexpr int kPoses = 60;
const Elasticity kRubber{5.0, 0.45};
enum Operator { kFoundation, kHalfSpace, kLayer, kRim };

std::unique_ptr<ElasticModel> make(int which, double width) {
    WheelRimDesign design;
    design.width = width;
    design.layers = {{15.0, kRubber}};
    switch (which) {
        case kFoundation:
            return std::make_unique<ElasticFoundation>(0.5);
        case kHalfSpace:
            return std::make_unique<HalfSpace>(kRubber);
        case kLayer:
            return std::make_unique<BondedLayer>(kRubber, 15.0);
        default:
            return std::make_unique<WheelRim>(design);
    }
}

/// A convex part with ripples that pass under the wheel.
ContactProblem pose(int n, double spacing, int index, double tolerance) {
    const ContactGrid grid{n, n, spacing, spacing};
    ContactProblem problem;
    problem.gap.resize(n * n);
    problem.coverage = Eigen::ArrayXd::Ones(n * n);
    problem.force = 50.0;
    problem.tolerance = tolerance;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double s = grid.s(i), y = grid.y(j);
            problem.gap[j * n + i] = s * s / 200.0 + y * y / 400.0 +
                                     0.02 * std::sin(0.9 * (s + 0.5 * index)) * std::cos(0.4 * y);
        }
    }
    return problem;
}

void run(benchmark::State& state, bool warm) {
    const int n = static_cast<int>(state.range(1));
    const double spacing = 32.0 / n, tolerance = 1.0 / static_cast<double>(state.range(2));
    const auto compliance =
        make(static_cast<int>(state.range(0)), n * spacing)->compliance({n, n, spacing, spacing});
    std::vector<ContactProblem> poses;
    for (int k = 0; k < kPoses; ++k) poses.push_back(pose(n, spacing, k, tolerance));
    int iterations = 0, solved = 0, failed = 0;
    ContactSolution last = compliance->solve(poses[0]);
    std::size_t k = 0;
    for (auto _ : state) {
        k = (k + 1) % kPoses;
        last = compliance->solve(poses[k], warm && k > 0 ? &last.pressure : nullptr);
        iterations += last.iterations;
        failed += !last.converged;
        ++solved;
    }
    double error = 0.0;  // of the pressure field, L1, against a far finer tolerance
    last = compliance->solve(poses[0]);
    for (std::size_t p = 1; p < kPoses; ++p) {
        last = compliance->solve(poses[p], warm ? &last.pressure : nullptr);
        ContactProblem exact = poses[p];
        exact.tolerance = 1e-6;
        const ContactSolution truth = compliance->solve(exact, &last.pressure);
        error += (truth.pressure - last.pressure).abs().sum() / truth.pressure.sum() / kPoses;
    }
    state.counters["error"] = error;
    state.counters["iterations"] = static_cast<double>(iterations) / solved;
    state.counters["failed"] = failed;
}
void contact_cold(benchmark::State& state) {
    run(state, false);
}
void contact_warm(benchmark::State& state) {
    run(state, true);
}

void arguments(benchmark::internal::Benchmark* b) {
    b->ArgNames({"operator", "cells", "1/tolerance"})->Unit(benchmark::kMicrosecond);
    for (const int which : {kFoundation, kHalfSpace, kLayer, kRim}) {
        for (const int n : {64, 128}) b->Args({which, n, 1000});
    }
    b->Args({kRim, 64, 10000});
}
BENCHMARK(contact_cold)->Apply(arguments);
BENCHMARK(contact_warm)->Apply(arguments);

void contact_apply(benchmark::State& state) {
    const int n = static_cast<int>(state.range(1));
    const auto compliance =
        make(static_cast<int>(state.range(0)), 32.0)->compliance({n, n, 32.0 / n, 32.0 / n});
    const ContactProblem problem = pose(n, 32.0 / n, 0, 1e-3);
    Eigen::ArrayXd u;
    for (auto _ : state) compliance->apply(problem.coverage, problem.coverage, u);
}
BENCHMARK(contact_apply)
    ->ArgNames({"operator", "cells"})
    ->ArgsProduct({{kHalfSpace, kLayer, kRim}, {64, 128}})
    ->Unit(benchmark::kMicrosecond);

/// As a step does whose contact has become longer or shorter: everything that is dear is kept.
void contact_prepare(benchmark::State& state) {
    const int n = static_cast<int>(state.range(1));
    const auto model = make(static_cast<int>(state.range(0)), 32.0);
    const auto prepare = [&](int k) {
        return model->compliance({n + 16 * (k % 2), n, 32.0 / n, 32.0 / n});
    };
    for (int k = 0; k < 2; ++k) prepare(k);  // the spectra
    std::unique_ptr<ComplianceOperator> compliance;
    int k = 0;
    for (auto _ : state) {
        compliance.reset();
        compliance = prepare(k++);
    }
}
BENCHMARK(contact_prepare)
    ->ArgNames({"operator", "cells"})
    ->ArgsProduct({{kHalfSpace, kLayer, kRim}, {64, 128}})
    ->Unit(benchmark::kMicrosecond);

void contact_peer_fft(benchmark::State& state) {
    const int n = static_cast<int>(state.range(0)), length = quick_fft_length(2 * n - 1);
    RowTransform transform(n, n, length);
    std::vector<float> values(static_cast<std::size_t>(n * n), 1.0F);
    std::vector<std::complex<float>> spectrum(
        static_cast<std::size_t>(transform.wavenumbers() * n));
    for (auto _ : state) {
        transform.forward(values.data(), spectrum.data());
        transform.backward(spectrum.data(), values.data());
        benchmark::DoNotOptimize(values.data());
    }
}
BENCHMARK(contact_peer_fft)->ArgName("cells")->Arg(64)->Arg(128)->Unit(benchmark::kMicrosecond);

void rim_set_up(benchmark::State& state) {
    const int n = static_cast<int>(state.range(0));
    for (auto _ : state) {
        const auto compliance = make(kRim, 0.5 * n);  // it has no cache
        benchmark::DoNotOptimize(compliance->compliance({n, n, 0.5, 0.5}));
    }
}
BENCHMARK(rim_set_up)->ArgName("cells")->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beltgrinding

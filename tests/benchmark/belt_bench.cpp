// The contact of a free belt and of a platen on 64 x 64 cells: cold, and warm along a rippled
// surface. `belt_models` prints the free belt beside the plain ways, a string (pure membrane) and
// strips that do not know of each other, on parts of several forms.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/belt/belt_case.h"

namespace beltgrinding {
namespace {

using namespace testing;

constexpr int kPoses = 40;
const ContactGrid kGrid{64, 64, 0.8, 0.8};

enum Part { kCylinder, kBarrel, kSphere, kAlong, kParts };

double depth_of(int part, double x, double y) {
    switch (part) {
        case kCylinder:
            return circle(40.0, x);
        case kBarrel: {
            const double ring = 40.0 - circle(100.0, y);
            return 40.0 - std::sqrt(std::max(ring * ring - x * x, 0.0));
        }
        case kSphere:
            return circle(40.0, std::hypot(x, y));
        default: {
            const double end = std::abs(x) - 20.0;
            return circle(50.0, y) + (end > 0.0 ? circle(40.0, end) : 0.0);
        }
    }
}

ContactProblem pose(int part, int index, double force) {
    ContactProblem problem = problem_of(kGrid, [&](double x, double y) {
        return depth_of(part, x, y) + 0.005 * std::sin(0.9 * (x + 0.3 * index)) * std::cos(0.4 * y);
    });
    problem.tolerance = 1e-3;
    problem.force = force;
    return problem;
}

BeltMachine machine_of(bool platen) {
    return reference_belt(platen ? BeltMachine::Kind::kPlaten : BeltMachine::Kind::kFreeBelt,
                          BeltRun::Rollers::kFixed);
}

void belt_contact(benchmark::State& state) {
    const int part = static_cast<int>(state.range(0));
    const bool platen = state.range(1) != 0, warm = state.range(2) != 0;
    const auto contact = make_belt_contact(machine_of(platen))->prepare(kGrid);
    std::vector<ContactProblem> poses;
    for (int k = 0; k < kPoses; ++k) poses.push_back(pose(part, k, 20.0));
    ContactSolution last = contact->solve(poses[0]);
    int iterations = 0, solved = 0, failed = 0;
    std::size_t k = 0;
    for (auto _ : state) {
        k = (k + 1) % kPoses;
        last = contact->solve(poses[k], warm && k > 0 ? &last.pressure : nullptr);
        iterations += last.iterations;
        failed += last.converged ? 0 : 1;
        ++solved;
    }
    state.counters["iterations"] = static_cast<double>(iterations) / solved;
    state.counters["failed"] = failed;
}
BENCHMARK(belt_contact)
    ->ArgNames({"part", "platen", "warm"})
    ->ArgsProduct({{kCylinder, kBarrel, kSphere, kAlong}, {0}, {0, 1}})
    ->Args({kAlong, 1, 0})
    ->Args({kAlong, 1, 1})
    ->Unit(benchmark::kMillisecond);

/// N of a string of the belt's width over each row by itself, at a depth: no bending at all.
double strings(const BeltMachine& machine, int part, double approach) {
    const double half = 0.5 * machine.run.length;
    const double unloaded =
        machine.run.length / (1.0 + machine.belt.tension / machine.belt.membrane());
    double sum = 0.0;
    for (int j = 0; j < kGrid.ny; ++j) {
        const double y = kGrid.y(j);
        if (std::abs(y) > 0.5 * machine.belt.width) continue;
        double steepest = 0.0;  // of the run from the roller: a tangent of the row's profile
        for (int i = -800; i <= 800; ++i) {
            const double x = 0.05 * i, z = approach - depth_of(part, x, y);
            if (std::isfinite(z)) steepest = std::max(steepest, z / (half - std::abs(x)));
        }
        const double angle = std::atan(steepest);
        const double length = machine.run.length / std::cos(angle);
        const double pull = machine.belt.membrane() * (length / unloaded - 1.0);
        sum += 2.0 * pull * std::sin(angle) * kGrid.dy;
    }
    return sum;
}

/// N of strips, each a belt of its own: bending along the belt alone.
double strips(const BeltMachine& machine, int part, double approach) {
    constexpr int kRows = 4;
    const ContactGrid narrow{64, kRows, 0.8, 0.2};
    BeltMachine strip = machine;
    strip.belt.width = kRows * narrow.dy;
    double sum = 0.0;
    const auto contact = make_belt_contact(strip)->prepare(narrow);
    for (int j = 0; j < kGrid.ny; ++j) {
        if (std::abs(kGrid.y(j)) > 0.5 * machine.belt.width) continue;
        const ContactProblem problem = at_depth(
            narrow, approach, [&](double x, double) { return depth_of(part, x, kGrid.y(j)); });
        sum += contact->solve(problem).force * kGrid.dy / strip.belt.width;
    }
    return sum;
}

void belt_models(benchmark::State& state) {
    const BeltMachine machine = machine_of(false);
    const auto contact = make_belt_contact(machine)->prepare(kGrid);
    const char* const names[] = {"cylinder 40 across", "barrel 40/100", "sphere 40",
                                 "cylinder 50 along"};
    for (auto _ : state) {
        for (int part = 0; part < kParts; ++part) {
            for (const double approach : {3.0, 5.0}) {
                const double plate =
                    contact
                        ->solve(at_depth(kGrid, approach,
                                         [&](double x, double y) { return depth_of(part, x, y); }))
                        .force;
                std::printf("%-20s %4.1f mm: plate %7.3f N, string %7.3f N, strips %7.3f N\n",
                            names[part], approach, plate, strings(machine, part, approach),
                            strips(machine, part, approach));
            }
        }
    }
}
BENCHMARK(belt_models)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beltgrinding

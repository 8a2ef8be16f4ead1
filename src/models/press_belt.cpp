#include "models/press_belt.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stopwatch.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr int kAlong = 64, kAcross = 32;  // cells
constexpr int kFewest = 12;    // of them along the contact, else the grid is made shorter
constexpr double kRoom = 2.5;  // of the contact's length: the grid's
constexpr int kRounds = 4;
constexpr double kTouched = 0.01;  // of the peak pressure

/// mm by which a circle of that curvature has gone down at `t` mm; +inf beside it.
double sag(double curvature, double t) {
    if (curvature == 0.0) return 0.0;
    const double sine = curvature * t;
    if (std::abs(sine) >= 1.0)
        return curvature > 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / curvature;
    return (1.0 - std::sqrt(1.0 - sine * sine)) / curvature;
}

/// mm along the belt, from the origin, that the contact takes to the farther side; 0: none.
double half_length(const ContactGrid& grid, const Eigen::ArrayXd& pressure) {
    const double least = kTouched * pressure.maxCoeff();
    double farthest = 0.0;
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i)
            if (pressure[j * grid.nx + i] > least)
                farthest = std::max(farthest, std::abs(grid.s(i)) + 0.5 * grid.ds);
    return farthest;
}

}  // namespace

SingleContactResult press(const PressedBelt& pressed) {
    pressed.machine.validate();
    for (const double value : {pressed.first, pressed.second, pressed.angle}) {
        if (!std::isfinite(value))
            throw InputError("contact.belt_curvature", "contact: a curvature is no number");
    }
    const auto model = make_belt_contact(pressed.machine);
    const BeltRun& run = pressed.machine.run;
    const double longest = 0.5 * run.length - std::abs(run.position);
    const double c = std::cos(pressed.angle), s = std::sin(pressed.angle);
    SingleContactResult result;
    double half = longest;
    for (int round = 0; round < kRounds; ++round) {
        ContactGrid grid;
        grid.nx = kAlong;
        grid.ny = kAcross;
        grid.ds = 2.0 * half / grid.nx;
        grid.dy = pressed.machine.belt.width / grid.ny;
        ContactProblem problem;
        problem.gap.resize(grid.cells());
        for (int j = 0; j < grid.ny; ++j)
            for (int i = 0; i < grid.nx; ++i) {
                const double x = grid.s(i), y = grid.y(j);
                problem.gap[j * grid.nx + i] =
                    sag(pressed.first, c * x + s * y) + sag(pressed.second, c * y - s * x);
            }
        problem.coverage = problem.gap.isFinite().cast<double>();
        problem.force_control = pressed.force_control;
        problem.force = pressed.force;
        problem.approach = pressed.approach;
        problem.tolerance = pressed.tolerance;
        const auto prepared = model->prepare(grid);
        result.grid = grid;
        result.model = prepared->describe();
        {
            const Stopwatch watch(result.time);
            result.solution = prepared->solve(problem, nullptr);
        }
        result.gap = problem.gap;
        result.coverage = problem.coverage;
        const double reach = half_length(grid, result.solution.pressure);
        const double wanted = std::max(kRoom * reach, grid.ds);
        if (!(reach > 0.0) || 2.0 * reach >= kFewest * grid.ds || wanted >= half) break;
        half = wanted;
    }
    return result;
}

}  // namespace beltgrinding

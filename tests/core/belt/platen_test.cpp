// A belt over a platen with a soft layer, against three-dimensional finite elements.
#include "belt/platen.h"

#include <gtest/gtest.h>

#include "belt_case.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

using namespace testing;

const ContactGrid kGrid{64, 50, 1.0, 1.0};

BeltMachine platen() {
    return reference_belt(BeltMachine::Kind::kPlaten, BeltRun::Rollers::kFixed);
}

/// A straight crest along the travel, 40 mm long, with rounded ends.
double crest(double x, double y) {
    const double end = std::abs(x) - 20.0;
    return circle(50.0, y) + (end > 0.0 ? circle(40.0, end) : 0.0);
}

ContactProblem with_tolerance(ContactProblem problem) {
    problem.tolerance = 1e-3;
    return problem;
}

struct Case {
    const char* file;
    double depth;  // mm
};

class PlatenReference : public ::testing::TestWithParam<Case> {};

TEST_P(PlatenReference, IsThatOfFiniteElements) {
    const auto path = reference_file(GetParam().file);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data: " << path;
    const BeltReference truth = read_reference(path);
    const ContactSolution solution = make_belt_contact(platen())->prepare(kGrid)->solve(
        with_tolerance(at_depth(kGrid, GetParam().depth, crest)));
    EXPECT_TRUE(solution.converged);
    EXPECT_NEAR(solution.force, truth.force, 0.03 * truth.force);
    const BeltRows rows = rows_of(kGrid, solution, 1.0);
    EXPECT_NEAR(rows.x_max, truth.x_max, 0.7);
    EXPECT_NEAR(rows.y_max, truth.y_max, 0.7);
    expect_rows(in_pairs(rows.by_x), in_pairs(truth.by_x), 0.1);
    expect_rows(in_pairs(rows.by_y), in_pairs(truth.by_y), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Crest, PlatenReference,
                         ::testing::Values(Case{"fem_platenD_d0.2_F49.8.csv", 0.2},
                                           Case{"fem_platenD_d0.33_F99.1.csv", 0.33}),
                         [](const auto& one) {
                             return "At" + std::to_string(static_cast<int>(
                                               std::lround(100.0 * one.param.depth)));
                         });

TEST(Platen, ForceAndPositionControlAreOneContact) {
    const auto contact = make_belt_contact(platen())->prepare(kGrid);
    const ContactSolution pressed = contact->solve(with_tolerance(at_depth(kGrid, 0.25, crest)));
    ContactProblem problem = with_tolerance(problem_of(kGrid, crest));
    problem.force = pressed.force;
    const ContactSolution solution = contact->solve(problem);
    EXPECT_TRUE(solution.converged);
    EXPECT_NEAR(solution.force, pressed.force, 1e-4 * pressed.force);
    EXPECT_NEAR(solution.approach, 0.25, 0.002);
}

TEST(Platen, AStartDoesNotMatter) {
    const auto contact = make_belt_contact(platen())->prepare(kGrid);
    ContactProblem problem = with_tolerance(problem_of(kGrid, crest));
    problem.force = 60.0;
    const ContactSolution cold = contact->solve(problem);
    problem.gap += 0.1;
    const ContactSolution warm = contact->solve(problem, &cold.pressure);
    EXPECT_LT(warm.iterations, cold.iterations);
    EXPECT_NEAR(warm.approach, cold.approach + 0.1, 1e-3);
    EXPECT_LT((warm.pressure - cold.pressure).abs().sum(), 0.02 * cold.pressure.sum());
}

TEST(Platen, OnAPlaneTheLayersDecide) {
    // An even gap over the whole belt: but for its sides and its ends, the layer is compressed
    // evenly, by E (1 - nu) / ((1 + nu) (1 - 2 nu)) / h in series with both faces.
    BeltMachine machine = platen();
    machine.platen.layers = {{2.0, 4.0, 0.3}};
    const ContactGrid grid{40, 50, 1.0, 1.0};
    const auto plane = [](double, double) { return 0.0; };
    const ContactSolution solution = make_belt_contact(machine)->prepare(grid)->solve(
        with_tolerance(at_depth(grid, 0.1, plane)));
    const double layer = 4.0 * 0.7 / (1.3 * 0.4) / 2.0;
    const double pressure = 0.1 / (1.0 / layer + 1.0 / 200.0 + 1.0 / 100.0);
    EXPECT_NEAR(solution.pressure[25 * grid.nx + 20], pressure, 0.02 * pressure);
}

TEST(Platen, APlateWithoutLayersIsAsStiffAsBothFaces) {
    BeltMachine machine = platen();
    machine.platen.layers.clear();
    const ContactGrid grid{40, 50, 1.0, 1.0};
    const auto plane = [](double, double) { return 0.0; };
    const ContactSolution solution = make_belt_contact(machine)->prepare(grid)->solve(
        with_tolerance(at_depth(grid, 0.01, plane)));
    EXPECT_NEAR(solution.pressure[25 * grid.nx + 20], 0.01 / (1.0 / 200.0 + 1.0 / 100.0), 0.01);
}

TEST(Platen, NamesWhatIsNone) {
    BeltMachine machine = platen();
    machine.platen.length = 0.0;
    EXPECT_THROW(make_belt_contact(machine), InputError);
    machine = platen();
    machine.platen.layers[0].thickness = -1.0;
    EXPECT_THROW(make_belt_contact(machine), InputError);
    machine = platen();
    machine.platen.layer_surface_stiffness = -1.0;
    EXPECT_THROW(make_belt_contact(machine), InputError);
}

}  // namespace
}  // namespace beltgrinding

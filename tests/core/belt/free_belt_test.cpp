// A free belt pressed on parts: against three-dimensional finite elements, and what must hold
// whatever the part is.
#include "belt/free_belt.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <tuple>

#include "belt_case.h"
#include "belt_path.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

using namespace testing;
using Rollers = BeltRun::Rollers;

const ContactGrid kGrid{64, 50, 1.0, 1.0};

ContactSolution press(const BeltMachine& machine, const ContactGrid& grid,
                      const ContactProblem& problem) {
    return make_belt_contact(machine)->prepare(grid)->solve(problem);
}

BeltMachine free_belt(Rollers rollers) {
    return reference_belt(BeltMachine::Kind::kFreeBelt, rollers);
}

double sphere(double x, double y) {
    return circle(40.0, std::hypot(x, y));
}

struct Case {
    const char* file;
    Rollers rollers;
    double depth;  // mm
};

class FreeBeltReference : public ::testing::TestWithParam<Case> {};

TEST_P(FreeBeltReference, IsThatOfFiniteElements) {
    const auto path = reference_file(GetParam().file);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data: " << path;
    const BeltReference truth = read_reference(path);
    const auto across = [](double x, double) { return circle(40.0, x); };
    const ContactSolution solution =
        press(free_belt(GetParam().rollers), kGrid, at_depth(kGrid, GetParam().depth, across));
    EXPECT_TRUE(solution.converged);
    EXPECT_NEAR(solution.force, truth.force, 0.01 * truth.force);
    const BeltRows rows = rows_of(kGrid, solution, 1.0);
    EXPECT_NEAR(rows.x_max, truth.x_max, 0.7);
    EXPECT_NEAR(rows.y_max, truth.y_max, 0.7);
    expect_rows(in_pairs(rows.by_x), in_pairs(truth.by_x), 0.06);
    expect_rows(in_pairs(rows.by_y), in_pairs(truth.by_y), 0.1);
    // The row in which a wrap ends as well, by its own force.
    const std::vector<double> ours = in_pairs(rows.by_x), theirs = in_pairs(truth.by_x);
    ASSERT_EQ(ours.size(), theirs.size());
    EXPECT_NEAR(ours.back(), theirs.back(), 0.06 * theirs.back());
}

INSTANTIATE_TEST_SUITE_P(
    Cylinder, FreeBeltReference,
    ::testing::Values(Case{"fem_beltA_d5_F22.5.csv", Rollers::kFixed, 5.0},
                      Case{"fem_beltA_d10_F57.3.csv", Rollers::kFixed, 10.0},
                      Case{"fem_beltA_constT_d5_F20.6.csv", Rollers::kTensioned, 5.0},
                      Case{"fem_beltA_constT_d10_F41.4.csv", Rollers::kTensioned, 10.0},
                      Case{"fem_beltA_constT_d20_F85.8.csv", Rollers::kTensioned, 20.0}),
    [](const auto& one) {
        return std::string(one.param.rollers == Rollers::kFixed ? "Fixed" : "Tensioned") +
               std::to_string(static_cast<int>(one.param.depth));
    });

/// Curvatures along the belt and across it, 1/mm; positive: convex.
struct Bends {
    const char* name;
    double along, across;
};

class FreeBeltOn : public ::testing::TestWithParam<std::tuple<Bends, Rollers>> {
  protected:
    /// A belt of 0.8 mm, 2 N/mm, deep on the part: it is strained by up to some per cent.
    static ContactProblem problem() {
        const Bends& bends = std::get<0>(GetParam());
        ContactProblem problem = problem_of(
            kGrid, [&](double x, double y) { return arc(bends.along, x) + arc(bends.across, y); });
        problem.gap -= problem.gap.minCoeff();
        problem.tolerance = 1e-3;
        return problem;
    }
    static std::unique_ptr<PreparedContact> contact() {
        BeltMachine machine = free_belt(std::get<1>(GetParam()));
        machine.belt.thickness = 0.8;
        machine.belt.tension = 2.0;
        return make_belt_contact(machine)->prepare(kGrid);
    }
    static void expect_least_energy(const ContactProblem& problem) {
        const auto belt = contact();
        const ContactSolution solution = belt->solve(problem);
        EXPECT_TRUE(solution.converged);
        EXPECT_LE(solution.iterations, 45);
        // What the tolerance says is what is left, however it is begun.
        ContactProblem exact = problem;
        exact.tolerance = 1e-7;
        exact.max_iterations = 200;
        const ContactSolution truth = contact()->solve(exact);
        ASSERT_TRUE(truth.converged);
        EXPECT_NEAR(solution.force, truth.force, 1e-3 * truth.force);
        EXPECT_LT((solution.pressure - truth.pressure).abs().sum(), 3e-3 * truth.pressure.sum());
        ContactProblem before = problem;
        before.force *= 0.9;
        before.approach *= 0.97;
        const ContactSolution other = belt->solve(before);
        const ContactSolution warm = belt->solve(problem, &other.pressure);
        EXPECT_TRUE(warm.converged);
        // But for the path, which may be that of a depth 0.4 mm off.
        EXPECT_NEAR(warm.approach, truth.approach, 5e-3 * truth.approach);
        EXPECT_LT((warm.pressure - truth.pressure).abs().sum(), 0.06 * truth.pressure.sum());
    }
};

TEST_P(FreeBeltOn, IsSolvedUnderAForce) {
    ContactProblem problem = FreeBeltOn::problem();
    problem.force = 60.0;
    expect_least_energy(problem);
}

TEST_P(FreeBeltOn, IsSolvedAtADepth) {
    ContactProblem problem = FreeBeltOn::problem();
    problem.force_control = false;
    problem.approach = 15.0;
    expect_least_energy(problem);
}

INSTANTIATE_TEST_SUITE_P(
    Parts, FreeBeltOn,
    ::testing::Combine(::testing::Values(Bends{"Cylinder", 1.0 / 20.0, 0.0},
                                         Bends{"Blade", 1.0 / 300.0, 1.0 / 60.0},
                                         Bends{"Sphere", 1.0 / 20.0, 1.0 / 20.0},
                                         Bends{"Spout", 1.0 / 20.0, -1.0 / 300.0},
                                         Bends{"Saddle", 1.0 / 40.0, -1.0 / 40.0},
                                         Bends{"SteepSaddle", 1.0 / 20.0, -1.0 / 27.0}),
                       ::testing::Values(Rollers::kFixed, Rollers::kTensioned)),
    [](const auto& one) {
        return std::string(std::get<0>(one.param).name) +
               (std::get<1>(one.param) == Rollers::kFixed ? "Fixed" : "Tensioned");
    });

TEST(FreeBelt, PressesWhereAPartTouchesBesideItsRidge) {
    // Beside a string over the part's highest points, turned curvatures touch first.
    BeltMachine machine = free_belt(Rollers::kTensioned);
    machine.belt.width = 11.0;
    machine.belt.tension = 0.5;
    machine.run.length = 96.0;
    const ContactGrid grid{64, 9, 1.3, 1.3};
    const double c = std::cos(0.86), s = std::sin(0.86);
    ContactProblem problem = problem_of(grid, [&](double x, double y) {
        return arc(1.0 / 39.0, c * x + s * y) + arc(-1.0 / 24.0, c * y - s * x);
    });
    problem.gap -= problem.gap.minCoeff();
    problem.force = 0.061;
    const ContactSolution solution = press(machine, grid, problem);
    EXPECT_TRUE(solution.converged);
    EXPECT_NEAR(solution.force, problem.force, 1e-3 * problem.force);
}

TEST(FreeBelt, PressesInTheMiddleOfALongWrapByItsPullAndTheCurvature) {
    BeltMachine machine = free_belt(Rollers::kTensioned);
    machine.belt.thickness = 0.6;
    const double radius = 150.0, depth = 10.0;
    const auto round = [&](double x, double) { return circle(radius, x); };
    const ContactSolution solution = press(machine, kGrid, at_depth(kGrid, depth, round));
    double sum = 0.0;  // over the middle of the wrap, away from its ends and the belt's sides
    int cells = 0;
    for (int j = 15; j < 35; ++j)
        for (int i = 29; i < 35; ++i, ++cells) sum += solution.pressure[j * kGrid.nx + i];
    const double theory = machine.belt.tension / (radius + 0.5 * machine.belt.thickness);
    EXPECT_NEAR(sum / cells, theory, 0.01 * theory);
    // F / W = 2 H tan(alpha), alpha by the tangent from the roller to the circle that the belt's
    // middle surface lies on. The rollers come closer by what the wrap takes.
    const double r = radius + 0.5 * machine.belt.thickness;
    double alpha = 0.0;
    for (double low = 0.0, high = 1.0; high - low > 1e-9;) {
        alpha = 0.5 * (low + high);
        const double straight = 0.5 * machine.run.length - r * alpha;
        const double height = r * std::cos(alpha) - r + depth - straight * std::sin(alpha);
        (height > 0.0 ? low : high) = alpha;
    }
    const double force = 2.0 * machine.belt.tension * machine.belt.width * std::tan(alpha);
    EXPECT_NEAR(solution.force, force, 0.01 * force);
}

TEST(FreeBelt, InAFullWrapPressesByItsTensionOverTheRadius) {
    // 40 degrees on either side: far from a small slope.
    const BeltMachine machine = free_belt(Rollers::kTensioned);
    const auto round = [](double x, double) { return circle(20.0, x); };
    const ContactSolution solution = press(machine, kGrid, at_depth(kGrid, 60.0, round));
    // Both runs pull with H / cos(alpha), and F = 2 W H tan(alpha).
    const double tangent = solution.force / (2.0 * machine.belt.width * machine.belt.tension);
    EXPECT_GT(std::atan(tangent), 0.65);
    const double tension = machine.belt.tension * std::sqrt(1.0 + tangent * tangent);
    double sum = 0.0;
    int cells = 0;
    for (int j = 15; j < 35; ++j)
        for (int i = 29; i < 35; ++i, ++cells) sum += solution.pressure[j * kGrid.nx + i];
    EXPECT_NEAR(sum / cells, tension / 20.0, 0.01 * tension / 20.0);
}

TEST(FreeBelt, ForceAndPositionControlAreOneContact) {
    for (const Rollers rollers : {Rollers::kFixed, Rollers::kTensioned}) {
        const auto contact = make_belt_contact(free_belt(rollers))->prepare(kGrid);
        const ContactSolution pressed = contact->solve(at_depth(kGrid, 4.0, sphere));
        ContactProblem problem = problem_of(kGrid, sphere);
        problem.force = pressed.force;
        const ContactSolution solution = contact->solve(problem);
        EXPECT_TRUE(solution.converged);
        EXPECT_NEAR(solution.force, pressed.force, 1e-4 * pressed.force);
        EXPECT_NEAR(solution.approach, 4.0, 0.004);
        EXPECT_LT((solution.pressure - pressed.pressure).abs().sum(),
                  0.02 * pressed.pressure.sum());
    }
}

TEST(FreeBelt, IsStiffenedByWhatADoublyCurvedPartStretches) {
    // The middle of the belt is longer than its sides, and pulls more. Values by an independent
    // prototype, a plate of finite differences with displacements in its plane: 8.12 N, 15.61 N.
    const BeltMachine machine = free_belt(Rollers::kFixed);
    EXPECT_NEAR(press(machine, kGrid, at_depth(kGrid, 3.0, sphere)).force, 8.12, 0.1);
    EXPECT_NEAR(press(machine, kGrid, at_depth(kGrid, 5.0, sphere)).force, 15.61, 0.15);
}

TEST(FreeBelt, IsTheSameMirrored) {
    const BeltMachine machine = free_belt(Rollers::kFixed);
    const auto bump = [](double x, double y) { return circle(60.0, std::hypot(x - 4.5, y - 8.5)); };
    const auto mirrored = [&](double x, double y) { return bump(-x, -y); };
    const ContactSolution a = press(machine, kGrid, at_depth(kGrid, 4.0, bump));
    const ContactSolution b = press(machine, kGrid, at_depth(kGrid, 4.0, mirrored));
    EXPECT_NEAR(a.force, b.force, 1e-3 * a.force);
    EXPECT_LT((a.pressure - b.pressure.reverse()).abs().sum(), 0.01 * a.pressure.sum());
}

TEST(FreeBelt, BearsNoTensionAndOnlyWhereTheWorkIs) {
    const BeltMachine machine = free_belt(Rollers::kFixed);
    const auto half = [](double x, double y) { return y < 0.0 ? circle(40.0, x) : kBeside; };
    const auto saddle = [](double x, double y) {
        return circle(40.0, x) - circle(100.0, y) + circle(100.0, 25.0);
    };
    const ContactSolution edge = press(machine, kGrid, at_depth(kGrid, 5.0, half));
    EXPECT_GE(edge.pressure.minCoeff(), 0.0);
    EXPECT_GT(edge.force, 0.0);
    double beside = 0.0, last = 0.0, inside = 0.0;
    for (int j = 0; j < kGrid.ny; ++j) {
        for (int i = 0; i < kGrid.nx; ++i) {
            const double p = edge.pressure[j * kGrid.nx + i];
            if (kGrid.y(j) > 0.0) beside += p;
            if (j == 24) last += p;
            if (j == 12) inside += p;
        }
    }
    EXPECT_EQ(beside, 0.0);
    EXPECT_GT(last, 2.0 * inside);  // the belt bends over the part's edge
    // On a saddle the sides touch first, and bear more than the middle.
    const ContactSolution solution = press(machine, kGrid, at_depth(kGrid, 5.0, saddle));
    const BeltRows rows = rows_of(kGrid, solution, 1.0);
    EXPECT_NEAR(rows.y_max, 25.0, 1.01);
    EXPECT_GT(rows.by_y[24] + rows.by_y[23], 4.0 * (rows.by_y[0] + rows.by_y[1]));
}

TEST(FreeBelt, DoesNotReachBeyondItsWidth) {
    BeltMachine machine = free_belt(Rollers::kFixed);
    machine.belt.width = 30.5;
    const auto across = [](double x, double) { return circle(40.0, x); };
    const ContactGrid wide{64, 64, 1.0, 1.0};
    const ContactSolution solution = press(machine, wide, at_depth(wide, 10.0, across));
    for (int j = 0; j < wide.ny; ++j) {
        if (std::abs(wide.y(j)) < 15.75) continue;
        for (int i = 0; i < wide.nx; ++i) EXPECT_EQ(solution.pressure[j * wide.nx + i], 0.0);
    }
    // Narrower, but by a millimetre of width as the wide one.
    EXPECT_NEAR(solution.force / 30.5, 57.0 / 50.0, 0.02);
}

TEST(FreeBelt, AFinerGridGivesTheSame) {
    const BeltMachine machine = free_belt(Rollers::kFixed);
    const ContactGrid fine{80, 100, 0.5, 0.5};
    const ContactSolution a = press(machine, kGrid, at_depth(kGrid, 4.0, sphere));
    const ContactSolution b = press(machine, fine, at_depth(fine, 4.0, sphere));
    EXPECT_NEAR(a.force, b.force, 0.01 * b.force);
}

TEST(FreeBelt, AStartAndThreadsDoNotMatter) {
    const auto model = make_belt_contact(free_belt(Rollers::kFixed));
    const auto contact = model->prepare(kGrid);
    ContactProblem problem = problem_of(kGrid, sphere);
    problem.force = 12.0;
    const ContactSolution cold = contact->solve(problem);
    ContactProblem moved = problem;
    moved.gap += 0.3;
    const ContactSolution warm = contact->solve(moved, &cold.pressure);
    EXPECT_LT(warm.iterations, cold.iterations);
    EXPECT_NEAR(warm.approach, cold.approach + 0.3, 2e-3);
    EXPECT_LT((warm.pressure - cold.pressure).abs().sum(), 0.01 * cold.pressure.sum());
    std::vector<ContactSolution> all(3);
    std::vector<std::thread> threads;
    for (ContactSolution& one : all)
        threads.emplace_back([&] { one = model->prepare(kGrid)->solve(problem); });
    for (std::thread& thread : threads) thread.join();
    for (const ContactSolution& one : all) EXPECT_TRUE((one.pressure == cold.pressure).all());
}

TEST(FreeBelt, ASurfaceThatRecedesIsPressedAsBySofterGrains) {
    const double recession = 0.002;  // mm/MPa
    BeltMachine machine = free_belt(Rollers::kTensioned);
    ContactProblem problem = problem_of(kGrid, sphere);
    problem.force = 15.0;
    problem.recession = recession;
    const ContactSolution receding = press(machine, kGrid, problem);
    machine.belt.surface_stiffness = 1.0 / (1.0 / machine.belt.surface_stiffness + recession);
    problem.recession = 0.0;
    const ContactSolution soft = press(machine, kGrid, problem);
    EXPECT_TRUE(receding.converged);
    EXPECT_NEAR(receding.approach, soft.approach, 1e-6);
    EXPECT_LT((receding.pressure - soft.pressure).abs().sum(), 1e-6 * soft.pressure.sum());
}

TEST(FreeBelt, ARobotThatGivesWayStandsBackByItsForce) {
    for (const Rollers rollers : {Rollers::kFixed, Rollers::kTensioned}) {
        ContactProblem problem = at_depth(kGrid, 6.0, sphere);
        problem.robot_compliance = 0.2;  // mm/N
        const ContactSolution held = press(free_belt(rollers), kGrid, problem);
        EXPECT_TRUE(held.converged);
        EXPECT_GT(held.force, 1.0);
        EXPECT_NEAR(held.approach, 6.0 - 0.2 * held.force, 1e-3 * 6.0);
        const ContactSolution rigid =
            press(free_belt(rollers), kGrid, at_depth(kGrid, held.approach, sphere));
        EXPECT_NEAR(held.force, rigid.force, 1e-3 * rigid.force);
    }
}

TEST(FreeBelt, GoesOnFromWhatAnotherOneRemembers) {
    const auto model = make_belt_contact(free_belt(Rollers::kFixed));
    ContactProblem problem = problem_of(kGrid, sphere);
    problem.force = 12.0;
    const auto first = model->prepare(kGrid), second = model->prepare(kGrid);
    const ContactSolution begun = first->solve(problem);
    second->remember(first->memory());
    EXPECT_GT(first->memory()->bytes(), sizeof(double) * kGrid.cells());
    problem.gap += 0.1;
    const ContactSolution a = first->solve(problem, &begun.pressure);
    const ContactSolution b = second->solve(problem, &begun.pressure);
    EXPECT_EQ(a.approach, b.approach);
    EXPECT_TRUE((a.pressure == b.pressure).all());
}

TEST(FreeBelt, WithoutWorkOrForceThereIsNoContact) {
    const auto contact = make_belt_contact(free_belt(Rollers::kFixed))->prepare(kGrid);
    ContactProblem problem = problem_of(kGrid, [](double, double) { return kBeside; });
    problem.force = 10.0;
    const ContactSolution none = contact->solve(problem);
    EXPECT_EQ(none.force, 0.0);
    EXPECT_FALSE(none.converged);
    const ContactSolution apart = contact->solve(at_depth(kGrid, -1.0, sphere));
    EXPECT_EQ(apart.force, 0.0);
    EXPECT_TRUE(apart.converged);
}

// A belt that soft would be pressed in by metres, on columns without number.
TEST(FreeBelt, AForceThatItsFaceCannotBearIsNoContact) {
    BeltMachine machine = free_belt(Rollers::kFixed);
    machine.belt.tension = 3.5e-5;
    machine.belt.surface_stiffness = 2e-5;
    const auto contact = make_belt_contact(machine)->prepare(kGrid);
    ContactProblem problem = problem_of(kGrid, sphere);
    problem.force = 200.0;
    const ContactSolution none = contact->solve(problem);
    EXPECT_EQ(none.force, 0.0);
    EXPECT_FALSE(none.converged);
    EXPECT_LT(none.iterations, 500);
    problem.force = 1e-3;
    EXPECT_NEAR(contact->solve(problem).force, 1e-3, 1e-5);
}

// A belt of some millimetres has a face that begins beyond its roller where it leaves that steeply.
TEST(FreeBelt, ColumnsHaveAWidthWhereverTheWorkTouches) {
    for (const double half : {0.35, 3.4, 10.0}) {
        for (int k = -49; k <= 49; ++k) {
            for (const double deep : {0.1, 5.0, 60.0}) {
                for (const auto rollers : {Rollers::kFixed, Rollers::kTensioned}) {
                    BeltRun run = free_belt(rollers).run;
                    run.length = 100.0;
                    BeltPathRequest request;
                    for (int i = -3; i <= 3; ++i)
                        request.obstacle.push_back({k + 0.3 * i, deep - 0.05 * i * i, k + 0.8 * i});
                    request.half = half;
                    request.cell = 1.5;
                    request.cells = 80;
                    request.bending = 3.0 * half;
                    request.margin = 8.0 + 2.0 * request.bending;
                    const BeltPath path = belt_path(run, request);
                    double length = 0.0;
                    for (const double width : path.columns.width) {
                        EXPECT_GT(width, 1e-6) << half << ' ' << k << ' ' << deep;
                        length += width;
                    }
                    EXPECT_NEAR(length, path.length, 1e-9);
                }
            }
        }
    }
}

TEST(FreeBelt, NamesWhatIsNone) {
    const auto refused = [](auto change, const char* culprit) {
        BeltMachine machine = free_belt(Rollers::kFixed);
        change(machine);
        try {
            make_belt_contact(machine);
            ADD_FAILURE() << "accepted: " << culprit;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(culprit), std::string::npos) << error.what();
        }
    };
    refused([](BeltMachine& m) { m.belt.width = 0.0; }, "width");
    refused([](BeltMachine& m) { m.belt.thickness = -1.0; }, "thickness");
    refused([](BeltMachine& m) { m.belt.youngs_modulus = kBeside; }, "Young");
    refused([](BeltMachine& m) { m.belt.poissons_ratio = 0.5; }, "Poisson");
    refused([](BeltMachine& m) { m.belt.tension = 0.0; }, "tension");
    refused([](BeltMachine& m) { m.belt.surface_stiffness = -1.0; }, "surface");
    refused([](BeltMachine& m) { m.run.length = 0.0; }, "rollers");
    refused([](BeltMachine& m) { m.run.position = 100.0; }, "rollers");
    BeltMachine wheel = free_belt(Rollers::kFixed);
    wheel.kind = BeltMachine::Kind::kContactWheel;
    EXPECT_THROW(make_belt_contact(wheel), std::invalid_argument);
}

}  // namespace
}  // namespace beltgrinding

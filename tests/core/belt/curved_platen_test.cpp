// A belt that is wrapped over a curved platen: its limits, its tension's own pressure, the wheel.

#include <gtest/gtest.h>

#include <cmath>

#include "belt/face_arc.h"
#include "belt/platen.h"
#include "belt_case.h"
#include "beltgrinding/error.h"
#include "elastic/wheel_rim.h"

namespace beltgrinding {
namespace {

using namespace testing;

const ContactGrid kGrid{65, 50, 1.0, 1.0};
const ContactGrid kFine{65, 50, 0.5, 1.0};

BeltMachine platen(double radius) {
    BeltMachine machine = reference_belt(BeltMachine::Kind::kPlaten, BeltRun::Rollers::kFixed);
    machine.platen.radius = radius;
    return machine;
}

/// A hollow that the belt over the platen, or part of it, lies in with all its face.
ContactProblem conformal(const BeltMachine& machine, double depth) {
    const BeltArc face = face_arc(machine);
    ContactProblem problem =
        at_depth(kGrid, depth, [&](double x, double) { return -face.behind(x); });
    problem.tolerance = 1e-3;
    return problem;
}

double barrel(double x, double y) {
    return circle(80.0, x) + circle(300.0, y);
}

TEST(BeltArc, IsItsOwnInverseAndAsLongAsItIs) {
    const BeltArc arc{100.0, 0.6};
    double x = -150.0;
    for (double s = -140.0; s <= 140.0; s += 7.0) {
        EXPECT_NEAR(arc.s(arc.x(s)), s, 1e-10);
        const double next = arc.x(s + 1e-4), here = arc.x(s);
        EXPECT_GT(here, x);
        x = here;
        EXPECT_NEAR(std::hypot(next - here, arc.behind(next) - arc.behind(here)), 1e-4, 1e-9);
        const double slope = (arc.behind(next) - arc.behind(here)) / (next - here);
        EXPECT_NEAR(slope, std::tan(arc.angle(s + 5e-5)), 1e-5);
    }
    EXPECT_EQ(BeltArc{}.behind(30.0), 0.0);
    // A large radius leaves the plane as a parabola does.
    EXPECT_NEAR((BeltArc{1e9, 1e-7}.behind(40.0)), 40.0 * 40.0 / 2e9, 1e-15);
}

TEST(CurvedPlaten, IsTheFlatOneWhereItsRadiusIsBeyondAllMeasure) {
    for (const bool layers : {true, false}) {
        BeltMachine flat = platen(0.0), large = platen(1e8);
        if (!layers) flat.platen.layers.clear(), large.platen.layers.clear();
        // The layers of a flat one are a rim's whose radius is a kilometre.
        for (const double depth : {0.05, 0.2}) {
            ContactProblem problem = at_depth(kGrid, depth, barrel);
            problem.tolerance = 1e-4;
            if (layers) large.platen.radius = 1e4;
            const auto a = make_belt_contact(flat)->prepare(kGrid)->solve(problem);
            const auto b = make_belt_contact(large)->prepare(kGrid)->solve(problem);
            ASSERT_TRUE(a.converged && b.converged);
            // 1e4 mm: the plate recedes by 5 um where the contact ends.
            EXPECT_NEAR(b.force, a.force, (layers ? 0.02 : 1e-4) * a.force) << depth;
            EXPECT_LT((a.pressure - b.pressure).abs().sum(),
                      (layers ? 0.03 : 1e-3) * a.pressure.sum());
        }
    }
}

TEST(CurvedPlaten, GivesWayFromWhereItsTensionHasPressedIt) {
    // A hollow that fits: the layer is compressed evenly, by E (1 - nu) / ((1 + nu) (1 - 2 nu)) / h
    // in series with both faces. The 0.04 MPa of N / R, which alone press it in by 0.03 mm, are
    // there before.
    BeltMachine machine = platen(100.0);
    machine.platen.layers = {{2.0, 4.0, 0.3}};
    const double layer = 4.0 * 0.7 / (1.3 * 0.4) / 2.0;
    const double stiff = 1.0 / (1.0 / layer + 1.0 / 200.0 + 1.0 / 100.0);
    const auto contact = make_belt_contact(machine)->prepare(kGrid);
    // Only its side edges curl away from the platen, as those of a bent plate do.
    const ContactSolution off = contact->solve(conformal(machine, -0.001));
    EXPECT_TRUE(off.converged);
    EXPECT_EQ(off.pressure.segment(8 * kGrid.nx, 34 * kGrid.nx).maxCoeff(), 0.0);
    EXPECT_EQ(contact->solve(conformal(machine, -0.02)).force, 0.0);
    const ContactSolution on = contact->solve(conformal(machine, 0.02));
    EXPECT_TRUE(on.converged);
    EXPECT_NEAR(on.pressure[25 * kGrid.nx + 32], 0.02 * stiff, 0.03 * 0.02 * stiff);
    machine.platen.layers.clear();
    const ContactSolution bare =
        make_belt_contact(machine)->prepare(kGrid)->solve(conformal(machine, 0.01));
    EXPECT_NEAR(bare.pressure[25 * kGrid.nx + 32], 0.01 / (1.0 / 200.0 + 1.0 / 100.0), 0.01);
    // By the depth's share along the normals: cos^2 of what goes along z on the projected area.
    const double sine = 20.0 / 101.0;
    EXPECT_NEAR(bare.pressure[25 * kGrid.nx + 52] / bare.pressure[25 * kGrid.nx + 32],
                std::sqrt(1.0 - sine * sine), 0.002);
}

TEST(CurvedPlaten, ASoftOneThatHardlyTouchesIsSolvedAsQuickly) {
    // What the belt's tension presses on layers of rubber in single precision is noise beside a
    // force of nothing at all.
    BeltMachine machine = platen(256.0);
    machine.platen.layers = {{2.0, 1.0, 0.499}, {0.9, 1.0, 0.499}, {1.0, 3.3, 0.499}};
    machine.platen.layer_surface_stiffness = 0.0;
    const auto contact = make_belt_contact(machine)->prepare(kGrid);
    for (const double depth : {-1.0, -0.01, 0.0, 1e-4, 1e-3, 1e-2}) {
        SCOPED_TRACE(depth);
        ContactProblem problem = at_depth(kGrid, depth, barrel);
        problem.tolerance = 1e-3;
        problem.max_iterations = 500;
        const ContactSolution solution = contact->solve(problem);
        EXPECT_TRUE(solution.converged);
        EXPECT_LT(solution.iterations, 150);
        if (depth < 0.0) {
            EXPECT_EQ(solution.force, 0.0);
        }
        if (depth == 1e-2) {
            EXPECT_GT(solution.force, 0.0);
        }
    }
}

TEST(CurvedPlaten, IsTheContactWheelOfItsRadius) {
    // With a belt that is thin and soft to bend, and one layer: the wheel's rim under its belt.
    BeltMachine machine = platen(60.0);
    machine.belt.thickness = 0.2;
    machine.belt.youngs_modulus = 300.0;
    machine.belt.surface_stiffness = 1e4;
    machine.belt.tension = 1.0;
    machine.platen.length = 80.0;
    machine.platen.layer_surface_stiffness = 1e4;
    WheelRimDesign design;
    design.width = machine.belt.width;
    design.outer_radius = 60.2;
    design.layers.push_back({5.0, {2.0, 0.4}});
    const WheelRim wheel(design, BeltPlate{machine.belt.tension, machine.belt.bending()});
    // Cylinders across the travel, as seen from a plane and from the wheel's axis.
    for (const double radius : {1e9, 100.0}) {
        const auto below = [&](double x, double) { return circle(radius, x); };
        ContactProblem problem = problem_of(kFine, below);
        problem.force = 60.0;
        problem.tolerance = 1e-4;
        const auto platens = make_belt_contact(machine)->prepare(kFine)->solve(problem);
        const auto from_axis = [&](double s, double) {
            const double angle = s / 60.2;
            double r = 60.2 / std::cos(angle);  // to the surface, by Newton's method
            for (int k = 0; k < 20; ++k)
                r = (60.2 + below(r * std::sin(angle), 0.0)) / std::cos(angle);
            return r - 60.2;
        };
        ContactProblem seen = problem_of(kFine, from_axis);
        seen.force = 60.0;
        const auto wheels = wheel.prepare(kFine)->solve(seen);
        ASSERT_TRUE(platens.converged && wheels.converged);
        EXPECT_NEAR(platens.approach, wheels.approach, 0.005 * wheels.approach) << radius;
        const BeltRows a = rows_of(kFine, platens, 1.0), b = rows_of(kFine, wheels, 1.0);
        EXPECT_NEAR(a.x_max, b.x_max, 1.01);
        expect_rows(in_pairs(a.by_x), in_pairs(b.by_x), 0.05);
        expect_rows(in_pairs(a.by_y), in_pairs(b.by_y), 0.05);
    }
}

TEST(CurvedPlaten, MeetsWorkBesideItsMiddle) {
    // A sphere whose highest place lies 25 mm along the travel and as far behind the plane.
    const BeltMachine machine = platen(100.0);
    const BeltArc face = face_arc(machine);
    const auto ball = [&](double x, double y) {
        const double sine = 25.0 / face.radius, cosine = std::sqrt(1.0 - sine * sine);
        // Its middle lies on the platen's normal at x = 25.
        const double far = face.radius + 60.0;
        const double r = std::hypot(x - far * sine, y);
        return r < 60.0 ? far * cosine - face.radius - std::sqrt(3600.0 - r * r) : kBeside;
    };
    ContactProblem problem = problem_of(kGrid, ball);
    problem.force = 20.0;
    problem.tolerance = 1e-3;
    const auto contact = make_belt_contact(machine)->prepare(kGrid);
    const ContactSolution solution = contact->solve(problem);
    ASSERT_TRUE(solution.converged);
    EXPECT_NEAR(solution.force, 20.0, 0.02);
    double moment = 0.0;
    for (int j = 0; j < kGrid.ny; ++j)
        for (int i = 0; i < kGrid.nx; ++i)
            moment += solution.pressure[j * kGrid.nx + i] * kGrid.s(i) * kGrid.cell_area();
    EXPECT_NEAR(moment / solution.force, 25.0, 0.3);
    // From there on, a warm start is the same contact.
    problem.gap += 0.05;
    const ContactSolution warm = contact->solve(problem, &solution.pressure);
    EXPECT_NEAR(warm.approach, solution.approach + 0.05, 1e-3);
    EXPECT_LT((warm.pressure - solution.pressure).abs().sum(), 0.001 * solution.pressure.sum());
}

TEST(CurvedPlaten, NamesWhatCannotBe) {
    const auto refused = [](const BeltMachine& machine, const char* code) {
        try {
            machine.validate();
            FAIL() << code;
        } catch (const InputError& error) {
            EXPECT_EQ(error.fact().code, code);
        }
    };
    refused(platen(-1.0), "platen.radius");
    refused(platen(std::nan("")), "platen.radius");
    refused(platen(50.0), "platen.turns_too_far");  // half of its length is 60 mm
    refused(platen(69.0), "platen.turns_too_far");
    BeltMachine machine = platen(70.0);
    EXPECT_NO_THROW(machine.validate());
    machine.run.length = 130.0;  // its ends lie 120 mm apart, its face is 145 mm long
    refused(machine, "platen.beyond_rollers");
    machine = platen(70.0);
    machine.platen.layers[0].thickness = 71.0;
    refused(machine, "platen.layers_beyond_middle");
}

}  // namespace
}  // namespace beltgrinding

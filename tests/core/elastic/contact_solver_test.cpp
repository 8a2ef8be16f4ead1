// The solver for compliance operators of any kind.
#include "elastic/compliance.h"
#include "elastic/half_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

ContactGrid rows_of(int cells, double spacing) {
    return {cells, 5, spacing, 2.0};
}

ContactProblem parabola(const ContactGrid& grid, double radius) {
    ContactProblem problem;
    problem.gap.resize(grid.cells());
    problem.coverage = Eigen::ArrayXd::Ones(grid.cells());
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const double s = grid.s(i);
            problem.gap[j * grid.nx + i] = s * s / (2.0 * radius);
        }
    }
    return problem;
}

/// A dense symmetric operator of the kind that later rooms bring: u = C (coverage p).
class SmoothCompliance final : public ComplianceOperator {
  public:
    explicit SmoothCompliance(const ContactGrid& grid)
        : ComplianceOperator(grid, "test kernel"), matrix_(grid.cells(), grid.cells()) {
        for (int b = 0; b < grid.cells(); ++b) {
            for (int a = 0; a < grid.cells(); ++a) {
                const double ds = grid.s(a % grid.nx) - grid.s(b % grid.nx);
                const double dy = grid.y(a / grid.nx) - grid.y(b / grid.nx);
                matrix_(a, b) = 0.05 * grid.cell_area() / (0.6 + std::hypot(ds, dy));
            }
        }
    }
    double diagonal() const override { return matrix_(0, 0); }

  private:
    void do_apply(const Eigen::ArrayXd& pressure, Eigen::ArrayXd& displacement) override {
        displacement = (matrix_ * pressure.matrix()).array();
    }

    Eigen::MatrixXd matrix_;
};

// Line contact of a foundation of stiffness k: a = (3 P R / (2 k))^(1/3), p0 = k a^2 / (2 R)
// (Johnson 1985, section 4.3).
TEST(ContactSolver, FoundationLineContactConvergesToTheory) {
    const double stiffness = 0.6, radius = 80.0, load = 3.0;  // N/mm
    const double a = std::cbrt(1.5 * load * radius / stiffness);
    double last = 1.0;
    for (const int cells : {33, 129}) {
        const ContactGrid grid = rows_of(cells, 3.0 * a / cells);
        ContactProblem problem = parabola(grid, radius);
        problem.force = load * grid.ny * grid.dy;
        problem.tolerance = 1e-8;
        const ContactSolution solution = ElasticFoundation(stiffness).prepare(grid)->solve(problem);
        EXPECT_TRUE(solution.converged);
        EXPECT_NEAR(solution.force, problem.force, 1e-9 * problem.force);
        const double p0 = stiffness * a * a / (2.0 * radius);
        const double error = std::abs(solution.pressure.maxCoeff() / p0 - 1.0);
        EXPECT_LT(error, cells == 33 ? 0.01 : 0.001);
        EXPECT_LT(error, last);
        last = error;
    }
}

TEST(ContactSolver, PositionControlReturnsTheForceOfForceControl) {
    const ContactGrid grid = rows_of(65, 0.4);
    const auto foundation = ElasticFoundation(0.5).prepare(grid);
    ContactProblem problem = parabola(grid, 60.0);
    problem.force = 40.0;
    problem.tolerance = 1e-9;
    const ContactSolution forced = foundation->solve(problem);
    problem.force_control = false;
    problem.approach = forced.approach;
    const ContactSolution placed = foundation->solve(problem);
    EXPECT_NEAR(placed.force, 40.0, 1e-5);
    EXPECT_LT((placed.pressure - forced.pressure).abs().maxCoeff(), 1e-7);
}

// Rough, partly empty, partly covered contacts: the Signorini conditions hold, for a local and a
// non-local operator, under both controls.
TEST(ContactSolver, KeepsTheSignoriniConditionsOnRandomContacts) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < 40; ++trial) {
        const ContactGrid grid = rows_of(21, 0.8);
        ContactProblem problem = parabola(grid, 30.0 + 50.0 * uniform(random));
        for (Eigen::Index c = 0; c < problem.gap.size(); ++c) {
            problem.gap[c] += 0.1 * uniform(random);
            if (uniform(random) < 0.1) problem.gap[c] = std::numeric_limits<double>::infinity();
            if (uniform(random) < 0.2) problem.coverage[c] = uniform(random);
        }
        problem.tolerance = 1e-7;
        problem.max_iterations = 5000;
        problem.force_control = trial % 2 == 0;
        problem.force = 5.0 + 40.0 * uniform(random);
        problem.approach = 0.1 + 0.3 * uniform(random);
        problem.recession = trial % 4 < 2 ? 0.0 : 0.5 * uniform(random);
        const auto foundation = ElasticFoundation(0.3 + uniform(random)).compliance(grid);
        SmoothCompliance smooth(grid);
        for (ComplianceOperator* compliance :
             {foundation.get(), static_cast<ComplianceOperator*>(&smooth)}) {
            const ContactSolution solution = compliance->solve(problem);
            ASSERT_TRUE(solution.converged) << trial;
            Eigen::ArrayXd u;
            compliance->apply(solution.pressure, problem.coverage, u);
            const double sum = (solution.pressure * problem.coverage).sum() * grid.cell_area();
            EXPECT_NEAR(sum, solution.force, 1e-9 * sum);
            if (problem.force_control) {
                EXPECT_NEAR(sum, problem.force, 1e-9 * problem.force);
            }
            EXPECT_GE(solution.pressure.minCoeff(), 0.0);
            for (Eigen::Index c = 0; c < u.size(); ++c) {
                if (!std::isfinite(problem.gap[c]) || problem.coverage[c] <= 0.0) {
                    EXPECT_EQ(solution.pressure[c], 0.0);
                    continue;
                }
                const double open = problem.gap[c] + u[c] - solution.approach +
                                    problem.recession * solution.pressure[c];
                EXPECT_GE(open, -1e-5);
                EXPECT_LT(solution.pressure[c] * std::max(open, 0.0), 1e-5);
            }
        }
    }
}

TEST(ContactSolver, ASurfaceThatRecedesMakesSpringsSofter) {
    const ContactGrid grid = rows_of(65, 0.4);
    ContactProblem problem = parabola(grid, 60.0);
    problem.force = 40.0;
    problem.tolerance = 1e-9;
    const auto prepared = ElasticFoundation(0.5).prepare(grid);
    problem.recession = 0.7;  // mm/MPa
    const ContactSolution receding = prepared->solve(problem);
    problem.recession = 0.0;  // of the next contact: it is not kept
    const ContactSolution still = prepared->solve(problem);
    const ContactSolution softer =
        ElasticFoundation(1.0 / (1.0 / 0.5 + 0.7)).prepare(grid)->solve(problem);
    EXPECT_LT((receding.pressure - softer.pressure).abs().maxCoeff(), 1e-7);
    EXPECT_NEAR(receding.approach, softer.approach, 1e-7);
    EXPECT_GT(still.pressure.maxCoeff(), 1.1 * softer.pressure.maxCoeff());
}

// A start may be pressed elsewhere than the contact is: on columns that lie beside it, or on some
// of them only. What is found is what a start from nothing finds.
TEST(ContactSolver, FindsContactFarFromItsStart) {
    const ContactGrid grid = rows_of(64, 0.5);
    const auto wheel = BondedLayer({5.0, 0.45}, 10.0).compliance(grid);
    const auto bumps = [&](std::initializer_list<double> middles) {
        ContactProblem problem = parabola(grid, 50.0);
        problem.gap.setConstant(1.0);
        for (int cell = 0; cell < grid.cells(); ++cell) {
            for (const double middle : middles) {
                const double away = grid.s(cell % grid.nx) - middle;
                problem.gap[cell] = std::min(problem.gap[cell], 0.05 * away * away);
            }
        }
        problem.force = 5.0;
        problem.tolerance = 1e-6;
        return problem;
    };
    for (const auto& [from, to] : {std::pair{bumps({-8.0}), bumps({8.0})},
                                   {bumps({-8.0}), bumps({-8.0, 8.0})},
                                   {bumps({-8.0, 8.0}), bumps({0.0})},
                                   {bumps({-2.0}), bumps({0.0})}}) {
        for (const bool force_control : {true, false}) {
            ContactProblem problem = to;
            problem.force_control = force_control;
            problem.approach = 0.2;
            const ContactSolution start = wheel->solve(from);
            const ContactSolution cold = wheel->solve(problem);
            const ContactSolution warm = wheel->solve(problem, &start.pressure);
            EXPECT_TRUE(warm.converged);
            EXPECT_LT((warm.pressure - cold.pressure).abs().sum(), 1e-4 * cold.pressure.sum());
            EXPECT_NEAR(warm.approach, cold.approach, 1e-5);
            Eigen::ArrayXd u;
            wheel->apply(warm.pressure, problem.coverage, u);
            EXPECT_GT((problem.gap + u - warm.approach).minCoeff(), -1e-5);
        }
    }
}

TEST(ContactSolver, WarmStartGivesTheSameInFewerIterations) {
    const ContactGrid grid = rows_of(31, 0.6);
    SmoothCompliance smooth(grid);
    ContactProblem problem = parabola(grid, 50.0);
    problem.force = 30.0;
    problem.tolerance = 1e-6;
    const ContactSolution cold = smooth.solve(problem);
    problem.gap += 0.01 * Eigen::ArrayXd::Random(problem.gap.size());
    const ContactSolution again = smooth.solve(problem);
    const ContactSolution warm = smooth.solve(problem, &cold.pressure);
    EXPECT_LE(warm.iterations, again.iterations);
    EXPECT_LT((warm.pressure - again.pressure).abs().sum(), 1e-4 * again.pressure.sum());
}

TEST(ContactSolver, RefusesNonsense) {
    const auto foundation = ElasticFoundation(1.0).prepare(rows_of(5, 1.0));
    ContactProblem problem = parabola(foundation->grid(), 10.0);
    problem.force = -1.0;
    EXPECT_THROW(foundation->solve(problem), InputError);
    problem.force = 1.0;
    problem.gap[0] = std::nan("");
    EXPECT_THROW(foundation->solve(problem), InputError);
    problem.gap.resize(3);
    EXPECT_THROW(foundation->solve(problem), InputError);
    EXPECT_THROW(ElasticFoundation(0.0), InputError);
}

TEST(ContactSolver, NothingThereIsNoContact) {
    const auto foundation = ElasticFoundation(1.0).prepare(rows_of(5, 1.0));
    ContactProblem problem = parabola(foundation->grid(), 10.0);
    problem.gap.setConstant(std::numeric_limits<double>::infinity());
    problem.force_control = false;
    EXPECT_EQ(foundation->solve(problem).force, 0.0);
}

TEST(ContactWheel, CrownDropsTowardsTheEdges) {
    const ContactWheel crowned{100.0, 50.0, 200.0};
    EXPECT_NEAR(crowned.drop(25.0), 200.0 - std::sqrt(200.0 * 200.0 - 625.0), 1e-12);
    EXPECT_NEAR(crowned.drop_slope(10.0), (crowned.drop(10.001) - crowned.drop(9.999)) / 0.002,
                1e-6);
    EXPECT_EQ((ContactWheel{100.0, 50.0, 0.0}.drop(25.0)), 0.0);
    EXPECT_THROW((ContactWheel{100.0, 50.0, 20.0}.validate()), InputError);
    EXPECT_THROW((ContactWheel{-1.0, 50.0, 0.0}.validate()), InputError);
}

TEST(ContactWheel, ProfileAddsToTheCrown) {
    ContactWheel wheel{100.0, 50.0, 0.0};
    wheel.profile = {{-25.0, 2.0}, {-10.0, 0.0}, {10.0, 0.0}, {30.0, 4.0}};
    wheel.validate();
    EXPECT_NEAR(wheel.drop(-25.0), 2.0, 1e-12);
    EXPECT_NEAR(wheel.drop(-17.5), 1.0, 1e-12);
    EXPECT_EQ(wheel.drop(3.0), 0.0);
    EXPECT_NEAR(wheel.drop(20.0), 2.0, 1e-12);
    EXPECT_NEAR(wheel.drop_slope(20.0), 0.2, 1e-12);
    const double profile = wheel.drop(20.0);
    wheel.crown_radius = 200.0;
    EXPECT_NEAR(wheel.drop(20.0), profile + 200.0 - std::sqrt(200.0 * 200.0 - 400.0), 1e-12);
    wheel.profile.pop_back();  // does not reach the other side
    EXPECT_THROW(wheel.validate(), InputError);
    wheel.profile = {{-25.0, 0.0}, {25.0, 0.0}, {25.0, 1.0}};  // a step is no profile
    EXPECT_THROW(wheel.validate(), InputError);
}

}  // namespace
}  // namespace beltgrinding

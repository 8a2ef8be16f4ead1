#include "contact_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

ContactProblem parabola(int cells, double spacing, double radius) {
    ContactProblem problem;
    problem.grid = {cells, 5, spacing, 2.0};
    problem.gap.resize(problem.grid.cells());
    problem.coverage = Eigen::ArrayXd::Ones(problem.grid.cells());
    for (int j = 0; j < problem.grid.ny; ++j) {
        for (int i = 0; i < cells; ++i) {
            const double s = problem.grid.s(i);
            problem.gap[j * cells + i] = s * s / (2.0 * radius);
        }
    }
    return problem;
}

/// A dense symmetric operator of the kind that later rooms bring: u = C (coverage p).
class SmoothCompliance final : public ComplianceOperator {
  public:
    void set_grid(const ContactGrid& grid) override {
        matrix_.resize(grid.cells(), grid.cells());
        for (int b = 0; b < grid.cells(); ++b) {
            for (int a = 0; a < grid.cells(); ++a) {
                const double ds = grid.s(a % grid.nx) - grid.s(b % grid.nx);
                const double dy = grid.y(a / grid.nx) - grid.y(b / grid.nx);
                matrix_(a, b) = 0.05 * grid.cell_area() / (0.6 + std::hypot(ds, dy));
            }
        }
    }
    void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
               Eigen::ArrayXd& displacement) const override {
        displacement = (matrix_ * (pressure * coverage).matrix()).array();
    }
    double diagonal() const override { return matrix_(0, 0); }
    std::string describe() const override { return "test kernel"; }

  private:
    Eigen::MatrixXd matrix_;
};

// Line contact of a foundation of stiffness k: a = (3 P R / (2 k))^(1/3), p0 = k a^2 / (2 R)
// (Johnson 1985, section 4.3).
TEST(ContactSolver, FoundationLineContactConvergesToTheory) {
    const double stiffness = 0.6, radius = 80.0, load = 3.0;  // N/mm
    const double a = std::cbrt(1.5 * load * radius / stiffness);
    double last = 1.0;
    for (const int cells : {33, 129}) {
        ContactProblem problem = parabola(cells, 3.0 * a / cells, radius);
        problem.force = load * problem.grid.ny * problem.grid.dy;
        problem.tolerance = 1e-8;
        const ElasticFoundation foundation(stiffness);
        const ContactSolution solution = solve_contact(problem, foundation);
        EXPECT_TRUE(solution.converged);
        EXPECT_NEAR(solution.force, problem.force, 1e-9 * problem.force);
        const double p0 = stiffness * a * a / (2.0 * radius);
        const double error = std::abs(solution.peak_pressure / p0 - 1.0);
        EXPECT_LT(error, cells == 33 ? 0.01 : 0.001);
        EXPECT_LT(error, last);
        last = error;
    }
}

TEST(ContactSolver, PositionControlReturnsTheForceOfForceControl) {
    const ElasticFoundation foundation(0.5);
    ContactProblem problem = parabola(65, 0.4, 60.0);
    problem.force = 40.0;
    problem.tolerance = 1e-9;
    const ContactSolution forced = solve_contact(problem, foundation);
    problem.force_control = false;
    problem.approach = forced.approach;
    const ContactSolution placed = solve_contact(problem, foundation);
    EXPECT_NEAR(placed.force, 40.0, 1e-5);
    EXPECT_LT((placed.pressure - forced.pressure).abs().maxCoeff(), 1e-7);
}

// Rough, partly empty, partly covered contacts: the Signorini conditions hold, for a local and a
// non-local operator, under both controls.
TEST(ContactSolver, KeepsTheSignoriniConditionsOnRandomContacts) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < 40; ++trial) {
        ContactProblem problem = parabola(21, 0.8, 30.0 + 50.0 * uniform(random));
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
        ElasticFoundation foundation(0.3 + uniform(random));
        SmoothCompliance smooth;
        smooth.set_grid(problem.grid);
        for (const ComplianceOperator* compliance :
             {static_cast<const ComplianceOperator*>(&foundation),
              static_cast<const ComplianceOperator*>(&smooth)}) {
            const ContactSolution solution = solve_contact(problem, *compliance);
            ASSERT_TRUE(solution.converged) << trial;
            Eigen::ArrayXd u;
            compliance->apply(solution.pressure, problem.coverage, u);
            const double sum =
                (solution.pressure * problem.coverage).sum() * problem.grid.cell_area();
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
                const double open = problem.gap[c] + u[c] - solution.approach;
                EXPECT_GE(open, -1e-5);
                EXPECT_LT(solution.pressure[c] * std::max(open, 0.0), 1e-5);
            }
        }
    }
}

TEST(ContactSolver, WarmStartGivesTheSameInFewerIterations) {
    SmoothCompliance smooth;
    ContactProblem problem = parabola(31, 0.6, 50.0);
    smooth.set_grid(problem.grid);
    problem.force = 30.0;
    problem.tolerance = 1e-6;
    const ContactSolution cold = solve_contact(problem, smooth);
    problem.gap += 0.01 * Eigen::ArrayXd::Random(problem.gap.size());
    const ContactSolution again = solve_contact(problem, smooth);
    const ContactSolution warm = solve_contact(problem, smooth, &cold.pressure);
    EXPECT_LE(warm.iterations, again.iterations);
    EXPECT_LT((warm.pressure - again.pressure).abs().sum(), 1e-4 * again.pressure.sum());
}

TEST(ContactSolver, RefusesNonsense) {
    const ElasticFoundation foundation(1.0);
    ContactProblem problem = parabola(5, 1.0, 10.0);
    problem.force = -1.0;
    EXPECT_THROW(solve_contact(problem, foundation), InputError);
    problem.force = 1.0;
    problem.gap[0] = std::nan("");
    EXPECT_THROW(solve_contact(problem, foundation), InputError);
    problem.gap.resize(3);
    EXPECT_THROW(solve_contact(problem, foundation), InputError);
    EXPECT_THROW(ElasticFoundation(0.0), InputError);
}

TEST(ContactSolver, NothingThereIsNoContact) {
    const ElasticFoundation foundation(1.0);
    ContactProblem problem = parabola(5, 1.0, 10.0);
    problem.gap.setConstant(std::numeric_limits<double>::infinity());
    problem.force_control = false;
    EXPECT_EQ(solve_contact(problem, foundation).force, 0.0);
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

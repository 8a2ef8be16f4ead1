// The compliance operators against theory.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <random>

#include "beltgrinding/error.h"
#include "elastic/half_space.h"
#include "elastic/wheel_rim.h"
#include "models/single_contact.h"

namespace beltgrinding {
namespace {

constexpr double kPi = std::numbers::pi;
const Elasticity kRubber{5.0, 0.45};

ContactProblem problem_on(const ContactGrid& grid, double force) {
    ContactProblem problem;
    problem.gap.resize(grid.cells());
    problem.coverage = Eigen::ArrayXd::Ones(grid.cells());
    problem.force = force;
    return problem;
}

WheelRimDesign rim(double radius, double width, double thickness, Elasticity elasticity) {
    WheelRimDesign design;
    design.outer_radius = radius;
    design.width = width;
    design.layers = {{thickness, elasticity}};
    return design;
}

std::vector<std::unique_ptr<ElasticModel>> models() {
    std::vector<std::unique_ptr<ElasticModel>> all;
    all.push_back(std::make_unique<ElasticFoundation>(0.5));
    all.push_back(std::make_unique<HalfSpace>(kRubber));
    all.push_back(std::make_unique<BondedLayer>(kRubber, 15.0));
    all.push_back(std::make_unique<WheelRim>(rim(100.0, 30.0, 15.0, kRubber)));
    return all;
}

// Johnson: Contact Mechanics, section 4.2.
TEST(HalfSpace, HertzPoint) {
    const double radius = 100.0, force = 50.0, modulus = kRubber.plane_strain_modulus();
    const double a = std::cbrt(0.75 * force * radius / modulus);
    for (const auto& [cells, error] : {std::pair{16, 0.04}, {64, 0.01}}) {
        const double size = 2.0 * a / cells;
        const int n = cells + cells / 4;
        const ContactGrid grid{n, n, size, size};
        ContactProblem problem = problem_on(grid, force);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const double s = grid.s(i), y = grid.y(j);
                problem.gap[j * n + i] = (s * s + y * y) / (2.0 * radius);
            }
        }
        const ContactSolution solution = HalfSpace(kRubber).prepare(grid)->solve(problem);
        ASSERT_TRUE(solution.converged);
        EXPECT_NEAR(solution.peak_pressure, 1.5 * force / (kPi * a * a),
                    error * solution.peak_pressure);
        EXPECT_NEAR(solution.approach, a * a / radius, error * solution.approach);
        EXPECT_NEAR(solution.area, kPi * a * a, 2.0 * error * solution.area);
    }
}

TEST(HalfSpace, HertzLine) {
    // One row of cells, so long that the middle knows nothing of the ends; the approach of a line
    // contact is not defined, its pressure is.
    const double radius = 100.0, length = 1e5, line = 2.0, modulus = kRubber.plane_strain_modulus();
    const double a = std::sqrt(4.0 * line * radius / (kPi * modulus));
    const int n = 80;
    const ContactGrid grid{n, 1, 2.0 * a / 64, length};
    ContactProblem problem = problem_on(grid, line * length);
    for (int i = 0; i < n; ++i) problem.gap[i] = std::pow(grid.s(i), 2) / (2.0 * radius);
    const ContactSolution solution = HalfSpace(kRubber).prepare(grid)->solve(problem);
    ASSERT_TRUE(solution.converged);
    EXPECT_NEAR(solution.peak_pressure, 2.0 * line / (kPi * a), 0.01 * solution.peak_pressure);
    EXPECT_NEAR(solution.area / length, 2.0 * a, 0.03 * 2.0 * a);
}

TEST(BondedLayer, ShapeHasTheLimitsOfTheory) {
    for (const double nu : {0.0, 0.3, 0.45, 0.49}) {
        // Long waves: a column that cannot expand, h / M.
        const double x = 1e-4;
        const double column = (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu);
        EXPECT_NEAR(2.0 * (1.0 - nu * nu) * BondedLayer::shape(x, nu) / x, column, 1e-4);
        EXPECT_NEAR(BondedLayer::shape(40.0, nu), 1.0, 1e-12);
        // No jump where the series ends.
        EXPECT_NEAR(BondedLayer::shape(0.3 - 1e-9, nu), BondedLayer::shape(0.3 + 1e-9, nu), 1e-8);
    }
    // Incompressible: u = q^2 h^3 p / E.
    const double x = 1e-2;
    EXPECT_NEAR(1.5 * BondedLayer::shape(x, 0.5) / (x * x * x), 1.0, 1e-3);
}

TEST(BondedLayer, ThinCompressibleLine) {
    // p = (M / h) (delta - x^2 / 2R), a = (3 P R h / 2M)^(1/3).
    const Elasticity elasticity{5.0, 0.3};
    const double h = 0.5, radius = 100.0, line = 4.0;
    const double modulus = 5.0 * 0.7 / (1.3 * 0.4);
    const double a = std::cbrt(1.5 * line * radius * h / modulus);
    const int n = 80, rows = 40;
    const ContactGrid grid{n, rows, 2.0 * a / 64, 0.5};
    ContactProblem problem = problem_on(grid, line * rows * 0.5);
    for (int c = 0; c < n * rows; ++c) {
        problem.gap[c] = std::pow(grid.s(c % n), 2) / (2.0 * radius);
    }
    const ContactSolution solution = BondedLayer(elasticity, h).prepare(grid)->solve(problem);
    ASSERT_TRUE(solution.converged);
    const double middle = solution.pressure[rows / 2 * n + n / 2];
    EXPECT_NEAR(middle, modulus / h * a * a / (2.0 * radius), 0.04 * middle);
}

TEST(BondedLayer, ThinIncompressibleLineConvergesAsTheSquareOfThickness) {
    // p0 = E a^4 / (24 R h^3), delta = a^2 / 6R, in the middle of a contact so long (twelve a) that
    // the rubber which leaves by its ends is not missed there.
    const double radius = 1000.0, a = 8.0;
    std::vector<double> errors;
    for (const double h : {1.0, 0.5}) {
        const int n = 128, rows = 96;
        const ContactGrid grid{n, rows, 2.5 * a / n, 1.0};
        ContactProblem problem = problem_on(grid, 0.0);
        problem.force_control = false;
        problem.approach = a * a / (6.0 * radius);
        problem.tolerance = 1e-5;
        problem.max_iterations = 4000;
        for (int c = 0; c < n * rows; ++c) {
            problem.gap[c] = std::pow(grid.s(c % n), 2) / (2.0 * radius);
        }
        const ContactSolution solution = BondedLayer({5.0, 0.5}, h).prepare(grid)->solve(problem);
        ASSERT_TRUE(solution.converged);
        const double middle = solution.pressure[rows / 2 * n + n / 2];
        const double expected = 5.0 * std::pow(a, 4) / (24.0 * radius * h * h * h);
        errors.push_back(middle / expected - 1.0);
    }
    // By a dense solution of the plane problem on 1024 cells: 0.1948, 0.0520, 0.0135 for h = 1,
    // 0.5, 0.25, a factor that goes to 4.
    EXPECT_NEAR(errors[0], 0.1948, 0.01);
    EXPECT_NEAR(errors[1], 0.0520, 0.01);
    EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.6);
}

TEST(WheelRim, AWideRimOnALargeWheelIsTheBondedLayer) {
    const ContactGrid grid{32, 96, 1.0, 2.0};
    const auto wheel = WheelRim(rim(5000.0, 192.0, 15.0, kRubber)).compliance(grid);
    const auto layer = BondedLayer(kRubber, 15.0).compliance(grid);
    Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(grid.cells()), a, b;
    const Eigen::ArrayXd coverage = Eigen::ArrayXd::Ones(grid.cells());
    for (int j = 44; j < 52; ++j) pressure.segment(j * grid.nx + 12, 8) = 0.1;
    wheel->apply(pressure, coverage, a);
    layer->apply(pressure, coverage, b);
    EXPECT_LT((a - b).abs().maxCoeff(), 0.02 * b.maxCoeff());
}

TEST(WheelRim, IsSymmetricAndPositiveDefiniteForAnyNumberOfRows) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (const int ny : {1, 2, 7, 16}) {
        const ContactGrid grid{24, ny, 1.0, 20.0 / ny};
        const auto wheel = WheelRim(rim(60.0, 20.0, 10.0, kRubber), {2.0, 30.0}).compliance(grid);
        Eigen::ArrayXd p(grid.cells()), q(grid.cells()), coverage(grid.cells()), cp, cq;
        for (int trial = 0; trial < 5; ++trial) {
            for (int c = 0; c < grid.cells(); ++c) {
                p[c] = uniform(random) - 0.5;
                q[c] = uniform(random) - 0.5;
                coverage[c] = uniform(random);
            }
            wheel->apply(p, coverage, cp);
            wheel->apply(q, coverage, cq);
            const double a = (coverage * q * cp).sum(), b = (coverage * p * cq).sum();
            EXPECT_NEAR(a, b,
                        1e-4 * std::sqrt((coverage * p * cp).sum() * (coverage * q * cq).sum()));
            EXPECT_GT((coverage * p * cp).sum(), 0.0);
        }
    }
}

TEST(WheelRim, TheBeltStiffensAndALayerOfTheSameRubberChangesNothing) {
    const ContactGrid grid{32, 20, 1.0, 1.0};
    Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(grid.cells()), plain, belted, layered;
    pressure[10 * 32 + 16] = 1.0;
    const Eigen::ArrayXd coverage = Eigen::ArrayXd::Ones(grid.cells());
    const WheelRim one(rim(60.0, 20.0, 10.0, kRubber));
    const WheelRim belt(rim(60.0, 20.0, 10.0, kRubber), {5.0, 50.0});
    WheelRimDesign design = rim(60.0, 20.0, 6.0, kRubber);
    design.layers.push_back({4.0, kRubber});
    const WheelRim two(design);
    one.compliance(grid)->apply(pressure, coverage, plain);
    belt.compliance(grid)->apply(pressure, coverage, belted);
    two.compliance(grid)->apply(pressure, coverage, layered);
    EXPECT_LT(belted.maxCoeff(), 0.8 * plain.maxCoeff());
    EXPECT_NEAR(belted.sum(), plain.sum(), 0.05 * plain.sum());  // it spreads, it does not hold
    EXPECT_LT((layered - plain).abs().maxCoeff(), 0.01 * plain.maxCoeff());
}

TEST(WheelRim, IsReadFromTheCacheAndComputedAgainWhereThatIsDamaged) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("rim" + std::to_string(::getpid()));
    const auto cache = std::make_shared<FolderRimCache>(folder / "made");
    const ContactGrid grid{16, 11, 1.0, 2.0};
    const Eigen::ArrayXd pressure = Eigen::ArrayXd::LinSpaced(grid.cells(), 0.0, 1.0);
    const Eigen::ArrayXd coverage = Eigen::ArrayXd::Ones(grid.cells());
    std::vector<Eigen::ArrayXd> results;
    const auto solve = [&](double thickness) {
        const auto wheel =
            WheelRim(rim(60.0, 22.0, thickness, kRubber), {}, cache).compliance(grid);
        results.emplace_back();
        wheel->apply(pressure, coverage, results.back());
        return wheel->describe();
    };
    const std::string name = solve(10.0);
    EXPECT_NE(name.find("cached as"), std::string::npos);
    const fs::path file = fs::directory_iterator(folder / "made")->path();
    const auto size = fs::file_size(file);
    solve(10.0);
    fs::resize_file(file, size / 2);
    solve(10.0);
    EXPECT_EQ(fs::file_size(file), size);  // mended
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(400).put('x');
    solve(10.0);
    for (const Eigen::ArrayXd& result : results) EXPECT_TRUE((result == results[0]).all());
    EXPECT_NE(solve(11.0), name);
    // A wheel that differs by less than a report shows is another wheel.
    solve(10.0 + 1e-9);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "made"), {}), 3);
    fs::remove_all(folder);
}

TEST(WheelRim, RefusesWhatIsNoWheel) {
    EXPECT_THROW(WheelRim(rim(100.0, 50.0, 100.0, kRubber)), InputError);
    EXPECT_THROW(WheelRim(rim(100.0, 0.0, 10.0, kRubber)), InputError);
    EXPECT_THROW(WheelRim(rim(100.0, 50.0, 10.0, {5.0, 0.5})), InputError);
    EXPECT_THROW(WheelRim(rim(100.0, 50.0, 10.0, {-5.0, 0.4})), InputError);
    EXPECT_THROW(WheelRim(WheelRimDesign{}), InputError);
}

/// Signorini's conditions on random rough, tilted, partly absent surfaces, as closely as is asked
/// for.
TEST(Contact, RandomContactsKeepSignorinisConditions) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    const ContactGrid grid{40, 30, 1.0, 1.0};
    std::vector<std::unique_ptr<ComplianceOperator>> operators;
    for (const auto& model : models()) operators.push_back(model->compliance(grid));
    for (int trial = 0; trial < 12; ++trial) {
        ContactProblem problem = problem_on(grid, 5.0 + 10.0 * trial);
        problem.tolerance = trial % 2 == 0 ? 1e-3 : 1e-5;
        const double tilt = 0.02 * normal(random), concave = trial % 3 == 0 ? -1.0 : 1.0;
        const int hole = trial % 4 == 1 ? 6 : 0;
        for (int c = 0; c < grid.cells(); ++c) {
            const double s = grid.s(c % 40), y = grid.y(c / 40);
            problem.gap[c] =
                s * s / 200.0 + concave * y * y / 400.0 + tilt * y + 0.02 * normal(random);
            if (trial % 2 == 1 && y > 6.0) problem.coverage[c] = 0.0;
            if (std::hypot(s, y) < hole) problem.gap[c] = std::numeric_limits<double>::infinity();
        }
        for (const auto& compliance : operators) {
            const ContactSolution solution = compliance->solve(problem);
            ASSERT_TRUE(solution.converged) << compliance->describe() << trial;
            EXPECT_NEAR(solution.force, problem.force, 1e-6 * problem.force);
            EXPECT_GE(solution.pressure.minCoeff(), 0.0);
            Eigen::ArrayXd u;
            compliance->set_surface(problem);
            compliance->apply(solution.pressure, problem.coverage, u);
            compliance->clear_surface();
            // What is off in all cells together (L1) is within the tolerance; a cell's share of it
            // may be some times that.
            const double scale =
                problem.tolerance * solution.peak_pressure * compliance->diagonal();
            double open = 0.0, weight = 0.0;
            for (int c = 0; c < grid.cells(); ++c) {
                if (problem.coverage[c] == 0.0 || !std::isfinite(problem.gap[c])) continue;
                const double g = problem.gap[c] + u[c] - solution.approach;
                EXPECT_GT(g, -10.0 * scale) << compliance->describe() << trial;
                open += solution.pressure[c] * std::abs(g);
                weight += solution.pressure[c];
            }
            EXPECT_LT(open / weight, 2.0 * scale) << compliance->describe() << trial;
        }
    }
}

TEST(Contact, ARobotOfGivenStiffnessStandsBetweenForceAndPosition) {
    const ContactGrid grid{40, 30, 1.0, 1.0};
    ContactProblem problem = problem_on(grid, 0.0);
    for (int c = 0; c < grid.cells(); ++c) {
        problem.gap[c] = std::pow(grid.s(c % 40), 2) / 200.0;
    }
    problem.force_control = false;
    problem.approach = 0.8;
    problem.tolerance = 1e-6;
    const auto wheel = WheelRim(rim(100.0, 30.0, 15.0, kRubber)).prepare(grid);
    const double rigid = wheel->solve(problem).force;
    double last = rigid;
    for (const double stiffness : {1e6, 1000.0, 100.0, 10.0}) {
        problem.robot_compliance = 1.0 / stiffness;
        const ContactSolution solution = wheel->solve(problem);
        EXPECT_TRUE(solution.converged);
        EXPECT_NEAR(solution.force, stiffness * (0.8 - solution.approach), 1e-4 * rigid + 1e-3);
        EXPECT_LE(solution.force, last * (1.0 + 1e-5));
        last = solution.force;
    }
    EXPECT_LT(last, 0.5 * rigid);
}

TEST(SingleContact, ForceAndApproachAgree) {
    const WheelRim wheel(rim(100.0, 30.0, 15.0, kRubber));
    SingleContact contact;
    contact.wheel = {100.0, 30.0, 0.0};
    contact.spacing = 1.0;
    contact.force = 60.0;
    for (const Workpiece& workpiece :
         {Workpiece{}, Workpiece{Workpiece::Shape::kCylinder, 50.0, 0.0, 0.0},
          Workpiece{Workpiece::Shape::kCylinder, -150.0, 0.0, 0.0},
          Workpiece{Workpiece::Shape::kCylinder, 40.0, 0.0, 0.7},
          Workpiece{Workpiece::Shape::kSphere, 60.0, 0.0, 0.0},
          Workpiece{Workpiece::Shape::kStrip, 0.0, 8.5, 0.0}}) {
        contact.workpiece = workpiece;
        contact.force_control = true;
        const SingleContactResult forced = press(contact, wheel);
        EXPECT_TRUE(forced.solution.converged);
        EXPECT_NEAR(forced.solution.force, 60.0, 1e-6);
        contact.force_control = false;
        contact.approach = forced.solution.approach;
        const SingleContactResult placed = press(contact, wheel);
        EXPECT_NEAR(placed.solution.force, 60.0, 0.2);
    }
}

TEST(SingleContact, AConcavePartCloserThanTheWheelTouchesAtTheEdges) {
    const WheelRim wheel(rim(100.0, 30.0, 15.0, kRubber));
    SingleContact contact;
    contact.wheel = {100.0, 30.0, 0.0};
    contact.workpiece = {Workpiece::Shape::kCylinder, -40.0, 0.0, 0.0};
    contact.spacing = 1.0;
    contact.force = 5.0;
    const SingleContactResult result = press(contact, wheel);
    const int nx = result.grid.nx, middle = nx / 2;
    EXPECT_GT(result.solution.pressure[middle], 0.05);           // the wheel's edge
    EXPECT_EQ(result.solution.pressure[15 * nx + middle], 0.0);  // its middle hangs free
}

}  // namespace
}  // namespace beltgrinding

// What bulges out beside the wheel: the rim on a sloped surface, where its pressure acts, and what
// that takes from samples beyond the side faces.

#include "contact/displaced.h"
#include "beltgrinding/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "elastic/wheel_rim.h"
#include "gap/gap_map.h"
#include "support/blocks.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr double kTilt = 0.05;  // mm/mm

WheelRim rubber(BeltPlate belt = {}) {
    WheelRimDesign design;
    design.outer_radius = 100.0;
    design.width = 30.0;
    design.layers = {{15.0, {5.0, 0.45}}};
    return WheelRim(design, belt);
}

/// A plane that rises towards +y by `tilt`.
ContactProblem tilted(const ContactGrid& grid, double tilt) {
    ContactProblem problem;
    problem.gap.resize(grid.cells());
    problem.coverage = Eigen::ArrayXd::Ones(grid.cells());
    for (int c = 0; c < grid.cells(); ++c) {
        const double s = grid.s(c % grid.nx), y = grid.y(c / grid.nx);
        problem.gap[c] = s * s / 200.0 - tilt * y;
    }
    problem.force = 20.0;
    problem.tolerance = 1e-6;
    return problem;
}

double force_of(const ContactGrid& grid, const DisplacedPressure& p, const Eigen::ArrayXd& cover) {
    const double beside = p.reach.size() > 0 ? (p.beside * p.reach).sum() * grid.ds : 0.0;
    return (p.pressure * cover).sum() * grid.cell_area() + beside;
}

TEST(Displaced, ARimOnASlopedSurfaceIsSymmetricAndDefinite) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const int ny : {1, 2, 15, 30}) {
        const ContactGrid grid{24, ny, 1.0, 30.0 / ny};
        const auto wheel = rubber().compliance(grid);
        ContactProblem problem = tilted(grid, 0.3);
        const auto some = [&] {
            Eigen::ArrayXd a(grid.cells());
            for (double& value : a) value = normal(random);
            return a;
        };
        problem.gap += 0.1 * some();
        const Eigen::ArrayXd a = some(), b = some();
        Eigen::ArrayXd of_a, of_b;
        wheel->set_surface(problem);
        wheel->apply(a, problem.coverage, of_a);
        wheel->apply(b, problem.coverage, of_b);
        EXPECT_NEAR((a * of_b).sum(), (b * of_a).sum(), 1e-5 * (a * of_a).sum());
        EXPECT_GT((a * of_a).sum(), 0.0);
    }
}

// A crowned rim on a plane: the crown is the wheel's and moves along, so that the rubber beside the
// middle meets the same plane wherever it has moved to.
TEST(Displaced, AWheelsOwnProfileMovesAlongWithIt) {
    const ContactGrid grid{40, 31, 1.0, 30.0 / 31};
    const auto wheel = rubber().compliance(grid);
    for (const double slope : {0.0, 0.1}) {
        ContactProblem plain = tilted(grid, slope), crowned = plain;
        crowned.drop.resize(grid.ny);
        for (int j = 0; j < grid.ny; ++j) {
            crowned.drop[j] = grid.y(j) * grid.y(j) / 120.0;
            crowned.gap.segment(j * grid.nx, grid.nx) += crowned.drop[j];
        }
        Eigen::ArrayXd of_plain, of_crowned, without;
        wheel->set_surface(plain);
        wheel->apply(plain.coverage, plain.coverage, of_plain);
        wheel->set_surface(crowned);
        wheel->apply(plain.coverage, plain.coverage, of_crowned);
        EXPECT_LT((of_crowned - of_plain).abs().maxCoeff(), 1e-9);
        crowned.drop.resize(0);
        wheel->set_surface(crowned);
        wheel->apply(plain.coverage, plain.coverage, without);
        EXPECT_GT((without - of_plain).abs().maxCoeff(), 1e-3);
    }
    ContactProblem wrong = tilted(grid, 0.1);
    wrong.drop = Eigen::ArrayXd::Zero(3);
    EXPECT_THROW(wheel->solve(wrong), InputError);
}

TEST(Displaced, TheForceStaysAndAMirroredContactIsTheMirrorImage) {
    const ContactGrid grid{40, 31, 1.0, 30.0 / 31};
    const auto wheel = rubber().prepare(grid);
    const ContactProblem problem = tilted(grid, kTilt), mirrored = tilted(grid, -kTilt);
    const ContactSolution one = wheel->solve(problem), other = wheel->solve(mirrored);
    ASSERT_TRUE(one.converged && other.converged);
    EXPECT_NEAR(one.approach, other.approach, 1e-9);
    for (int j = 0; j <= grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i)
            EXPECT_NEAR(one.axial(i, j), -other.axial(i, grid.ny - j), 1e-7);
    }
    const auto place = [&](const ContactSolution& solution) {
        return displaced(grid, solution, problem.coverage);
    };
    const DisplacedPressure at = place(one), mirror = place(other);
    EXPECT_NEAR(force_of(grid, at, problem.coverage), problem.force, 1e-9 * problem.force);
    const Eigen::Index nx = grid.nx;
    EXPECT_EQ(at.reach.head(nx).maxCoeff(), 0.0);
    EXPECT_GT(at.reach.tail(nx).maxCoeff(), 0.2);
    EXPECT_LT((at.beside.tail(nx) - mirror.beside.head(nx)).abs().maxCoeff(), 1e-5);
    // Put closer together, it is as much.
    const DisplacedPressure close = displaced(grid, one, problem.coverage, 0.05);
    EXPECT_NEAR(force_of(grid, close, problem.coverage), problem.force, 1e-9 * problem.force);
    EXPECT_EQ(close.longest(), 0.05);
}

// Rubber that moves far along the axis, over a narrow piece of work: what is pressed stays on it.
TEST(Displaced, NothingIsPressedWhereThereIsNoWork) {
    const ContactGrid grid{3, 12, 1.0, 1.0};
    Eigen::ArrayXd coverage = Eigen::ArrayXd::Zero(grid.cells());
    ContactSolution solution;
    solution.pressure = Eigen::ArrayXd::Zero(grid.cells());
    for (int j = 3; j <= 7; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            coverage[j * grid.nx + i] = j == 3 ? 1e-6 : 1.0;
            solution.pressure[j * grid.nx + i] = 0.1 + 0.05 * j;
        }
    }
    const double force = (solution.pressure * coverage).sum() * grid.cell_area();
    for (const double far : {0.3, 2.5, -2.5, 40.0, -40.0}) {
        solution.axial = Eigen::ArrayXXd::Constant(grid.nx, grid.ny + 1, far);
        const DisplacedPressure at = displaced(grid, solution, coverage, 1.0);
        EXPECT_TRUE(at.pressure.isFinite().all());
        EXPECT_EQ((coverage == 0.0).select(at.pressure, 0.0).maxCoeff(), 0.0) << far;
        EXPECT_EQ(at.pressure.segment(3 * grid.nx, grid.nx).maxCoeff(), solution.pressure[9]);
        EXPECT_NEAR(force_of(grid, at, coverage), force, 1e-12 * force) << far;
    }
}

TEST(Displaced, ABulgeThatMeetsARisingSurfaceBearsMoreAndABeltHoldsItBack) {
    const ContactGrid grid{40, 30, 1.0, 1.0};
    const ContactProblem problem = tilted(grid, kTilt);
    const auto wheel = rubber().compliance(grid);
    const ContactSolution solution = wheel->solve(problem);
    Eigen::ArrayXd with, without;
    wheel->apply(solution.pressure, problem.coverage, without);
    wheel->set_surface(problem);
    wheel->apply(solution.pressure, problem.coverage, with);
    const double p = solution.pressure.sum();
    EXPECT_LT((solution.pressure * with).sum() / p, 0.98 * (solution.pressure * without).sum() / p);
    const auto belted = rubber({2.0, 20.0}).compliance(grid);
    EXPECT_EQ(belted->solve(problem).axial.size(), 0);
    EXPECT_EQ(rubber({2.0, 20.0}).beside(), 0.0);
}

TEST(Displaced, WhatBulgesTakesFromSamplesBeyondTheSideFaceAndTheVolumeIsKept) {
    HeightField field = testing::plate(60.0, 60.0, 0.2);
    const std::vector<double> before = field.height;
    const ContactWheel wheel{80.0, 20.0, 0.0};
    Frame pose = Frame::Identity();
    pose.linear() = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
    pose.translation() = Vec3(30.0, 30.1, 0.0) /* its sides lie between samples */;
    SampleBlocks blocks(field);
    GapMap map(wheel, 1.0, 1.0);
    map.update(blocks, testing::all_of(blocks), pose, 0.5);
    const ContactGrid& grid = map.grid();
    const Eigen::ArrayXd rate = (map.gap() < 0.1).select(Eigen::ArrayXd::Ones(grid.cells()), 0.0);
    DisplacedPressure pressure;
    pressure.pressure = rate;
    pressure.beside.setZero(2 * grid.nx);
    pressure.reach.setZero(2 * grid.nx);
    for (int i = 0; i < grid.nx; ++i) {
        if (std::abs(grid.s(i)) > 4.0) continue;
        pressure.beside[grid.nx + i] = 1.0;  // at +y of the wheel, which is -y of the work
        pressure.reach[grid.nx + i] = 0.8;
    }
    map.reach_beside(pressure);
    const double asked = map.volume_rate(rate, pressure.beside);
    EXPECT_NEAR(asked,
                (rate * map.coverage()).sum() * grid.cell_area() + pressure.reach.sum() * grid.ds,
                1e-9);
    const double volume = map.remove(blocks, rate, pressure.beside, 0.01, 1.0);
    field.height = blocks.heights();
    double removed = 0.0, beyond = 0.0, wrong = 0.0;
    for (std::size_t k = 0; k < field.size(); ++k) {
        const double lost = field.area[k] * (before[k] - field.height[k]);
        removed += lost;
        if (field.point[k].y() < 20.1) beyond += lost;
        if (field.point[k].y() > 40.1 + field.spacing || field.point[k].y() < 19.2) wrong += lost;
    }
    EXPECT_NEAR(removed, volume, 1e-9 * volume);
    EXPECT_NEAR(volume, 0.01 * asked, 1e-9 * volume);
    EXPECT_NEAR(beyond, 0.01 * pressure.reach.sum() * grid.ds, 0.1 * beyond);
    EXPECT_EQ(wrong, 0.0);
}

}  // namespace
}  // namespace beltgrinding

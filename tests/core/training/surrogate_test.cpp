#include "surrogate/surrogate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "beltgrinding/error.h"
#include "elastic/compliance.h"
#include "training/train_regression.h"

namespace beltgrinding {
namespace {

const ContactGrid kGrid{33, 24, 1.0, 1.0};

TEST(Regression, LearnsASmoothFunctionOfFewVariables) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto truth = [](const Eigen::VectorXf& x) { return 5.0f + std::sin(2 * x[0]) * x[1]; };
    Eigen::MatrixXf x(2, 400), unseen(2, 100);
    for (float& v : x.reshaped()) v = uniform(random);
    for (float& v : unseen.reshaped()) v = 0.8f * uniform(random);
    Eigen::VectorXf y(400);
    for (int k = 0; k < 400; ++k) y[k] = truth(x.col(k));
    const TrainedRegression regression = train_regression(x, y, {100.0, 0.5, 0.01});
    const Eigen::VectorXf found = regression.predict(unseen);
    for (int k = 0; k < 100; ++k) EXPECT_NEAR(found[k], truth(unseen.col(k)), 0.02);
}

TEST(Regression, RefusesWhatItCannotLearn) {
    const Eigen::MatrixXf x = Eigen::MatrixXf::Random(2, 30);
    Eigen::VectorXf y = Eigen::VectorXf::Ones(30);
    EXPECT_THROW(train_regression(x, y, {}), InputError);  // all the same
    y[3] = NAN;
    EXPECT_THROW(train_regression(x, y, {}), InputError);
    EXPECT_THROW(train_regression(x.leftCols(5), Eigen::VectorXf::Random(5), {}), InputError);
    EXPECT_THROW(train_regression(x, Eigen::VectorXf::Random(30), {-1.0, 0.1, 0.1}), InputError);
}

/// The gap of a wheel on a sphere-like bump, random in size and place.
ContactProblem bump(double radius, double s, double y) {
    ContactProblem problem;
    problem.gap.resize(kGrid.cells());
    for (int j = 0; j < kGrid.ny; ++j) {
        for (int i = 0; i < kGrid.nx; ++i) {
            const double u = kGrid.s(i) - s, v = kGrid.y(j) - y;
            problem.gap[j * kGrid.nx + i] = (u * u + v * v) / (2 * radius);
        }
    }
    problem.coverage = Eigen::ArrayXd::Ones(kGrid.cells());
    return problem;
}

TEST(Surrogate, LearnsAnElasticFoundationAndHoldsTheForce) {
    const auto foundation = ElasticFoundation(0.7).prepare(kGrid);
    const ContactFeatures features{1.0, 4.0};
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<Eigen::MatrixXf> seen;
    std::vector<float> targets;
    for (int k = 0; k < 60; ++k) {
        ContactProblem problem =
            bump(20 + 80 * uniform(random), 6 * uniform(random) - 3, 16 * uniform(random) - 8);
        problem.force = 2 + 20 * uniform(random);
        const ContactSolution solution = foundation->solve(problem);
        const auto cells = features.candidates(kGrid, problem, solution.approach);
        seen.push_back(features.of(kGrid, problem, solution.approach, cells));
        for (const int cell : cells) {
            targets.push_back(static_cast<float>(solution.pressure[cell] /
                                                 (solution.approach - problem.gap.minCoeff())));
        }
    }
    Eigen::MatrixXf all(features.size(), static_cast<Eigen::Index>(targets.size()));
    Eigen::Index column = 0;
    for (const auto& part : seen) {
        all.middleCols(column, part.cols()) = part;
        column += part.cols();
    }
    const Surrogate model(
        features,
        train_regression(all, Eigen::Map<Eigen::VectorXf>(targets.data(), all.cols()),
                         {10.0, 0.02, 0.02}),
        "test");
    const auto surrogate = model.prepare(kGrid);
    ContactProblem problem = bump(45, 1.3, 2.4);
    problem.force = 12;
    const ContactSolution truth = foundation->solve(problem), found = surrogate->solve(problem);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.force, 12, 1e-9);
    EXPECT_NEAR(found.approach, truth.approach, 0.02 * truth.approach);
    EXPECT_GE(found.pressure.minCoeff(), 0.0);
    EXPECT_LT((found.pressure - truth.pressure).abs().sum(), 0.04 * truth.pressure.sum());

    // The contact is homogeneous: twice the gap and the approach, twice the pressure.
    problem.force_control = false;
    problem.approach = truth.approach;
    const ContactSolution single = surrogate->solve(problem);
    problem.gap *= 2.0;
    problem.approach *= 2.0;
    const ContactSolution twice = surrogate->solve(problem);
    EXPECT_LT((twice.pressure - 2.0 * single.pressure).abs().maxCoeff(), 1e-4);

    // A robot that gives way stands where its force and the wheel's agree.
    problem.robot_compliance = 0.05;
    const ContactSolution soft = surrogate->solve(problem);
    EXPECT_NEAR(soft.approach + 0.05 * soft.force, problem.approach, 0.01 * problem.approach);

    // Nothing within reach, and an unloaded wheel.
    problem.approach = -1.0;
    EXPECT_EQ(surrogate->solve(problem).force, 0.0);
    problem.force_control = true;
    problem.force = 0.0;
    EXPECT_EQ(surrogate->solve(problem).force, 0.0);
}

TEST(Surrogate, RefusesARegressionOfOtherFeatures) {
    TrainedRegression regression;
    regression.gamma = 0.1;
    EXPECT_THROW(Surrogate({1.0, 4.0}, regression, "test"), InputError);
    EXPECT_THROW(Surrogate({0.0, 4.0}, regression, "test"), InputError);
}

}  // namespace
}  // namespace beltgrinding

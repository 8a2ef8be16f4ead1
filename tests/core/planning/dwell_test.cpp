#include "planning/dwell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/threads.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

/// Passes over a strip: every motion removes on samples around its own, and a little on those of
/// the next pass.
Influence strip(int motions, int around, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> depth(0.02F, 0.06F);
    Influence a;
    for (int j = 0; j < motions; ++j) {
        for (int s = std::max(0, 3 * (j - around)); s < std::min(3 * motions, 3 * (j + around));
             ++s) {
            a.sample.push_back(static_cast<std::uint32_t>(s));
            a.depth.push_back(depth(random));
        }
        a.first.push_back(a.sample.size());
    }
    return a;
}

struct Case {
    Influence influence;
    DwellProblem problem;

    Case(int motions, unsigned seed, double excess = 0.1) : influence(strip(motions, 3, seed)) {
        std::mt19937 random(seed + 1);
        std::uniform_real_distribution<double> uneven(-0.15, 0.15);
        const int samples = 3 * motions;
        problem.influence = &influence;
        problem.excess =
            Eigen::ArrayXd::NullaryExpr(samples, [&] { return excess + uneven(random); });
        problem.half = Eigen::ArrayXd::Constant(samples, 0.05);
        problem.weight = Eigen::ArrayXd::Ones(samples);
        problem.lower = Eigen::ArrayXd::Constant(motions, 0.3);
        problem.upper = Eigen::ArrayXd::Constant(motions, 2.5);
        problem.pace = Eigen::ArrayXd::Constant(motions, 0.02);
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;
};

Eigen::ArrayXd deviations(const DwellProblem& p, const Eigen::ArrayXd& x) {
    Eigen::ArrayXd e = p.excess;
    for (std::size_t j = 0; j < p.influence->motions(); ++j) {
        for (std::size_t k = p.influence->first[j]; k < p.influence->first[j + 1]; ++k) {
            e[p.influence->sample[k]] -=
                p.influence->depth[k] * (x[static_cast<Eigen::Index>(j)] - 1.0);
        }
    }
    return e;
}

/// The cost as the header says it, without smoothing and reweighting.
double cost(const DwellProblem& p, const DwellSettings& s, const Eigen::ArrayXd& x) {
    const Eigen::ArrayXd e = deviations(p, x);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < e.size(); ++i) {
        const double beyond = std::max(0.0, std::abs(e[i]) - s.inner_share * p.half[i]);
        sum += p.weight[i] * (s.inner_cost * e[i] * e[i] + (1.0 - s.inner_cost) * beyond * beyond) /
               2.0;
    }
    return sum / p.weight.sum();
}

DwellSettings plain() {
    DwellSettings s;
    s.smoothing = 0.0;
    s.reweightings = 0;
    return s;
}

TEST(Dwell, IsTheLeastOfAllThatLieWithinTheLimits) {
    // Against projected gradients with small steps, another way altogether.
    for (unsigned seed : {1u, 2u, 3u}) {
        Case one(12, seed, 0.02);
        const DwellSettings settings = plain();
        // No sample may be so far off that it counts less.
        one.problem.half = Eigen::ArrayXd::Constant(one.problem.excess.size(), 10.0);
        DwellSettings narrow = settings;
        narrow.inner_share = 0.003;
        const DwellSolution found = plan_dwell(one.problem, narrow);
        Eigen::ArrayXd x = Eigen::ArrayXd::Ones(12);
        for (int k = 0; k < 60000; ++k) {
            Eigen::ArrayXd g(12);
            for (Eigen::Index j = 0; j < 12; ++j) {
                Eigen::ArrayXd up = x, down = x;
                up[j] += 1e-6;
                down[j] -= 1e-6;
                g[j] = (cost(one.problem, narrow, up) - cost(one.problem, narrow, down)) / 2e-6;
            }
            const Eigen::ArrayXd next =
                (x - 20.0 * g).max(one.problem.lower).min(one.problem.upper);
            const double moved = (next - x).abs().maxCoeff();
            x = next;
            if (moved < 1e-10) break;
        }
        EXPECT_NEAR(found.objective, cost(one.problem, narrow, found.factor), 1e-12);
        EXPECT_LE(found.objective, cost(one.problem, narrow, x) + 1e-9);
        EXPECT_LT((found.factor - x).abs().maxCoeff(), 2e-4);
        EXPECT_LT(found.residual, 1e-6);
    }
}

TEST(Dwell, PaysForTimeUntilDeviationsCostAsMuch) {
    // At the optimum a motion's time costs what its deviations would gain, or its limit.
    Case one(12, 9, 0.02);
    one.problem.half = Eigen::ArrayXd::Constant(one.problem.excess.size(), 10.0);
    one.problem.lower = Eigen::ArrayXd::Constant(12, 1e-3);
    one.problem.upper = Eigen::ArrayXd::Constant(12, 1e3);
    const DwellSettings settings = plain();
    const DwellSolution free = plan_dwell(one.problem, settings);
    one.problem.time_cost = Eigen::ArrayXd::LinSpaced(12, 1e-6, 4e-5);
    const DwellSolution paid = plan_dwell(one.problem, settings);
    EXPECT_LT((one.problem.time_cost * paid.factor).sum(),
              (one.problem.time_cost * free.factor).sum());
    for (Eigen::Index j = 0; j < 12; ++j) {
        Eigen::ArrayXd up = paid.factor, down = paid.factor;
        up[j] += 1e-4;
        down[j] -= 1e-4;
        const double slope =
            (cost(one.problem, settings, up) - cost(one.problem, settings, down)) / 2e-4;
        EXPECT_NEAR(slope + one.problem.time_cost[j], paid.price[j], 1e-9);
    }
}

TEST(Dwell, KeepsItsLimitsAndPricesThem) {
    Case one(40, 5, 0.6);  // far too much left: the slowest feeds everywhere
    const DwellSolution found = plan_dwell(one.problem, plain());
    EXPECT_TRUE((found.factor >= one.problem.lower).all());
    EXPECT_TRUE((found.factor <= one.problem.upper).all());
    EXPECT_GT(found.factor.minCoeff(), 2.5 - 1e-3);
    EXPECT_LT(found.price.maxCoeff(), 0.0);
}

TEST(Dwell, BringsUnevenStockIntoTheBandWhereItCan) {
    Case one(200, 7);
    // What some feeds within the limits leave in the middle of the band can be brought there.
    Eigen::ArrayXd wanted(200);
    for (int j = 0; j < 200; ++j) wanted[j] = 1.3 + 0.8 * std::sin(0.2 * j);
    one.problem.excess.setZero();
    one.problem.excess = -deviations(one.problem, wanted);
    const DwellSolution found = plan_dwell(one.problem, DwellSettings());
    EXPECT_LT(found.excess.abs().maxCoeff(), 0.05);
    EXPECT_GT(one.problem.excess.abs().maxCoeff(), 0.1);
    EXPECT_LT((found.excess - deviations(one.problem, found.factor)).abs().maxCoeff(), 1e-12);
}

TEST(Dwell, LetsGoOfWhatNoMotionCanMend) {
    Case one(100, 9, 0.0);
    one.problem.excess.setConstant(0.04);
    Eigen::ArrayXd hopeless = one.problem.excess;
    for (Eigen::Index i = 7; i < 300; i += 15) hopeless[i] = 3.0;
    one.problem.excess = hopeless;
    one.problem.upper.setConstant(50.0);
    const auto inside = [&](const DwellSettings& settings) {
        return (plan_dwell(one.problem, settings).excess.abs() <= 0.05).count();
    };
    // Without reweighting, what lies round them is cut below the band for nothing.
    EXPECT_GT(inside(DwellSettings()), 270);
    EXPECT_LT(inside(plain()), 200);
}

TEST(Dwell, SmoothingEvensThePace) {
    Case one(60, 11);
    DwellSettings rough, smooth;
    rough.smoothing = 1e-6;
    smooth.smoothing = 1.0;
    const auto steps = [&](const DwellSettings& settings) {
        const Eigen::ArrayXd x = plan_dwell(one.problem, settings).factor;
        return (x.tail(59) - x.head(59)).square().sum();
    };
    EXPECT_LT(steps(smooth), 0.5 * steps(rough));
}

TEST(Dwell, LeavesGivenMotionsAndThoseThatRemoveNothing) {
    Case one(20, 13);
    one.problem.lower[4] = one.problem.upper[4] = 1.0;
    one.problem.lower[5] = one.problem.upper[5] = 2.0;          // given, and other than it was
    one.influence.first.push_back(one.influence.first.back());  // removes nothing
    for (Eigen::ArrayXd* a : {&one.problem.lower, &one.problem.upper, &one.problem.pace}) {
        a->conservativeResize(21);
        (*a)[20] = (*a)[19];
    }
    const DwellSolution found = plan_dwell(one.problem, DwellSettings());
    EXPECT_EQ(found.factor[4], 1.0);
    EXPECT_EQ(found.factor[5], 2.0);
    EXPECT_EQ(found.factor[20], 1.0);
    EXPECT_LT((found.excess - deviations(one.problem, found.factor)).abs().maxCoeff(), 1e-12);
}

TEST(Dwell, IsTheSameOnAnyNumberOfThreads) {
    Case one(300, 17);
    Eigen::ArrayXd first;
    for (const std::size_t threads : {1u, 2u, 5u}) {
        set_threads(threads);
        const Eigen::ArrayXd x = plan_dwell(one.problem, DwellSettings()).factor;
        if (first.size() == 0) first = x;
        EXPECT_TRUE((x == first).all()) << threads;
    }
    set_threads(0);
}

TEST(Dwell, RefusesWhatDoesNotFit) {
    Case one(5, 19);
    one.problem.half[2] = 0.0;
    EXPECT_THROW(plan_dwell(one.problem, DwellSettings()), InputError);
    one.problem.half[2] = 0.05;
    one.problem.upper[1] = 0.1;
    EXPECT_THROW(plan_dwell(one.problem, DwellSettings()), InputError);
    one.problem.upper = one.problem.lower;
    EXPECT_THROW(plan_dwell(one.problem, DwellSettings()), InputError);
    Case two(5, 19);
    DwellSettings few;
    few.iterations = 1;
    EXPECT_THROW(plan_dwell(two.problem, few), InputError);
    RunContext context;
    context.cancel();
    EXPECT_THROW(plan_dwell(two.problem, DwellSettings(), context), Cancelled);
}

}  // namespace
}  // namespace beltgrinding

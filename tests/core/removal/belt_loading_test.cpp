// A belt that loads with chips: its closed forms, and that they do not depend on the steps.
#include <gtest/gtest.h>

#include <cmath>

#include "beltgrinding/belt_wear.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

BeltWear::Parameters loading(double share,
                             BeltWear::Variable variable = BeltWear::Variable::kWork) {
    BeltWear::Parameters p;
    p.variable = variable;
    p.loading_share = share;
    p.loading_scale = 200.0;
    p.loading_recovery = 40.0;
    return p;
}

TEST(BeltLoading, TakesItsShareOfWhatTheWearLeaves) {
    BeltWear::Parameters p = loading(0.3);
    p.model = BeltWear::Model::kExponential;
    p.scale = 1000.0;
    p.rest = 0.2;
    const BeltState state{500.0, 0.0, 0.0, 0.6};
    EXPECT_NEAR(BeltWear(p).remaining(state), (0.2 + 0.8 * std::exp(-0.5)) * (1.0 - 0.3 * 0.6),
                1e-15);
    p.loading_share = 0.0;
    EXPECT_EQ(BeltWear(p).remaining(state), 0.2 + (1.0 - 0.2) * std::exp(-0.5));
    EXPECT_FALSE(BeltWear(p).loads());
}

TEST(BeltLoading, FollowsItsClosedFormsInAnySteps) {
    const BeltWear wear(loading(0.3));
    const double start = 0.25, work = 310.0, seconds = 55.0;
    const double whole = 1.0 - (1.0 - start) * std::exp(-work / 200.0);
    EXPECT_NEAR(wear.loaded(start, work, 1e9), whole, 1e-15);
    EXPECT_NEAR(wear.recovered(start, seconds), start * std::exp(-seconds / 40.0), 1e-15);
    for (const int steps : {1, 7, 1000}) {
        double loaded = start, recovered = start, mean = 0.0;
        for (int k = 0; k < steps; ++k) {
            mean += wear.mean_loading(loaded, work / steps, 0.0) / steps;
            loaded = wear.loaded(loaded, work / steps, 0.0);
            recovered = wear.recovered(recovered, seconds / steps);
        }
        EXPECT_NEAR(loaded, whole, 1e-12) << steps;
        EXPECT_NEAR(recovered, wear.recovered(start, seconds), 1e-12) << steps;
        // The integral of 1 - (1 - l) exp(-W / scale) over W, by work.
        const double integral = 1.0 - (1.0 - start) * (1.0 - std::exp(-1.55)) / 1.55;
        EXPECT_NEAR(mean, integral, 1e-12) << steps;
    }
}

TEST(BeltLoading, FollowsTheVolumeThatItRemovesItself) {
    const double start = 0.1;
    for (const double share : {0.01, 0.4, 0.999, 1.0}) {
        const BeltWear wear(loading(share, BeltWear::Variable::kVolume));
        for (const double fresh : {1e-3, 30.0, 700.0, 5e4, 1e7}) {  // mm3, of an unloaded belt
            // dV/dt = 1 - share l(V), l = 1 - (1 - start) exp(-V / 200): t(V) is known.
            const double mean = wear.mean_loading(start, 0.0, fresh);
            const double removed = fresh * (1.0 - share * mean);
            const double a = 1.0 - share, b = share * (1.0 - start);
            double time = 0.0;
            if (a > 0.0) {
                const double v = removed / 200.0;
                time = 200.0 * (v + std::log((a + b * std::exp(-v)) / (a + b))) / a;
            } else {
                time = 200.0 * std::expm1(removed / 200.0) / b;
            }
            EXPECT_NEAR(time, fresh, 1e-7 * fresh) << share << ' ' << fresh;
            double taken = 0.0, loaded = start;
            for (int k = 0; k < 100; ++k) {
                const double part = fresh / 100.0;
                const double one = part * (1.0 - share * wear.mean_loading(loaded, 0.0, part));
                loaded = wear.loaded(loaded, 0.0, one);
                taken += one;
            }
            EXPECT_NEAR(taken, removed, 1e-9 * fresh + 1e-9 * removed) << share << ' ' << fresh;
        }
    }
}

TEST(BeltLoading, StaysWhereNothingIsDoneAndWithinItsBounds) {
    for (const auto variable : {BeltWear::Variable::kWork, BeltWear::Variable::kVolume}) {
        BeltWear::Parameters p = loading(0.5, variable);
        p.loading_recovery = 0.0;
        const BeltWear wear(p);
        EXPECT_EQ(wear.recovered(0.4, 1e9), 0.4);
        EXPECT_EQ(wear.mean_loading(0.4, 0.0, 0.0), 0.4);
        EXPECT_EQ(wear.loaded(0.4, 0.0, 0.0), 0.4);
        EXPECT_NEAR(wear.mean_loading(0.4, 1e12, 1e12), 1.0, 1e-9);
        EXPECT_EQ(wear.mean_loading(1.0, 50.0, 50.0), 1.0);
        EXPECT_EQ(wear.loaded(0.4, 1e12, 1e12), 1.0);
    }
}

TEST(BeltLoading, RefusesWhatCannotBe) {
    const auto refused = [](auto change) {
        BeltWear::Parameters p = loading(0.3);
        change(p);
        EXPECT_THROW(BeltWear{p}, InputError);
    };
    refused([](auto& p) { p.loading_share = 1.1; });
    refused([](auto& p) { p.loading_share = -0.1; });
    refused([](auto& p) { p.loading_share = std::nan(""); });
    refused([](auto& p) { p.loading_scale = 0.0; });
    refused([](auto& p) { p.loading_recovery = -1.0; });
    refused([](auto& p) { p.loading_recovery = HUGE_VAL; });
    for (const double value : {-0.1, 1.1, static_cast<double>(NAN)})
        EXPECT_THROW((BeltState{0.0, 0.0, 0.0, value}.validate()), InputError);
}

}  // namespace
}  // namespace beltgrinding

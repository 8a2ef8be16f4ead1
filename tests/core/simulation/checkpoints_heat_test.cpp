// Heat and finish, which a checkpoint holds as well: to the last bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "simulation/checkpointed.h"

namespace beltgrinding {
namespace {

using namespace testing;

constexpr HeatMaterial kSteel = {15.0, 500.0, 7900.0}, kAluminium = {191.0, 911.0, 2700.0};

Setting heated(const HeatMaterial& material) {
    Setting s = setting();
    s.heat = material;
    s.options.heat.friction = 0.5;
    s.options.heat.partition = 0.7;
    s.options.heat.low = 0.6;
    s.options.heat.high = 1.4;
    s.options.heat.burn = 60.0;
    return s;
}

void want_finish(Setting& s) {
    s.options.finish.wanted = true;
    s.options.finish.roughness = 0.8;
    s.options.finish.pressure_exponent = 0.4;
    s.options.finish.feed_exponent = 0.2;
    s.options.finish.rest = 0.3;
    s.options.finish.before = 3.2;
}

TEST(Checkpoints, HeatThatSpreadsSlowly) {
    const Setting s = heated(kSteel);
    const std::vector<std::string> events = run(s, passes(), nullptr).events;
    EXPECT_GT(std::count(events.begin(), events.end(), "burn_risk"), 1);
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, HeatThatSpreadsFastThroughSectionsOfAnyThickness) {
    Setting s = heated(kAluminium);
    s.options.heat.burn = 22.0;
    for (const float thickness : {0.5F, 5.0F, HUGE_VALF}) {
        s.thickness = thickness;
        expect_the_same_from_checkpoints(s);
    }
}

// Sections whose other side is ground as well: heat comes from behind.
TEST(Checkpoints, HeatFromTheOtherSide) {
    Setting s = heated(kSteel);
    s.thickness = 1.5F;
    s.field = [] {
        HeightField both = testing::plate(kLength, kWidth, 1.0, 0.2);
        const HeightField top = both;
        both.resize(2 * top.size());
        for (std::size_t k = 0, n = top.size(); k < n; ++k) {
            both.point[n + k] = top.point[k] - Vec3(0.0, 0.0, 1.5);
            both.normal[n + k] = -top.normal[k];
            both.area[n + k] = top.area[k];
            both.height[n + k] = top.height[k];
        }
        return both;
    };
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, APartThatRestsBetweenItsPasses) {
    Setting s = heated(kAluminium);
    std::vector<PathPose> poses = passes();
    for (std::size_t k = 4; k < poses.size(); k += 5) poses[k].feed = 0.5;
    Checkpoints kept(kPlenty);
    const Ground whole = run(s, poses, &kept);
    poses[22].feed = 21.0;
    const Ground quick = run(s, poses, &kept);
    EXPECT_GT(quick.resumed, 0u);
    EXPECT_FALSE(quick.outcome == whole.outcome);
    EXPECT_TRUE(quick.outcome == run(s, poses, nullptr).outcome);
}

TEST(Checkpoints, TheFinishThatPassesLeave) {
    Setting s = setting();
    want_finish(s);
    expect_the_same_from_checkpoints(s);
    s.options.finish.feed = {30.0, 45.0};  // outside, some passes have none
    s.options.finish.roughness = 0.0;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, HeatAndFinishWithAForceThatLags) {
    Setting s = heated(kSteel);
    want_finish(s);
    s.options.process.dynamics.lag = 0.05;
    s.records = true;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, HeatAndFinishWhereNeighboursBecomeOne) {
    Setting s = heated(kAluminium);
    want_finish(s);
    Checkpoints kept(kPlenty);
    run(s, passes(), &kept);
    const std::size_t some = kept.bytes() / 2;
    Checkpoints fewer(some);
    run(s, passes(), &fewer);
    ASSERT_GT(fewer.count(), 0u);
    EXPECT_LT(fewer.count(), kept.count());
    EXPECT_LE(fewer.bytes(), some);
    expect_the_same_from_checkpoints(s, some);
}

// Each program goes on with the heat and the finish that the ones before it have left.
TEST(Checkpoints, HeatAndFinishOfSeveralPrograms) {
    Setting s = heated(kAluminium);
    want_finish(s);
    std::vector<std::vector<PathPose>> programs(3, passes());
    const auto run_all = [&](std::vector<Checkpoints>* kept, std::vector<std::size_t>* resumed) {
        Workpiece work(s);
        std::vector<Outcome> outcomes;
        bool same = true;
        Setting one = s;
        for (std::size_t k = 0; k < programs.size(); ++k) {
            if (kept != nullptr && !same) (*kept)[k].clear();
            one.options.outputs.first_motion = 100 * k;
            const Ground ground =
                run(one, work, programs[k], kept != nullptr ? &(*kept)[k] : nullptr);
            same = same && ground.unchanged;
            outcomes.push_back(ground.outcome);
            if (resumed != nullptr) resumed->push_back(ground.resumed);
        }
        return outcomes;
    };
    std::vector<Checkpoints> kept(3, Checkpoints(kPlenty));
    const auto first = run_all(&kept, nullptr);
    EXPECT_TRUE(first == run_all(nullptr, nullptr));
    std::vector<std::size_t> resumed;
    EXPECT_TRUE(first == run_all(&kept, &resumed));
    for (const std::size_t steps : resumed) EXPECT_GT(steps, 0u);
    for (const std::size_t at : {std::size_t{1}, std::size_t{2}}) {
        programs[at][20].feed *= 1.4;
        resumed.clear();
        const auto quick = run_all(&kept, &resumed);
        EXPECT_GT(resumed[at], 0u);
        EXPECT_FALSE(quick[at] == first[at]);
        EXPECT_TRUE(quick == run_all(nullptr, nullptr)) << at;
    }
}

TEST(Checkpoints, OfHeatAndFinishAreNoneOfARunWithout) {
    const Setting plain = setting();
    Setting both = heated(kSteel);
    want_finish(both);
    Checkpoints kept(kPlenty);
    run(both, passes(), &kept);
    for (const bool heat : {false, true}) {
        Setting other = heat ? heated(kSteel) : plain;
        Checkpoints copy = kept;
        EXPECT_EQ(run(other, passes(), &copy).resumed, 0u);
        EXPECT_GT(run(other, passes(), &copy).resumed, 0u);
        EXPECT_EQ(run(both, passes(), &copy).resumed, 0u);
    }
}

}  // namespace
}  // namespace beltgrinding

// A simulation that goes on from a checkpoint against one from the start, to the last bit: over all
// that a step may leave to the next, and over where a path may change.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "beltgrinding/error.h"
#include "elastic/compliance.h"
#include "simulation/checkpointed.h"

namespace beltgrinding {
namespace {

using namespace testing;

TEST(Checkpoints, ForceControl) {
    expect_the_same_from_checkpoints(setting());
}

TEST(Checkpoints, EdgesThatPressInEachPass) {
    Setting s = setting();
    s.tilt = 0.06;
    const std::vector<std::string> events = run(s, passes(s.tilt), nullptr).events;
    EXPECT_GT(std::count(events.begin(), events.end(), "edge_contact"), 2);
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, PositionControlOfARigidAndOfASpringyRobot) {
    Setting s = setting();
    s.options.process.force_control = false;
    expect_the_same_from_checkpoints(s);
    s.options.process.robot_stiffness = 80.0;
    s.options.process.wheel_growth = 0.05;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, ARigidTool) {
    Setting s = setting();
    s.wheel.model = "geometric";
    s.options.process.force_control = false;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, AForceThatLagsAndAWheelThatMoves) {
    Setting s = setting();
    s.options.process.dynamics.lag = 0.05;
    s.options.limits.overshoot = 0.02;
    s.options.limits.bounce = 0.5;
    expect_the_same_from_checkpoints(s);
    s.options.process.dynamics = {0.02, 2e-3, 0.2, 400.0};  // slow: few time steps
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, WheelsThatAreElasticAsAWhole) {
    Setting s = setting();
    s.wheel.model = "half_space";
    expect_the_same_from_checkpoints(s);
    s.made.reset();
    s.wheel.model = "wheel_rim";
    s.wheel.rim_thickness = 10.0;
    s.options.process.wheel.profile = {{-4.0, 0.15}, {0.0, 0.0}, {4.0, 0.1}};
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, BeltsThatRunFreeOrOverAPlaten) {
    Setting s = setting();
    s.options.process.force = 6.0;
    s.options.process.machine.belt.width = 8.0;
    s.options.process.machine.run.length = 90.0;
    s.options.process.machine.platen.length = 50.0;
    s.options.process.machine.platen.layers = {{4.0, 2.0, 0.4}};
    s.options.resolution.contact_spacing = 2.0;
    s.options.resolution.max_travel = 6.0;
    s.options.resolution.max_angle = 0.3;
    for (const auto kind : {BeltMachine::Kind::kFreeBelt, BeltMachine::Kind::kPlaten}) {
        s.made.reset();
        s.options.process.machine.kind = kind;
        expect_the_same_from_checkpoints(s);
    }
    s.made.reset();
    s.options.process.machine.platen.radius = 60.0;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, BeltsThatWear) {
    Setting s = setting();
    BeltWear::Parameters wear;
    wear.model = BeltWear::Model::kExponential;
    wear.scale = 500.0;
    s.options.process.wear = BeltWear(wear);
    s.options.process.belt.work = 40.0;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, BeltsThatLoadAndRecover) {
    Setting s = setting();
    BeltWear::Parameters wear;
    wear.loading_share = 0.4;
    wear.loading_scale = 300.0;
    wear.loading_recovery = 0.5;
    s.options.process.belt.loading = 0.7;
    s.options.process.pause = 0.2;
    s.options.process.wear = BeltWear(wear);
    s.options.process.dynamics = {0.02, 2e-3, 0.2, 400.0};  // slow: few time steps
    expect_the_same_from_checkpoints(s);
    wear.variable = BeltWear::Variable::kVolume;
    wear.loading_scale = 1.0;
    s.options.process.wear = BeltWear(wear);
    s.options.process.dynamics = {};
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, StepsThatAreCut) {
    Setting s = setting();
    s.coefficient = 2e-4;
    s.options.resolution.max_travel = 4.0;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, GrindingDeeperThanTheSegmentsReach) {
    Setting s = setting();
    s.field = [] {
        HeightField field = testing::plate(kLength, kWidth, 1.0, 0.05);
        field.depth = 0.02;
        return field;
    };
    s.coefficient = 5e-5;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, AFieldThatWasGroundBefore) {
    Setting s = setting();
    s.field = [] {
        HeightField field = testing::cylinder(80.0, kLength, kWidth, 1.0, 0.2);
        field.trace.reset(field.size());
        std::fill(field.trace.first.begin(), field.trace.first.end(), 3u);
        std::fill(field.trace.last.begin(), field.trace.last.end(), 5u);
        std::fill(field.trace.dominant.begin(), field.trace.dominant.end(), 4u);
        return field;
    };
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, RobotsThatRoundCornersAndTakeTimeToSpeedUp) {
    Setting s = setting();
    s.time.timing = TimeLaw::Timing::kTrapezoidal;
    s.time.default_zone = 2.0;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, WhatIsKeptBesides) {
    Setting s = setting();
    s.options.outputs.influence = s.options.outputs.force_influence = true;
    for (const double factor : {1.1, 0.8})
        s.options.outputs.shifted_laws.push_back(
            {std::make_shared<LocalLaw>(LocalLawParameters{factor * s.coefficient})});
    s.records = true;
    expect_the_same_from_checkpoints(s);
    s.recorded_bytes = 20'000;  // frames become fewer on the way, more than once
    expect_the_same_from_checkpoints(s);
    s.options.outputs.trace = false;
    s.options.outputs.influence = false;
    expect_the_same_from_checkpoints(s);
}

TEST(Checkpoints, NeighboursBecomeOneWhereTheyWouldTakeTooMuch) {
    Setting s = setting();
    s.records = s.options.outputs.influence = true;
    Checkpoints kept(kPlenty);
    run(s, passes(), &kept);
    ASSERT_GT(kept.count(), 8u);
    ASSERT_LE(kept.count(), Checkpoints::kMost);
    const std::size_t some = kept.bytes() * 6 / 10;
    Checkpoints fewer(some);
    run(s, passes(), &fewer);
    EXPECT_LT(fewer.count(), kept.count());
    EXPECT_LE(fewer.bytes(), some);
    expect_the_same_from_checkpoints(s, some);
    Checkpoints few = kept.within(some);
    EXPECT_LE(few.bytes(), some);
    EXPECT_EQ(kept.within(kPlenty).count(), kept.count());
    std::vector<PathPose> changed = passes();
    changed[20].feed += 1.0;
    const Ground quick = run(s, changed, &few);
    EXPECT_GT(quick.resumed, 0u);
    EXPECT_TRUE(quick.outcome == run(s, changed, nullptr).outcome);
    Checkpoints none(100);
    run(s, passes(), &none);
    EXPECT_EQ(none.count(), 0u);
}

TEST(Checkpoints, AChangeNearTheEndTakesMostFromBefore) {
    const Setting s = setting();
    std::vector<PathPose> poses = passes();
    Checkpoints kept(kPlenty);
    const Ground whole = run(s, poses, &kept);
    const auto steps = kept.steps();
    EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
    poses[poses.size() - 2].force = 25.0;
    Checkpoints late = kept;
    EXPECT_GT(run(s, poses, &late).resumed, whole.steps * 8 / 10);
    EXPECT_EQ(late.count(), kept.count());
    poses[1].feed += 1.0;  // the first motion
    EXPECT_EQ(run(s, poses, &late).resumed, 0u);
}

TEST(Checkpoints, AreOfOneKindOfRun) {
    Setting s = setting();
    Checkpoints kept(kPlenty);
    run(s, passes(), &kept);
    for (const auto& other : std::vector<std::function<void(Setting&)>>{
             [](Setting& o) { o.options.outputs.first_motion = 0; },
             [](Setting& o) { o.options.outputs.influence = true; },
             [](Setting& o) { o.options.outputs.trace = false; },
             [](Setting& o) { o.records = true; },
             [](Setting& o) {
                 o.field = [] { return testing::plate(kLength, kWidth, 2.0, 0.2); };
             }}) {
        Setting o = s;
        other(o);
        Checkpoints copy = kept;
        const Ground quick = run(o, passes(), &copy);
        EXPECT_EQ(quick.resumed, 0u);
        EXPECT_TRUE(quick.outcome == run(o, passes(), nullptr).outcome);
    }
}

/// Cancels when it has been asked so many times.
class CancellingLaw final : public RemovalLaw {
  public:
    CancellingLaw(LocalLawParameters parameters, RunContext context, int times)
        : law_(parameters), context_(std::move(context)), left_(times) {}
    void rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
              Eigen::ArrayXd& rate) const override {
        if (--left_ == 0) context_.cancel();
        law_.rate(pressure, state, rate);
    }
    std::string describe() const override { return law_.describe(); }

  private:
    LocalLaw law_;
    RunContext context_;
    mutable int left_;
};

TEST(Checkpoints, AreSoundAfterACancel) {
    const Setting s = setting();
    Checkpoints kept(kPlenty);
    run(s, passes(), &kept);
    std::vector<PathPose> poses = passes();
    poses[14].feed = 20.0;
    HeightField field = s.field();
    SimulationOptions options = s.options;
    options.outputs.checkpoints = &kept;
    const RunContext context;
    const CancellingLaw law({s.coefficient}, context, 120);
    EXPECT_THROW(simulate(field, ToolPath(poses, {}), s.model(), law, options, context), Cancelled);
    EXPECT_EQ(field.height, s.field().height);
    EXPECT_LT(context.progress(), 0.3);  // of what there was left to do
    EXPECT_GT(kept.count(), 0u);
    const Ground after = run(s, poses, &kept);
    EXPECT_GT(after.resumed, after.steps / 2);
    EXPECT_FALSE(after.unchanged);
    EXPECT_TRUE(after.outcome == run(s, poses, nullptr).outcome);
}

}  // namespace
}  // namespace beltgrinding

// A simulation that goes on from a checkpoint against one from the start, to the last bit: over all
// that a step may leave to the next, and over where a path may change.

#include "simulation/checkpoints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "beltgrinding/contact_factory.h"
#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "contact/compliance.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr std::size_t kPlenty = std::size_t{1} << 30;
constexpr double kLength = 40.0, kWidth = 24.0;  // mm

/// All that goes into a simulation.
struct Setting {
    std::function<HeightField()> field = [] {
        HeightField plate = testing::plate(kLength, kWidth, 1.0, 0.2);
        for (std::size_t s = 0; s < plate.size(); s += 37) plate.flags[s] |= kMissed;
        return plate;
    };
    ContactModelParameters wheel;
    SimulationOptions options;
    double coefficient = 3e-6;  // mm2/N
    TimeLaw time;
    bool records = false;
    std::size_t recorded_bytes = Recording::kMaxBytes;
    double tilt = 0.0;  // rad, of the wheel about its way

    /// A rim takes seconds to be solved: one for all runs of a setting.
    const ContactModel& model() const {
        const ProcessSettings& process = options.process;
        if (!made && process.machine.free_face()) made = make_belt_contact(process.machine);
        if (!made) made = make_contact_model(wheel, process.wheel, process.force);
        return *made;
    }
    mutable std::shared_ptr<const ContactModel> made;
};

Setting setting() {
    Setting s;
    s.wheel.model = "elastic_foundation";
    s.wheel.stiffness = 0.5;
    s.options.process.wheel = {60.0, 8.0, 0.0};
    s.options.process.force = 30.0;
    s.options.limits.pressure = 0.05;
    s.options.limits.heat = 500.0;
    s.options.limits.orientation_jump = 0.05;
    s.options.limits.tilt = 0.001;
    s.options.limits.lower = {0.15F};
    s.options.outputs.first_motion = 7;
    return s;
}

/// Passes along x, lifted between, across the plate's sides as well. `tilt`: as of a Setting.
std::vector<PathPose> passes(double tilt = 0.0) {
    std::vector<PathPose> poses;
    for (int k = 0; k < 6; ++k) {
        const double y = 3.0 + 3.5 * k, turn = 0.1 * (k % 3);
        const bool back = k % 2 == 1;
        for (const double x : {-2.0, 12.0, 27.0, 42.0}) {
            const double at = back ? kLength - x : x;
            poses.push_back(pressing_down(at, y, 0.15, 30.0 + 5.0 * k, turn));
            poses.back().line = static_cast<int>(poses.size());
        }
        poses.push_back(pressing_down(back ? 0.0 : kLength, y + 1.0, 8.0, 200.0));
        poses.back().rapid = k % 3 != 1;
        if (k == 3) poses.back().force = 0.0;
    }
    for (PathPose& pose : poses) pose.base_from_tcp.rotate(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
    return poses;
}

/// What a simulation gave, as bytes.
class Outcome {
  public:
    Outcome(const SimulationResult& result, const HeightField& field, const Recording* recording) {
        add(field.height);
        const RemovalTrace& trace = field.trace;
        add(trace.first), add(trace.last), add(trace.dominant);
        add(trace.dominant_depth), add(trace.peak_pressure);
        for (const StepRecord& r : result.steps) {
            add(r.time), add(r.pose), add(r.duration), add(r.feed), add(r.force), add(r.approach);
            add(r.deepest_approach), add(r.contact_area), add(r.peak_pressure);
            add(r.removal_rate), add(r.segments);
        }
        for (const Event& e : result.events) {
            text += e.kind + name(e.severity) + e.unit + e.message();
            add(e.pose), add(e.line), add(e.time), add(e.duration), add(e.worst_time), add(e.value);
            add(e.limit), add(e.face);
            for (int k = 0; k < 3; ++k) add(e.point[k]);
        }
        add(result.process_time), add(result.removed_volume), add(result.integrated_rate);
        add(result.belt.work), add(result.belt.volume), add(result.belt.time);
        for (Eigen::Index k = 0; k < result.shifts.size(); ++k) add(result.shifts.data()[k]);
        for (const Influence* one : {&result.influence, &result.force_influence})
            add(one->first), add(one->sample), add(one->depth);
        text += result.model;
        if (recording == nullptr) return;
        text += hdf5_image(*recording, "");
        add(recording->key_frames()), add(recording->bytes());
    }
    bool operator==(const Outcome&) const = default;

  private:
    template <class T>
    void add(const T& value) {
        if constexpr (std::is_arithmetic_v<T>) {
            char bytes[sizeof(T)];
            std::memcpy(bytes, &value, sizeof(T));
            text.append(bytes, sizeof(T));
        } else {
            add(value.size());
            for (const auto& one : value) add(one);
        }
    }
    std::string text;
};

struct Ground {
    Outcome outcome;
    std::size_t steps, resumed;
    bool unchanged;
    std::vector<std::string> events;  // kinds of them
};

Ground run(const Setting& s, const std::vector<PathPose>& poses, Checkpoints* checkpoints) {
    HeightField field = s.field();
    Recording recording(s.recorded_bytes);
    SimulationOptions options = s.options;
    if (s.records) options.outputs.recording = &recording;
    options.outputs.checkpoints = checkpoints;
    const SimulationResult result =
        simulate(field, ToolPath(poses, {}, s.time), s.model(), LocalLaw({s.coefficient}), options);
    Ground ground{Outcome(result, field, s.records ? &recording : nullptr),
                  result.steps.size(),
                  result.resumed,
                  result.unchanged,
                  {}};
    for (const Event& event : result.events) ground.events.push_back(event.kind);
    return ground;
}

using Change = std::function<void(std::vector<PathPose>&, std::size_t)>;
const std::vector<std::pair<const char*, Change>> kChanges = {
    {"feed", [](auto& poses, std::size_t k) { poses[k].feed *= 1.3; }},
    {"force", [](auto& poses, std::size_t k) { poses[k].force = 22.0; }},
    {"place",
     [](auto& poses, std::size_t k) { poses[k].base_from_tcp.pretranslate(Vec3(0.5, 0.3, -0.1)); }},
    {"rapid", [](auto& poses, std::size_t k) { poses[k].rapid = !poses[k].rapid; }},
    {"gone", [](auto& poses, std::size_t k) { poses.erase(poses.begin() + std::ptrdiff_t(k)); }},
    {"added",
     [](auto& poses, std::size_t k) {
         poses.insert(poses.begin() + std::ptrdiff_t(k), pressing_down(20.0, 5.0, 0.1, 40.0));
     }},
    {"cut off", [](auto& poses, std::size_t k) { poses.resize(std::max<std::size_t>(k, 2)); }},
    {"gone on",
     [](auto& poses, std::size_t) { poses.push_back(pressing_down(20.0, 12.0, 0.1, 35.0)); }},
    {"line", [](auto& poses, std::size_t k) { poses[k].line += 100; }},
};

/// Changes everywhere, from the same checkpoints each, and from those of the change before.
void expect_the_same_from_checkpoints(const Setting& s, std::size_t bytes = kPlenty) {
    const std::vector<PathPose> poses = passes(s.tilt);
    Checkpoints kept(bytes);
    const Ground whole = run(s, poses, nullptr);
    const Ground first = run(s, poses, &kept);
    EXPECT_TRUE(first.outcome == whole.outcome);
    EXPECT_EQ(first.resumed, 0u);
    EXPECT_FALSE(first.unchanged);
    ASSERT_GT(kept.count(), 0u);
    EXPECT_LE(kept.bytes(), bytes);
    {
        Checkpoints again = kept;
        const Ground same = run(s, poses, &again);
        EXPECT_TRUE(same.outcome == whole.outcome);
        EXPECT_EQ(same.resumed, whole.steps);
        EXPECT_TRUE(same.unchanged);
    }
    std::mt19937 random(7);
    Checkpoints running = kept;
    std::size_t resumed = 0;
    for (const auto& [name, change] : kChanges) {
        std::vector<PathPose> changed = poses;
        const std::size_t at =
            std::uniform_int_distribution<std::size_t>(0, poses.size() - 1)(random);
        change(changed, at);
        const Ground from_start = run(s, changed, nullptr);
        Checkpoints copy = kept;
        const Ground quick = run(s, changed, &copy);
        EXPECT_TRUE(quick.outcome == from_start.outcome) << name << " at " << at;
        EXPECT_FALSE(quick.unchanged && !(from_start.outcome == whole.outcome)) << name;
        const Ground next = run(s, changed, &running);
        EXPECT_TRUE(next.outcome == from_start.outcome) << name << " at " << at << ", in turn";
        resumed += quick.resumed;
    }
    EXPECT_GT(resumed, 0u);
}

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
            std::make_shared<LocalLaw>(LocalLawParameters{factor * s.coefficient}));
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
    const CancellingLaw law({s.coefficient}, context, 60);
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

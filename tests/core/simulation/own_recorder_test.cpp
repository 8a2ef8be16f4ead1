// A recorder of a user's own: in one file, it is told of everything, and goes on from checkpoints.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"
#include "simulation/checkpointed.h"

namespace beltgrinding::testing {
namespace {

/// What the wheel does, in sums.
struct Sums {
    std::size_t steps = 0, touched = 0, removals = 0, changed = 0, ends = 0;
    double pressed = 0.0, removed = 0.0, volume = 0.0;  // s, s, mm3
    bool operator==(const Sums&) const = default;
};

class SumRecorder final : public Keeps<Latest<Sums>, Recorder> {
  public:
    explicit SumRecorder(Sums& given) : Keeps(&PhaseTimes::events), given_(given) {}

    std::string kind() const override { return "sums"; }
    void begin_step(const StepTurn&) override { ++sums_.steps; }
    void touched(const Touch&) override { ++sums_.touched; }
    void pressed(const Press& press) override { sums_.pressed += press.duration; }
    void removed(const Removal& removal) override {
        ++sums_.removals;
        sums_.removed += removal.duration;
    }
    void end_step(const StepEnd& end) override {
        sums_.volume += end.volume;
        sums_.changed += end.changes.size();
    }
    void end() override { ++sums_.ends; }
    void keep(HeightField&, SimulationResult&) override { given_ = sums_; }

  private:
    Latest<Sums> take(std::span<const std::uint32_t>) override { return {sums_}; }
    void put(std::span<const Latest<Sums>* const> parts) override {
        if (!parts.empty()) sums_ = parts.back()->value;
    }

    Sums& given_;
    Sums sums_;
};

struct Watched {
    Sums sums;
    Ground ground;
};

Watched watch(const std::vector<PathPose>& poses, Checkpoints* kept) {
    Setting s = setting();
    Sums sums;
    s.options.outputs.recorders = {
        [&sums](const SampleBlocks&) { return std::make_unique<SumRecorder>(sums); }};
    Ground ground = run(s, poses, kept);
    return {sums, std::move(ground)};
}

TEST(OwnRecorder, IsToldOfEverythingAndChangesNothing) {
    const std::vector<PathPose> poses = passes();
    const Watched watched = watch(poses, nullptr);
    EXPECT_TRUE(watched.ground.outcome == run(setting(), poses, nullptr).outcome);
    const Sums& sums = watched.sums;
    EXPECT_EQ(sums.steps, watched.ground.steps);
    EXPECT_GT(sums.touched, 0u);
    EXPECT_LT(sums.touched, sums.steps);
    EXPECT_GE(sums.removals, sums.touched);
    EXPECT_GT(sums.changed, sums.touched);
    EXPECT_EQ(sums.pressed, sums.removed);
    EXPECT_GT(sums.volume, 0.0);
    EXPECT_EQ(sums.ends, 1u);
}

TEST(OwnRecorder, GoesOnFromACheckpoint) {
    std::vector<PathPose> poses = passes();
    Checkpoints kept(kPlenty);
    watch(poses, &kept);
    ASSERT_GT(kept.count(), 2u);
    poses[poses.size() - 4].feed *= 1.3;
    const Watched whole = watch(poses, nullptr);
    Checkpoints few = kept.within(kept.bytes() - 1);  // neighbours become one
    for (Checkpoints* from : {&few, &kept}) {
        const Watched resumed = watch(poses, from);
        EXPECT_GT(resumed.ground.resumed, 0u);
        EXPECT_LT(resumed.ground.resumed, resumed.ground.steps);
        EXPECT_TRUE(resumed.sums == whole.sums);
        EXPECT_TRUE(resumed.ground.outcome == whole.ground.outcome);
    }
}

TEST(OwnRecorder, StartsAnewWhereTheCheckpointsHaveNone) {
    const std::vector<PathPose> poses = passes();
    Checkpoints kept(kPlenty);
    run(setting(), poses, &kept);
    const Watched watched = watch(poses, &kept);
    EXPECT_EQ(watched.ground.resumed, 0u);
    EXPECT_EQ(watched.sums.steps, watched.ground.steps);
}

}  // namespace
}  // namespace beltgrinding::testing

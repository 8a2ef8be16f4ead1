#include "recorders/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// Steps of random runs of samples that are lowered a little, some of them without any; enough
/// changes for several key frames, and the whole field after each step to compare with.
struct Made {
    HeightField field = testing::plate(10.0, 10.0, 0.2, 0.5);  // `blocks` look at what stays of it
    std::vector<std::vector<float>> truth;
    Recording recording;

    explicit Made(int steps, std::size_t max_bytes = Recording::kMaxBytes) : recording(max_bytes) {
        std::mt19937 random(7);
        remember();
        SampleBlocks blocks(field);
        recording.begin(field, steps, blocks.samples());
        for (int k = 0; k < steps; ++k) {
            blocks.clear_changes();
            for (std::uint32_t s = random() % 500; k % 7 != 3 && s < field.size();
                 s += random() % 50 == 0 ? random() % 90 + 1 : 1) {
                const double depth = 1e-4 * static_cast<double>(1 + random() % 10);
                blocks.lower(s, depth);
                field.height[blocks.sample(s)] -= depth;
            }
            recording.add_step(blocks, blocks.changes(), k + 1.0);
            remember();
        }
        recording.end(blocks);
    }
    void remember() { truth.emplace_back(field.height.begin(), field.height.end()); }
    const std::vector<float>& at(std::size_t frame) const {
        return truth[recording.steps()[frame]];
    }
};

TEST(Recording, HasTheHeightsOfEveryFrameAtAnyJump) {
    const Made made(4000);
    const Recording& r = made.recording;
    ASSERT_EQ(r.last(), 4000u);
    ASSERT_GT(r.key_frames(), 1u);
    EXPECT_EQ(r.heights_at(0), made.truth.front());
    EXPECT_EQ(r.heights_at(r.last()), made.truth.back());
    std::mt19937 random(1);
    std::size_t at = 0;
    std::vector<float> height = r.heights_at(0);
    for (int k = 0; k < 60; ++k) {
        const std::size_t to = k % 3 == 0   ? std::min(at + 1, r.last())
                               : k % 3 == 1 ? random() % (r.last() + 1)
                                            : at - std::min<std::size_t>(at, 5);
        const Recording::Changes changes = r.advance(at, to);
        EXPECT_TRUE(std::is_sorted(changes.sample.begin(), changes.sample.end()));
        for (std::size_t i = 0; i < changes.sample.size(); ++i) {
            height[changes.sample[i]] = changes.height[i];
        }
        at = to;
        ASSERT_EQ(height, made.at(at)) << at;
        ASSERT_EQ(r.heights_at(at), made.at(at)) << at;
    }
    EXPECT_THROW(r.heights_at(4001), InputError);
    EXPECT_THROW(r.advance(4001, 0), InputError);
}

TEST(Recording, KeepsItsBoundByLongerFrames) {
    const Made whole(2000);
    const std::size_t bound = whole.recording.changes() * sizeof(float) / 3;
    const Made made(2000, bound);
    const Recording& r = made.recording;
    EXPECT_GE(r.steps_per_frame(), 2u);
    EXPECT_LT(r.changes() * sizeof(float), bound);
    EXPECT_LT(r.bytes(), whole.recording.bytes());
    EXPECT_EQ(r.steps().back(), 2000u);
    EXPECT_DOUBLE_EQ(r.times().back(), 2000.0);
    for (std::size_t frame = 0; frame <= r.last(); frame += 3) {
        ASSERT_EQ(r.heights_at(frame), made.at(frame));
        EXPECT_DOUBLE_EQ(r.times()[frame], r.steps()[frame]);
    }
}

TEST(Recording, FindsTheFrameOfATime) {
    const Made made(20);
    EXPECT_EQ(made.recording.frame_at(-1.0), 0u);
    EXPECT_EQ(made.recording.frame_at(0.99), 0u);
    EXPECT_EQ(made.recording.frame_at(1.0), 1u);
    EXPECT_EQ(made.recording.frame_at(7.5), 7u);
    EXPECT_EQ(made.recording.frame_at(1e9), 20u);
}

TEST(Recording, ComesBackFromItsFile) {
    const Made made(900);
    const std::string path = ::testing::TempDir() + "recording.h5";
    write_hdf5(made.recording, path, "{\"a\": 1}");
    std::string attributes;
    const Recording r = read_recording(path, &attributes);
    EXPECT_EQ(attributes, "{\"a\": 1}");
    EXPECT_EQ(r.times(), made.recording.times());
    EXPECT_EQ(r.bytes(), made.recording.bytes());
    EXPECT_EQ(r.duration(), 900.0);
    for (const std::size_t frame : {0, 1, 450, 899, 900}) {
        EXPECT_EQ(r.heights_at(frame), made.at(frame));
    }
    EXPECT_THROW(read_recording(path + ".none"), InputError);
    std::filesystem::remove(path);
}

// Whatever byte is wrong: an InputError, or another recording, never a crash.
TEST(Recording, DamagedBytesAreRefusedOrReadButNeverCrash) {
    const Made made(900);
    const std::string path = ::testing::TempDir() + "damaged_recording.h5";
    write_hdf5(made.recording, path, "{}");
    std::ifstream in(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    std::mt19937 random(3);
    for (int k = 0; k < 200; ++k) {
        std::string broken = bytes;
        broken[random() % (k % 2 == 0 ? 4096 : broken.size())] = static_cast<char>(random());
        if (k % 10 == 9) broken.resize(random() % broken.size());
        std::ofstream(path, std::ios::binary) << broken;
        try {
            const Recording other = read_recording(path);
            other.heights_at(other.last());
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
        }
    }
    std::filesystem::remove(path);
}

PathPose pressing_down(double x, double y) {
    PathPose pose;
    pose.base_from_tcp = Eigen::Translation3d(x, y, 0.4) * Eigen::AngleAxisd(M_PI, Vec3::UnitX());
    pose.feed = 30.0;
    return pose;
}

struct Grinding {
    HeightField field = testing::plate(60.0, 40.0, 0.5, 0.4);
    ElasticFoundation foundation{0.5};
    LocalLaw law{{1e-4}};
    SimulationOptions options;
    Grinding() {
        options.process.wheel = {60.0, 20.0, 0.0};
        options.process.force = 40.0;
    }
    SimulationResult grind(const std::vector<PathPose>& poses, Recording* recording) {
        options.outputs.recording = recording;
        return simulate(field, ToolPath(poses, {}), foundation, law, options);
    }
};

TEST(Recording, IsTheFieldOfASimulationStoppedAtThatStep) {
    const std::vector<PathPose> poses = {pressing_down(5, 20), pressing_down(30, 20),
                                         pressing_down(55, 15)};
    Grinding whole, first, plain;
    Recording recording;
    const SimulationResult result = whole.grind(poses, &recording);
    first.grind({poses[0], poses[1]}, nullptr);
    plain.grind(poses, nullptr);
    EXPECT_EQ(whole.field.height, plain.field.height);  // a recording changes nothing
    ASSERT_EQ(recording.last(), result.steps.size());
    std::size_t stop = 0;
    while (result.steps[stop].pose == 1) ++stop;
    const auto same = [&](std::size_t frame, const HeightField& field) {
        return recording.heights_at(frame) ==
               std::vector<float>(field.height.begin(), field.height.end());
    };
    EXPECT_TRUE(same(stop, first.field));
    EXPECT_TRUE(same(recording.last(), whole.field));
    EXPECT_NEAR(recording.times().back(), result.process_time, 1e-9);
    EXPECT_EQ(recording.frame_at(result.steps[stop].time), stop);
}

TEST(Recording, GoesOnFromPathToPath) {
    Grinding grinding;
    Recording recording;
    const auto a = grinding.grind({pressing_down(5, 10), pressing_down(55, 10)}, &recording);
    const std::vector<float> between(grinding.field.height.begin(), grinding.field.height.end());
    const auto b = grinding.grind({pressing_down(5, 30), pressing_down(55, 30)}, &recording);
    EXPECT_EQ(recording.last(), a.steps.size() + b.steps.size());
    EXPECT_NEAR(recording.duration(), a.process_time + b.process_time, 1e-9);
    EXPECT_EQ(recording.heights_at(recording.frame_at(a.process_time + 1e-9)), between);
    Grinding other;
    other.field = testing::plate(10.0, 10.0, 0.5, 0.4);
    EXPECT_THROW(other.grind({pressing_down(1, 1), pressing_down(9, 9)}, &recording), InputError);
}

TEST(Recording, IsClearedWhenTheSimulationFails) {
    Grinding grinding;
    Recording recording;
    EXPECT_THROW(grinding.grind({pressing_down(500, 10), pressing_down(600, 10)}, &recording),
                 InputError);
    EXPECT_EQ(recording.samples(), 0u);
    EXPECT_EQ(recording.last(), 0u);
}

}  // namespace
}  // namespace beltgrinding

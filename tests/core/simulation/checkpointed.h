#pragma once

// A simulation that goes on from a checkpoint against one from the start, to the last bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "beltgrinding/contact_factory.h"
#include "beltgrinding/simulation.h"
#include "checkpoints/checkpoints.h"
#include "recorders/recording.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding::testing {

inline constexpr std::size_t kPlenty = std::size_t{1} << 30;
inline constexpr double kLength = 40.0, kWidth = 24.0;  // mm

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
    std::optional<HeatMaterial> heat;
    float thickness = 3.0F;  // mm, of the sections that heat is stored in

    /// A rim takes seconds to be solved: one for all runs of a setting.
    const ContactModel& model() const {
        const ProcessSettings& process = options.process;
        if (!made && process.machine.free_face()) made = make_belt_contact(process.machine);
        if (!made) made = make_contact_model(wheel, process.wheel, process.force);
        return *made;
    }
    mutable std::shared_ptr<const ContactModel> made;
};

inline Setting setting() {
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
inline std::vector<PathPose> passes(double tilt = 0.0) {
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
        add(result.belt.loading);
        for (Eigen::Index k = 0; k < result.shifts.size(); ++k) add(result.shifts.data()[k]);
        for (const Influence* one : {&result.influence, &result.force_influence})
            add(one->first), add(one->sample), add(one->depth);
        add(field.heat.rise), add(field.heat.motion);
        const FinishTrace& finish = field.finish;
        add(finish.settled), add(finish.unknown), add(finish.crossing), add(finish.passes);
        add(finish.motion), add(finish.outside), add(finish.lay.size());
        for (const Vec3f& lay : finish.lay)
            for (int k = 0; k < 3; ++k) add(lay[k]);
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

/// A part that is ground, program after program.
struct Workpiece {
    explicit Workpiece(const Setting& s) : field(s.field()) {
        if (!s.heat) return;
        part.emplace(field, 1.0, *s.heat);
        part->set_thickness(std::vector<float>(part->size(), s.thickness));
    }
    HeightField field;
    std::optional<PartHeat> part;
};

inline Ground run(const Setting& s, Workpiece& work, const std::vector<PathPose>& poses,
                  Checkpoints* checkpoints) {
    Recording recording(s.recorded_bytes);
    SimulationOptions options = s.options;
    if (s.records) options.outputs.recording = &recording;
    options.outputs.checkpoints = checkpoints;
    if (work.part) options.heat.part = &*work.part;
    const SimulationResult result = simulate(work.field, ToolPath(poses, {}, s.time), s.model(),
                                             LocalLaw({s.coefficient}), options);
    Ground ground{Outcome(result, work.field, s.records ? &recording : nullptr),
                  result.steps.size(),
                  result.resumed,
                  result.unchanged,
                  {}};
    for (const Event& event : result.events) ground.events.push_back(event.kind);
    return ground;
}

inline Ground run(const Setting& s, const std::vector<PathPose>& poses, Checkpoints* checkpoints) {
    Workpiece work(s);
    return run(s, work, poses, checkpoints);
}

using Change = std::function<void(std::vector<PathPose>&, std::size_t)>;
inline const std::vector<std::pair<const char*, Change>> kChanges = {
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
inline void expect_the_same_from_checkpoints(const Setting& s, std::size_t bytes = kPlenty) {
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

}  // namespace beltgrinding::testing

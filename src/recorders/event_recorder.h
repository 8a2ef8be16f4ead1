#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"
#include "engine/step_queue.h"
#include "events/event_log.h"
#include "heat_recorder.h"

namespace beltgrinding {

/// Volumes so far, mm3; and where most was lost.
struct LostVolume {
    double asked = 0.0, lost = 0.0, most = 0.0;
    std::size_t step = 0;
    std::optional<std::size_t> position;
};

/// What has been seen so far. What the heights tell is not in it: `begin` looks at the blocks.
struct EventPart {
    Since<std::uint8_t> touched;  // by step
    // As of now.
    EventLog::State events;
    LostVolume lost;
    std::size_t pass = 0;

    void append(const EventPart& next);
    std::size_t bytes() const;
};

/// Watches a simulation for what goes wrong, and notes it as events with their place on the part.
class EventRecorder final : public Keeps<EventPart, Recorder> {
  public:
    /// `steps`: the simulation's. `heat`: a recorder that is told before this one; may be null. All
    /// of them must outlive it.
    EventRecorder(const SampleBlocks& blocks, const ToolPath& path,
                  const SimulationOptions& options, const RemovalLaw& law, const StepLog& steps,
                  const HeatRecorder* heat);

    std::string kind() const override { return "events"; }
    void begin() override;
    void begin_step(const StepTurn& turn) override;
    void touched(const Touch& touch) override;
    void end_step(const StepEnd& end) override;
    void end() override;
    void keep(HeightField&, SimulationResult& result) override;

  private:
    EventPart take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const EventPart* const> parts) override;
    /// The law takes more in the step than a step should.
    void coarse(const Touch& touch);
    /// The step has lowered samples.
    void ground(std::span<const SampleBlocks::Change> changes);
    /// Under a force control that takes time.
    void moved(const StepEnd& end);
    void lost(const StepEnd& end);
    void heated();
    /// A condition in the step `index`, as EventLog has it.
    Event* note(const char* kind, std::size_t index, double value, int part = 0,
                double badness = Event::kNone);
    void note_force(std::size_t index, const Pressing& pressing);
    void note_limits(std::size_t index, const Pressing& pressing, const BeltState& belt);
    void note_compression(std::size_t index, const Pressing& pressing, Pressing::State state);
    void note_distribution(std::size_t index, const Pressing& pressing);
    void note_edges(std::size_t index, const Pressing& pressing,
                    const std::vector<double>& by_column);
    void note_hollow(std::size_t index, const Pressing& pressing, bool across);
    void note_orientation_jumps();
    void note_lost_contact();
    void note_lost_volume();
    double lower_limit(std::size_t position) const;
    void put(Event& event, std::size_t position) const;
    void put(Event& event, const Pressing& pressing, double s, double y) const;

    const SampleBlocks& blocks_;
    const HeightField& field_;  // for all but the heights
    const ToolPath& path_;
    const ProcessSettings& process_;
    const MonitorLimits& limits_;
    const HeatRequest& request_;
    const RemovalLaw& law_;
    const std::vector<PathStep>& steps_;       // begun so far
    const std::vector<std::size_t>& planned_;  // by step: number of the planned one
    const HeatRecorder* heat_;
    EventLog events_;
    LostVolume lost_;
    std::size_t pass_ = 0;               // of the step, by number
    std::vector<std::uint8_t> touched_;  // by step
    std::size_t given_ = 0;              // of them, by `take`
    std::vector<Event> ended_;
    std::vector<std::uint64_t> below_;  // lanes by block: under their lower limits
    double highest_limit_ = -std::numeric_limits<double>::infinity();  // mm, of all lower ones
};

}  // namespace beltgrinding

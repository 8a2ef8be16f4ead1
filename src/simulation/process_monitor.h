#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "beltgrinding/simulation.h"
#include "events/event_log.h"
#include "heat_keeper.h"
#include "pressing.h"

namespace beltgrinding {

/// Watches a simulation for what goes wrong, and notes it as events with their place on the part.
/// It only looks on: the result is the same without it.
class ProcessMonitor {
  public:
    /// All of them must outlive it. `blocks` are those that are ground.
    ProcessMonitor(const SampleBlocks& blocks, const ToolPath& path, const ProcessSettings& process,
                   const MonitorLimits& limits, const RemovalLaw& law);

    /// A step begins: what is told after this is of it. `planned`: number of the step that it is
    /// or is a part of.
    void begin(const PathStep& step, std::size_t planned);
    /// The wheel is pressed, nothing is removed yet. `belt`: what it has done.
    void pressed(const Pressing& pressing, Pressing::State state, const BeltState& belt);
    /// The law takes `removal` mm in the step, more than `most`, though it is one of `parts` that
    /// the planned step was cut into.
    void coarse(const Pressing& pressing, double removal, double most, int parts);
    /// The step has lowered samples.
    void ground(std::span<const SampleBlocks::Change> changes);
    /// Under a force control that takes time the step's greatest force was `force` N, and the wheel
    /// came back to the work after `bounce` s; 0: it did not.
    void moved(const Pressing& pressing, Pressing::State state, double force, double bounce);
    /// Of the `asked` mm3 that the law takes in the step, `removed` were taken from the field.
    void lost(const Pressing& pressing, double asked, double removed);
    /// The step has heated the part.
    void heated(const HeatKeeper& heat, const HeatRequest& request);
    /// All events, in order of time.
    std::vector<Event> take();

    /// Volumes so far, mm3; and where most was lost.
    struct LostVolume {
        double asked = 0.0, lost = 0.0, most = 0.0;
        std::size_t step = 0;
        std::optional<std::size_t> position;
    };
    /// What has been seen so far. What the heights tell is not in it: a monitor is made of blocks
    /// as they are.
    struct State {
        EventLog::State events;
        LostVolume lost;
        std::size_t pass = 0;
    };
    State state() const { return {events_.state(), lost_, pass_}; }
    /// Steps begun so far.
    std::size_t steps() const { return steps_.size(); }
    /// Whether the wheel touched, by step, from the step number `from` on.
    std::vector<std::uint8_t> touched(std::size_t from) const {
        return {touched_.begin() + static_cast<std::ptrdiff_t>(from), touched_.end()};
    }
    /// A step was begun before, as of `begin`.
    void restore(const PathStep& step, std::size_t planned, bool touched);
    void restore(const State& state);

  private:
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
    std::vector<PathStep> steps_;       // begun so far
    std::vector<std::size_t> planned_;  // by step: number of the planned one
    const ProcessSettings& process_;
    const MonitorLimits& limits_;
    const RemovalLaw& law_;
    EventLog events_;
    LostVolume lost_;
    std::size_t pass_ = 0;               // of the step, by number
    std::vector<std::uint8_t> touched_;  // by step
    std::vector<std::uint64_t> below_;   // lanes by block: under their lower limits
    double highest_limit_ = -std::numeric_limits<double>::infinity();  // mm, of all lower ones
};

}  // namespace beltgrinding

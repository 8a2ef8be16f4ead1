#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/simulation.h"
#include "events/event_log.h"
#include "pressing.h"

namespace beltgrinding {

/// Watches a simulation for what goes wrong, and notes it as events with their place on the part.
/// It only looks on: the result is the same without it.
class ProcessMonitor {
  public:
    /// All of them must outlive it. `field` is the one that is ground.
    ProcessMonitor(const HeightField& field, const ToolPath& path,
                   const std::vector<PathStep>& steps, const ProcessSettings& process,
                   const MonitorLimits& limits, const RemovalLaw& law);

    /// The wheel is pressed in step `index`, nothing is removed yet. `belt`: what it has done.
    void pressed(std::size_t index, const Pressing& pressing, Pressing::State state,
                 const BeltState& belt);
    /// Step `index` has lowered the samples `changed`.
    void ground(std::size_t index, std::span<const std::uint32_t> changed);
    /// All events, in order of time.
    std::vector<Event> take();

  private:
    void note_force(std::size_t index, const Pressing& pressing);
    void note_limits(std::size_t index, const Pressing& pressing, const BeltState& belt);
    void note_distribution(std::size_t index, const Pressing& pressing);
    void note_edges(std::size_t index, const Pressing& pressing,
                    const std::vector<double>& by_column);
    void note_hollow(std::size_t index, const Pressing& pressing, bool across);
    void note_orientation_jumps();
    void note_lost_contact();
    double lower_limit(std::uint32_t sample) const;
    void put(Event& event, std::uint32_t sample) const;
    void put(Event& event, const Pressing& pressing, double s, double y) const;

    const HeightField& field_;
    const ToolPath& path_;
    const std::vector<PathStep>& steps_;
    const ProcessSettings& process_;
    const MonitorLimits& limits_;
    const RemovalLaw& law_;
    EventLog events_;
    std::vector<std::uint8_t> touched_;  // by step
    std::vector<std::uint8_t> below_;    // by sample: under its lower limit
};

}  // namespace beltgrinding

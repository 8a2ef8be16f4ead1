#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "beltgrinding/event.h"
#include "beltgrinding/tool_path.h"

namespace beltgrinding {

/// Collects events; a condition that lasts over consecutive steps is one event with its worst
/// value.
class EventLog {
  public:
    /// `pause`: a condition that is absent for fewer steps goes on.
    explicit EventLog(const ToolPath& path, std::size_t pause = 1) : path_(path), pause_(pause) {}

    /// Notes the condition `kind` in the step number `index`. `part` tells apart what may last side
    /// by side, such as joints. Returns the event if this is its worst so far, for limit, place and
    /// facts to be set, until the next call; else null. `badness` decides what is worst; without
    /// it, the value does.
    Event* note(const std::string& kind, std::size_t index, const PathStep& step, double value,
                int part = 0, double badness = Event::kNone);
    /// In order of time.
    std::vector<Event> take();

    /// A condition that may last.
    struct Open {
        std::size_t event;
        std::size_t last_step;
        double badness;
    };
    /// What has been noted so far.
    struct State {
        std::vector<Event> events;
        std::map<std::pair<std::string, int>, Open> open;
    };
    const State& state() const { return state_; }
    void restore(State state) { state_ = std::move(state); }

  private:
    const ToolPath& path_;
    std::size_t pause_;
    State state_;
};

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "simulation/simulation.h"
#include "toolpath/tool_path.h"

namespace beltgrinding {

/// Collects events; a condition that lasts over consecutive steps is one event with its worst
/// value.
class EventLog {
  public:
    explicit EventLog(const ToolPath& path) : path_(path) {}

    /// Notes the condition `kind` in the step number `index`. `larger_is_worse` decides which value
    /// of a lasting event is kept.
    void note(const std::string& kind, std::size_t index, const PathStep& step, double value,
              const std::string& message, bool larger_is_worse = true);
    /// In order of time.
    std::vector<Event> take();

  private:
    struct Open {
        std::size_t event;
        std::size_t last_step;
    };
    const ToolPath& path_;
    std::vector<Event> events_;
    std::map<std::string, Open> open_;
};

}  // namespace beltgrinding

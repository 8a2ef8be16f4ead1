#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "toolpath/tool_path.h"

namespace beltgrinding {

/// Something that the user must know, with its place on the path.
struct Event {
    std::string kind;  ///< "no_contact", "not_converged", "force_not_reached", "depth_exceeded"...
    std::uint32_t pose = 0;  ///< programmed pose, from 0
    int line = 0;            ///< of the source file; 0: unknown
    double time = 0.0;       ///< s
    double duration = 0.0;   ///< s that the condition lasted (consecutive steps are one event)
    double value = 0.0;      ///< worst value, in the unit that the message names
    std::string message;     ///< one sentence
};

/// Collects events; a condition that lasts over consecutive steps is one event with its worst
/// value.
class EventLog {
  public:
    explicit EventLog(const ToolPath& path) : path_(path) {}

    /// Notes the condition `kind` in the step number `index`. `larger_is_worse` decides which value
    /// of a lasting event is kept. `part` tells apart what may last side by side, such as joints.
    void note(const std::string& kind, std::size_t index, const PathStep& step, double value,
              const std::string& message, bool larger_is_worse = true, int part = 0);
    /// In order of time.
    std::vector<Event> take();

  private:
    struct Open {
        std::size_t event;
        std::size_t last_step;
    };
    const ToolPath& path_;
    std::vector<Event> events_;
    std::map<std::pair<std::string, int>, Open> open_;
};

}  // namespace beltgrinding

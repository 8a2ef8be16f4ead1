#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "beltgrinding/event_kinds.h"
#include "beltgrinding/fact.h"
#include "beltgrinding/tool_path.h"

namespace beltgrinding {

/// Something that the user must know, with its place on the path and on the part.
struct Event {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::string kind;  ///< code of an EventKind
    Severity severity = Severity::kWarning;
    std::uint32_t pose = 0;              ///< programmed pose that the motion leads to, from 0
    int line = 0;                        ///< of the source file; 0: unknown
    double time = 0.0;                   ///< s, when it began
    double duration = 0.0;               ///< s that the condition lasted
    double worst_time = 0.0;             ///< s, when it was worst
    double value = 0.0;                  ///< the worst, in `unit`
    double limit = kNone;                ///< in `unit`; NaN: there is none
    std::string unit;                    ///< of the kind, unless said otherwise
    Vec3 point = Vec3::Constant(kNone);  ///< on the part, work frame, mm; NaN: no place
    std::uint32_t face = 0;              ///< from 1; 0: none
    std::vector<Fact> facts;             ///< what happened, and what follows
    std::vector<std::string> bodies;     ///< that meet

    /// The facts in English, one line.
    std::string message() const { return sentence(facts); }
};

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

  private:
    struct Open {
        std::size_t event;
        std::size_t last_step;
        double badness;
    };
    const ToolPath& path_;
    std::size_t pause_;
    std::vector<Event> events_;
    std::map<std::pair<std::string, int>, Open> open_;
};

}  // namespace beltgrinding

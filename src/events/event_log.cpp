#include "events/event_log.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {

Event* EventLog::note(const std::string& code, std::size_t index, const PathStep& step,
                      double value, int part, double badness) {
    const EventKind& kind = event_kind(code);
    if (std::isnan(badness)) badness = kind.larger_is_worse ? value : -value;
    const auto found = state_.open.find({code, part});
    if (found != state_.open.end() && index <= found->second.last_step + pause_) {
        Event& event = state_.events[found->second.event];
        event.duration = step.time + 0.5 * step.duration - event.time;
        found->second.last_step = index;
        if (!(badness > found->second.badness)) return nullptr;
        found->second.badness = badness;
        event.value = value;
        event.worst_time = step.time;
        return &event;
    }
    Event event;
    event.kind = kind.code;
    event.severity = kind.severity;
    event.unit = kind.unit;
    event.pose = step.pose;
    event.line = path_.poses()[step.pose].line;
    event.time = step.time - 0.5 * step.duration;
    event.duration = step.duration;
    event.worst_time = step.time;
    event.value = value;
    state_.open[{code, part}] = {state_.events.size(), index, badness};
    state_.events.push_back(event);
    return &state_.events.back();
}

std::vector<Event> EventLog::take() {
    std::stable_sort(state_.events.begin(), state_.events.end(),
                     [](const Event& a, const Event& b) { return a.time < b.time; });
    state_.open.clear();
    return std::move(state_.events);
}

}  // namespace beltgrinding

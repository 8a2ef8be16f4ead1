#include "toolpath/event_log.h"

#include <algorithm>

namespace beltgrinding {

void EventLog::note(const std::string& kind, std::size_t index, const PathStep& step, double value,
                    const std::string& message, bool larger_is_worse, int part) {
    const auto found = open_.find({kind, part});
    if (found != open_.end() && found->second.last_step + 1 == index) {
        Event& event = events_[found->second.event];
        event.duration += step.duration;
        if (larger_is_worse ? value > event.value : value < event.value) {
            event.value = value;
            event.message = message;
        }
        found->second.last_step = index;
        return;
    }
    Event event;
    event.kind = kind;
    event.pose = step.pose;
    event.line = path_.poses()[step.pose].line;
    event.time = step.time - 0.5 * step.duration;
    event.duration = step.duration;
    event.value = value;
    event.message = message;
    open_[{kind, part}] = {events_.size(), index};
    events_.push_back(event);
}

std::vector<Event> EventLog::take() {
    std::stable_sort(events_.begin(), events_.end(),
                     [](const Event& a, const Event& b) { return a.time < b.time; });
    open_.clear();
    return std::move(events_);
}

}  // namespace beltgrinding

#include <cmath>

#include "dict.h"
#include "facts.h"

namespace beltgrinding::python {
namespace {

py::object known(double value) {
    return std::isfinite(value) ? py::cast(value) : py::none();
}

}  // namespace

py::list events_to_list(const std::vector<Event>& events) {
    py::list list;
    for (const Event& e : events) {
        py::dict d;
        d["kind"] = e.kind;
        d["severity"] = name(e.severity);
        d["pose"] = e.pose;
        d["line"] = e.line;
        d["time"] = e.time;
        d["duration"] = e.duration;
        d["worst_time"] = e.worst_time;
        d["value"] = e.value;
        d["limit"] = known(e.limit);
        d["unit"] = e.unit;
        d["point"] = py::none();
        if (e.point.allFinite()) {
            py::list point;
            for (const double x : e.point) point.append(x);
            d["point"] = point;
        }
        d["face"] = e.face > 0 ? py::cast(e.face) : py::none();
        d["bodies"] = e.bodies;
        d["message"] = text(e.message());
        py::list facts;
        for (const Fact& fact : e.facts) facts.append(to_dict(fact));
        d["facts"] = facts;
        d["advice"] = event_kind(e.kind).advice;
        list.append(d);
    }
    return list;
}

void bind_events(py::module_& m) {
    m.def(
        "event_kinds",
        [] {
            py::list list;
            for (const EventKind& kind : event_kinds()) {
                py::dict d;
                d["code"] = kind.code;
                d["severity"] = name(kind.severity);
                d["unit"] = kind.unit;
                d["larger_is_worse"] = kind.larger_is_worse;
                d["meaning"] = kind.meaning;
                d["advice"] = kind.advice;
                list.append(d);
            }
            return list;
        },
        "All kinds of events, as dicts of code, severity, unit, larger_is_worse, meaning, "
        "advice.");
}

}  // namespace beltgrinding::python

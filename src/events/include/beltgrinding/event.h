#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "beltgrinding/fact.h"
#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// How bad an event is.
enum class Severity { kInfo, kWarning, kError };

/// A kind of event. `code` never changes once it is published; docs/events.md has them all.
struct EventKind {
    const char* code;      ///< such as "gouge"
    Severity severity;     ///< how bad it is
    const char* unit;      ///< of value and limit
    bool larger_is_worse;  ///< which value of a lasting condition is kept
    const char* meaning;   ///< a sentence
    const char* advice;    ///< what to try, a sentence
};

/// All kinds, in the order of the manual's table.
std::span<const EventKind> event_kinds();

/// The kind with that code. Throws std::logic_error for an unknown one.
const EventKind& event_kind(const std::string& code);

/// "info", "warning" or "error".
const char* name(Severity severity);

/// Something that the user must know, with its place on the path and on the part.
struct Event {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  ///< not known

    std::string kind;                        ///< code of an EventKind
    Severity severity = Severity::kWarning;  ///< of the kind, unless said otherwise
    std::uint32_t pose = 0;                  ///< programmed pose that the motion leads to, from 0
    int line = 0;                            ///< of the source file; 0: unknown
    double time = 0.0;                       ///< s, when it began
    double duration = 0.0;                   ///< s that the condition lasted
    double worst_time = 0.0;                 ///< s, when it was worst
    double value = 0.0;                      ///< the worst, in `unit`
    double limit = kNone;                    ///< in `unit`; NaN: there is none
    std::string unit;                        ///< of the kind, unless said otherwise
    Vec3 point = Vec3::Constant(kNone);      ///< on the part, work frame, mm; NaN: no place
    std::uint32_t face = 0;                  ///< from 1; 0: none
    std::vector<Fact> facts;                 ///< what happened, and what follows
    std::vector<std::string> bodies;         ///< that meet

    /// The facts in English, one line.
    std::string message() const { return sentence(facts); }
};

}  // namespace beltgrinding

#pragma once

#include <span>
#include <string>

namespace beltgrinding {

enum class Severity { kInfo, kWarning, kError };

/// A kind of event. `code` never changes once it is published; docs/events.md has them all.
struct EventKind {
    const char* code;
    Severity severity;
    const char* unit;      ///< of value and limit
    bool larger_is_worse;  ///< which value of a lasting condition is kept
    const char* meaning;   ///< a sentence
    const char* advice;    ///< what to try, a sentence
};

/// All kinds, in the order of the manual's table.
std::span<const EventKind> event_kinds();

/// The kind with that code. Throws std::logic_error for one that is none.
const EventKind& event_kind(const std::string& code);

/// "info", "warning" or "error".
const char* name(Severity severity);

}  // namespace beltgrinding

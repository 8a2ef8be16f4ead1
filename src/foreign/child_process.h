#pragma once

// Private to this room: a program run for what it writes, and nothing of it left afterwards.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "beltgrinding/run_context.h"

namespace beltgrinding {

struct ChildRequest {
    std::string program;                 ///< path
    std::vector<std::string> arguments;  ///< after the program's name
    std::string input;                   ///< its standard input
    double time_limit = 0;               ///< s
    std::size_t memory_limit = 0;        ///< bytes of its own that it may hold
    /// Told all that came so far; how many bytes there will be, 0: no more is wanted.
    std::function<std::size_t(const std::string& so_far)> expected;
};

struct ChildAnswer {
    std::string output;      ///< what it wrote to kAnswerDescriptor
    int signal = 0;          ///< that ended it; 0: none, or the host reaps its children by itself
    bool timed_out = false;  ///< it was killed at the time limit
    bool out_of_memory = false;  ///< it was killed at the memory limit
};

/// Runs a program until it has written its answer, then ends it. Its output goes nowhere, it
/// inherits no descriptor, no signal mask and no handler, and it is in a process group of its own:
/// the terminal's Ctrl-C is the host's to handle. Any number at a time, from any threads. Throws
/// Cancelled within 0.1 s of the context's cancellation; std::system_error if it cannot be started.
/// However the call ends, the child is dead and reaped.
ChildAnswer run_child(const ChildRequest& request, const RunContext& context);

}  // namespace beltgrinding

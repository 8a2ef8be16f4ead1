#pragma once

#include <cstddef>
#include <string>

#include "beltgrinding/error.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// What the reader, the program `beltgrinding-cad-reader` (src/reader), is asked for.
struct ReaderRequest {
    std::string task;   ///< what to do, as the reader knows it: "STEP", "MESH", "TRIANGULATE", ...
    std::string path;   ///< of the file; empty: `input` is what to work on
    std::string input;  ///< bytes
};

/// How the reader failed, where it could not say so itself.
struct ReaderFault {
    enum class Kind { kTime, kMemory, kSize, kSignal };
    Kind kind;
    double limit = 0;      ///< s, or MB of the memory or of the answer
    std::string variable;  ///< of the environment, that sets the limit
    std::string signal;    ///< "SIGSEGV"
    bool told = false;     ///< the reader said so itself: it was at work, not broken
};

/// Runs the reader, a fresh process for each call, and gives what it answers; it may be called from
/// any threads at a time. The process is ended when it takes longer than
/// BELTGRINDING_CAD_TIME_LIMIT_S (900 s), more memory than BELTGRINDING_CAD_MEMORY_LIMIT_MB (half
/// of what this process may use), or answers more than BELTGRINDING_CAD_ANSWER_LIMIT_MB (half of
/// that). Throws ReaderFault, the reader's own InputError, an InputError where there is no reader,
/// it cannot be started, or it is another program, and for a limit that is no number; Cancelled
/// within 0.1 s.
std::string ask_reader(const ReaderRequest& request, const RunContext& context);

/// The reader is where it is looked for.
bool has_reader();

/// The error is of the reader itself, not of what it was given: it is not there, cannot be started,
/// or is another program.
bool is_without_reader(const InputError& error);

/// As `set_cad_reader` (beltgrinding/shape.h).
void set_reader(const std::string& program);

/// Where the reader of this library lies, looked for after those that a person names:
/// cmake/installed_reader.cpp, in each program that links it, says so.
void set_installed_reader(const char* program);

/// Throws the InputError for a fault in reading a file of `format` ("STEP") by `library`, which is
/// named where the library failed.
[[noreturn]] void refuse_file(const ReaderFault& fault, const std::string& format,
                              const std::string& library);

}  // namespace beltgrinding

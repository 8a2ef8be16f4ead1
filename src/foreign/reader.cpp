#include "foreign/reader.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "beltgrinding/error.h"
#include "child_process.h"
#include "foreign/answer.h"

namespace beltgrinding {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "beltgrinding-cad-reader";
constexpr const char* kProgramVariable = "BELTGRINDING_CAD_READER";
constexpr const char* kTimeVariable = "BELTGRINDING_CAD_TIME_LIMIT_S";
constexpr const char* kMemoryVariable = "BELTGRINDING_CAD_MEMORY_LIMIT_MB";
constexpr const char* kAnswerVariable = "BELTGRINDING_CAD_ANSWER_LIMIT_MB";
constexpr double kTimeLimit = 900;    // s; the largest real assemblies take a few minutes
constexpr double kMemoryShare = 0.5;  // of what this process may use
constexpr double kAnswerShare = 0.5;  // of that: the host holds the answer and what it is made into
constexpr double kMegabyte = 1e6;     // bytes
constexpr double kMostMegabytes = 1e9;
constexpr double kMostSeconds = 1e9;

std::mutex g_mutex;
std::string g_program;  // as set_reader has it

/// As set_installed_reader has it, perhaps before this file's own variables are made.
std::string& installed_program() {
    static std::string program;
    return program;
}

/// Where this code lies: the Python module, a library, or the program itself.
fs::path own_object() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&own_object), &info) == 0 || !info.dli_fname)
        return {};
    return info.dli_fname;
}

/// Of the library that the program was linked with; beside the object that this code is in, where
/// its links lead (the Debian package links its modules from FreeCAD's folder), and in libexec of
/// the same prefix. Beside a module `core.TAG.so` a reader `kProgram.TAG` comes first: builds for
/// several systems lie side by side.
std::vector<fs::path> places() {
    std::vector<fs::path> found;
    if (!installed_program().empty()) found.push_back(installed_program());
    const fs::path object = own_object();
    std::error_code error;
    const std::string file = object.filename().string();
    const auto dot = file.find('.');
    std::string tag = dot == std::string::npos ? "" : file.substr(dot);
    if (tag.ends_with(".so")) tag.resize(tag.size() - 3);
    for (const fs::path& folder :
         {object.parent_path(), fs::canonical(object, error).parent_path()}) {
        if (!tag.empty()) found.push_back(folder / (kProgram + tag));
        found.push_back(folder / kProgram);
        for (const fs::path& prefix : {folder.parent_path(), folder.parent_path().parent_path()})
            found.push_back(prefix / "libexec" / "beltgrinding" / kProgram);
    }
    return found;
}

/// The reader's path; empty if it is not there: `looked` then says where that is.
std::string find_program(std::string& looked) {
    {
        const std::lock_guard<std::mutex> lock(g_mutex);
        if (!g_program.empty()) return g_program;
    }
    if (const char* given = std::getenv(kProgramVariable); given && *given) return given;
    for (const fs::path& place : places()) {
        std::error_code error;
        if (fs::is_regular_file(place, error)) {
            // A zip that Python unpacked has lost the mode.
            if (access(place.c_str(), X_OK) != 0)
                fs::permissions(place, fs::perms::owner_exec, fs::perm_options::add, error);
            return place.string();
        }
        if (looked.find(place.parent_path().string()) == std::string::npos)
            looked += (looked.empty() ? "" : ", ") + place.parent_path().string();
    }
    return {};
}

std::string program() {
    std::string looked;
    if (std::string found = find_program(looked); !found.empty()) return found;
    throw InputError("cad.no_reader",
                     "the program that reads CAD files, {program}, is not there (looked in "
                     "{places}); install the workbench again, or set {variable} to where it is",
                     {{"program", kProgram}, {"places", looked}, {"variable", kProgramVariable}});
}

/// The number above 0 in a variable of the environment; `otherwise` where it is not set. Not by
/// strtod, which asks the host's locale for the decimal point.
double limit(const char* variable, double otherwise, double most) {
    const char* given = std::getenv(variable);
    if (!given || !*given) return otherwise;
    double value = 0;
    const char* end = given + std::strlen(given);
    const auto [stop, error] = std::from_chars(given, end, value);
    if (error == std::errc() && stop == end && value > 0 && std::isfinite(value))
        return std::min(value, most);
    if (variable == kTimeVariable)
        throw InputError("cad.time_limit", "{variable} is '{value}'; it must be seconds, above 0",
                         {{"variable", variable}, {"value", given}});
    throw InputError("cad.limit", "{variable} is '{value}'; it must be megabytes, above 0",
                     {{"variable", variable}, {"value", given}});
}

struct Limits {
    double time = 0;    ///< s
    double memory = 0;  ///< MB
    double answer = 0;  ///< MB
};

Limits limits() {
    Limits found;
    found.time = limit(kTimeVariable, kTimeLimit, kMostSeconds);
    const double megabytes = kMemoryShare * double(usable_memory()) / kMegabyte;
    found.memory = limit(kMemoryVariable, megabytes, kMostMegabytes);
    found.answer = limit(kAnswerVariable, kAnswerShare * found.memory, kMostMegabytes);
    return found;
}

std::optional<AnswerHead> head_of(const std::string& answer) {
    AnswerHead head;
    std::string_view bytes = answer;
    if (!take_bytes(bytes, head) || head.magic != AnswerHead().magic ||
        head.kind > AnswerKind::kSignal)
        return std::nullopt;
    return head;
}

/// Bytes of the whole answer; 0: no more is wanted.
std::size_t expected(const std::string& so_far, double most) {
    if (so_far.size() < sizeof(AnswerHead)) return std::numeric_limits<std::size_t>::max();
    const std::optional<AnswerHead> head = head_of(so_far);
    if (!head || double(head->size) > most) return 0;
    return sizeof(AnswerHead) + std::size_t(head->size);
}

std::string signal_name(int number) {
    const char* name = sigabbrev_np(number);
    return name ? std::string("SIG") + name : "signal " + std::to_string(number);
}

std::string body_of(ChildAnswer answer, const std::string& program, double most) {
    const std::optional<AnswerHead> head = head_of(answer.output);
    if (head && double(head->size) > most)
        throw ReaderFault{ReaderFault::Kind::kSize, most / kMegabyte, kAnswerVariable, {}, false};
    const bool whole =
        head && answer.output.size() == sizeof *head + head->size &&
        answer_check(std::string_view(answer.output).substr(sizeof *head)) == head->check;
    const bool fault = whole ? head->kind == AnswerKind::kSignal : answer.signal != 0;
    if (fault)
        throw ReaderFault{ReaderFault::Kind::kSignal,
                          0,
                          {},
                          signal_name(whole ? head->signal : answer.signal),
                          whole};
    if (whole) {
        answer.output.erase(0, sizeof *head);
        if (head->kind == AnswerKind::kDone) return std::move(answer.output);
        if (const auto error = unpack_error(answer.output)) throw *error;
    }
    throw InputError("cad.no_answer",
                     "the program that reads CAD files, {program}, gave no answer that can be "
                     "understood; install the workbench again",
                     {{"program", program}});
}

}  // namespace

void set_reader(const std::string& program) {
    const std::lock_guard<std::mutex> lock(g_mutex);
    g_program = program;
}

void set_installed_reader(const char* program) {
    installed_program() = program;
}

bool is_without_reader(const InputError& error) {
    const std::string& code = error.code();
    return code == "cad.no_reader" || code == "cad.not_started" || code == "cad.no_answer";
}

bool has_reader() {
    std::string looked;
    return !find_program(looked).empty();
}

std::string ask_reader(const ReaderRequest& request, const RunContext& context) {
    const Limits most = limits();
    ChildRequest child;
    child.program = program();
    child.time_limit = most.time;
    child.memory_limit = std::size_t(most.memory * kMegabyte);
    child.arguments = {std::to_string(getpid()), std::to_string(child.memory_limit), request.task};
    if (!request.path.empty()) child.arguments.push_back(request.path);
    child.input = request.input;
    const double most_bytes = most.answer * kMegabyte;
    child.expected = [&](const std::string& so_far) { return expected(so_far, most_bytes); };
    try {
        ChildAnswer answer = run_child(child, context);
        if (answer.timed_out)
            throw ReaderFault{ReaderFault::Kind::kTime, most.time, kTimeVariable, {}, false};
        const std::optional<AnswerHead> head = head_of(answer.output);
        if (answer.out_of_memory || (head && head->kind == AnswerKind::kMemory))
            throw ReaderFault{ReaderFault::Kind::kMemory, most.memory, kMemoryVariable, {}, false};
        return body_of(std::move(answer), child.program, most_bytes);
    } catch (const std::system_error& error) {
        throw InputError("cad.not_started",
                         "it cannot be read: {program} cannot be started: {reason}",
                         {{"program", child.program}, {"reason", error.code().message()}});
    }
}

void refuse_file(const ReaderFault& fault, const std::string& format, const std::string& library) {
    switch (fault.kind) {
        case ReaderFault::Kind::kTime:
            throw InputError(
                "cad.timeout",
                "reading it took more than {limit:.3g} s and was given up: the {format} "
                "file is damaged, or very large; export it again, or set {variable} "
                "higher",
                {{"limit", fault.limit}, {"format", format}, {"variable", fault.variable}});
        case ReaderFault::Kind::kMemory:
            throw InputError(
                "cad.memory",
                "reading it needs more memory than the {limit:.0f} MB allowed: the {format} file "
                "is damaged, or too large; export it again, or set {variable} higher if the "
                "machine has more",
                {{"limit", fault.limit}, {"format", format}, {"variable", fault.variable}});
        case ReaderFault::Kind::kSize:
            throw InputError(
                "cad.too_large",
                "what the {format} file holds takes more than the {limit:.0f} MB allowed: it is "
                "damaged, or too large; export it coarser, or set {variable} higher",
                {{"format", format}, {"limit", fault.limit}, {"variable", fault.variable}});
        default:
            throw InputError("cad.crash",
                             "not a readable {format} file, it is damaged: {library} ended with "
                             "{signal}; export it again or use another format",
                             {{"format", format}, {"library", library}, {"signal", fault.signal}});
    }
}

}  // namespace beltgrinding

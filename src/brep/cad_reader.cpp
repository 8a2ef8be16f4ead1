#include "cad_reader.h"

#include <dlfcn.h>
#include <unistd.h>

#include <Standard_Failure.hxx>
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <mutex>
#include <system_error>
#include <vector>

#include "beltgrinding/error.h"
#include "beltgrinding/shape.h"
#include "cad_answer.h"
#include "child_process.h"
#include "shape_transfer.h"

namespace beltgrinding {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "beltgrinding-cad-reader";
constexpr const char* kProgramVariable = "BELTGRINDING_CAD_READER";
constexpr const char* kLimitVariable = "BELTGRINDING_CAD_TIME_LIMIT_S";
constexpr double kTimeLimit = 900;  // s; the largest real assemblies take a few minutes

std::mutex g_mutex;
std::string g_program;  // as set_cad_reader has it

/// Where this code lies: the Python module, a library, or the program itself.
fs::path own_object() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&own_object), &info) == 0 || !info.dli_fname)
        return {};
    return info.dli_fname;
}

/// Beside the object that this code is in, where its links lead (the Debian package links its
/// modules from FreeCAD's folder), in libexec of the same prefix, and where the library was
/// installed. Beside a module `core.TAG.so` a reader `kProgram.TAG` comes first: builds for several
/// systems lie side by side.
std::vector<fs::path> places() {
    std::vector<fs::path> found;
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
#ifdef BELTGRINDING_LIBEXEC
    found.push_back(fs::path(BELTGRINDING_LIBEXEC) / kProgram);
#endif
    return found;
}

std::string program() {
    {
        const std::lock_guard<std::mutex> lock(g_mutex);
        if (!g_program.empty()) return g_program;
    }
    if (const char* given = std::getenv(kProgramVariable); given && *given) return given;
    std::string looked;
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
    throw InputError("cad.no_reader",
                     "the program that reads CAD files, {program}, is not there (looked in "
                     "{places}); install the workbench again, or set {variable} to where it is",
                     {{"program", kProgram}, {"places", looked}, {"variable", kProgramVariable}});
}

double time_limit() {
    const char* given = std::getenv(kLimitVariable);
    if (!given || !*given) return kTimeLimit;
    char* end = nullptr;
    const double seconds = std::strtod(given, &end);
    if (*end != '\0' || !(seconds > 0))
        throw InputError("cad.time_limit", "{variable} is '{value}'; it must be seconds, above 0",
                         {{"variable", kLimitVariable}, {"value", given}});
    return seconds;
}

CadAnswerHead head_of(const std::string& answer) {
    CadAnswerHead head;
    std::memcpy(&head, answer.data(), sizeof head);
    return head;
}

std::size_t expected(const std::string& so_far) {
    constexpr std::size_t kMore = std::numeric_limits<std::size_t>::max();
    if (so_far.size() < sizeof(CadAnswerHead)) return kMore;
    const CadAnswerHead head = head_of(so_far);
    if (head.magic != CadAnswerHead().magic) return 0;  // rubbish, perhaps without an end
    return head.size > kMore - sizeof head ? kMore : sizeof head + std::size_t(head.size);
}

std::string signal_name(int number) {
    const char* name = sigabbrev_np(number);
    return name ? std::string("SIG") + name : "signal " + std::to_string(number);
}

Fact outer(const std::string& name, const std::string* text) {
    if (text) return {"cad.shape", "{shape}: ", {{"shape", name}}};
    return {"cad.file", "{file}: ", {{"file", name}}};
}

/// Throws what the reader says against the file; `text`: it is no file.
[[noreturn]] void refuse(CadAnswerKind kind, const std::string& format, std::string_view words,
                         bool text) {
    switch (kind) {
        case CadAnswerKind::kNullShape:
            throw InputError("cad.null_shape",
                             "the {format} file gives no shape (null shape): it holds no solid, "
                             "shell or face that can be read; export the part again",
                             {{"format", format}});
        case CadAnswerKind::kMemory:
            throw InputError(
                "cad.memory",
                "reading it needs more memory than this machine has; the {format} file "
                "is damaged, or too large",
                {{"format", format}});
        case CadAnswerKind::kFailure:
            throw InputError("cad.failure", "OpenCASCADE cannot read it: {reason}",
                             {{"reason", std::string(words)}});
        default:
            if (text) throw InputError("cad.not_brep_text", "not the text of a BREP shape");
            throw InputError("cad.not_readable",
                             "not a readable {format} file; export it again or use another format",
                             {{"format", format}});
    }
}

CadShape shape_of(const ChildAnswer& answer, const std::string& program, const std::string& format,
                  bool text) {
    const CadAnswerHead head =
        answer.output.size() < sizeof(CadAnswerHead) ? CadAnswerHead() : head_of(answer.output);
    const std::string_view body =
        std::string_view(answer.output).substr(std::min(answer.output.size(), sizeof head));
    const bool whole = answer.output.size() == sizeof head + head.size &&
                       head.magic == CadAnswerHead().magic && cad_answer_check(body) == head.check;
    if (!whole && answer.signal == 0)
        throw InputError("cad.no_answer",
                         "the program that reads CAD files, {program}, gave no answer that can be "
                         "understood; install the workbench again",
                         {{"program", program}});
    if (!whole || head.kind == CadAnswerKind::kSignal)
        throw InputError(
            "cad.crash",
            "not a readable {format} file, it is damaged: OpenCASCADE ended with "
            "{signal}; export it again or use another format",
            {{"format", format}, {"signal", signal_name(whole ? head.signal : answer.signal)}});
    if (head.kind != CadAnswerKind::kShape) refuse(head.kind, format, body, text);
    try {
        CadFacts facts;
        if (body.size() < sizeof facts) throw Standard_Failure("no facts");
        std::memcpy(&facts, body.data(), sizeof facts);
        CadShape found{unpack_shape(body.substr(sizeof facts)), facts.valid != 0, std::nullopt};
        const auto& e = facts.extents;
        if (facts.meshed != 0) found.extents = Box(Vec3(e[0], e[1], e[2]), Vec3(e[3], e[4], e[5]));
        return found;
    } catch (const Standard_Failure& failure) {
        refuse(CadAnswerKind::kFailure, format, failure.GetMessageString(), text);
    }
}

}  // namespace

void set_cad_reader(const std::string& program) {
    const std::lock_guard<std::mutex> lock(g_mutex);
    g_program = program;
}

const char* cad_format_name(CadFormat format) {
    return format == CadFormat::kStep ? "STEP" : format == CadFormat::kIges ? "IGES" : "BREP";
}

CadShape read_in_child(CadFormat format, const std::string& path, const std::string* text,
                       const std::string& name, const RunContext& context) {
    const std::string kind = cad_format_name(format);
    ChildRequest request;
    request.arguments = {std::to_string(getpid()), kind};
    if (text) {
        request.input = *text;
    } else {
        request.arguments.push_back(path);
    }
    request.expected = expected;
    try {
        request.program = program();
        request.time_limit = time_limit();
        const ChildAnswer answer = run_child(request, context);
        if (answer.timed_out)
            throw InputError(
                "cad.timeout",
                "reading it took more than {limit:.3g} s and was given up: the {format} "
                "file is damaged, or very large; export it again, or set {variable} "
                "higher",
                {{"limit", request.time_limit}, {"format", kind}, {"variable", kLimitVariable}});
        return shape_of(answer, request.program, kind, text != nullptr);
    } catch (const std::system_error& error) {
        throw InputError("cad.not_started",
                         "it cannot be read: {program} cannot be started: {reason}",
                         {{"program", request.program}, {"reason", error.code().message()}})
            .within(outer(name, text));
    } catch (const InputError& error) {
        throw error.within(outer(name, text));
    }
}

}  // namespace beltgrinding

// beltgrinding-cad-reader PARENT FORMAT [PATH]: reads a STEP, IGES or BREP file (without PATH the
// text of a BREP from the standard input) and answers on descriptor 3 with the shape, or with what
// stands against it (cad_answer.h). Started by cad_reader.cpp; its faults are its own.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TopoDS_Shape.hxx>
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <new>
#include <string>
#include <string_view>

#include "beltgrinding/error.h"
#include "cad_answer.h"
#include "child_process.h"
#include "shape_impl.h"
#include "shape_transfer.h"

namespace {

using namespace beltgrinding;

// Value of OpenCASCADE's "read.surfacecurve.mode" that FreeCAD sets: faces must come in its order.
constexpr int kFreecadIgesCurveMode = 3;
constexpr std::array kFaults = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr std::size_t kHandlerStack = 1 << 16;  // bytes; a fault may be the end of the stack itself

void send(const char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t n = write(kAnswerDescriptor, bytes, size);
        if (n < 0 && errno != EINTR) _exit(1);  // nobody listens any more
        if (n <= 0) continue;
        bytes += n;
        size -= std::size_t(n);
    }
}

/// Answers and ends: no destructor of a damaged shape, no static's of a library, is run any more.
[[noreturn]] void answer(CadAnswerKind kind, std::string_view body = {}) {
    CadAnswerHead head;
    head.kind = kind;
    head.size = body.size();
    head.check = cad_answer_check(body);
    send(reinterpret_cast<const char*>(&head), sizeof head);
    send(body.data(), body.size());
    _exit(0);
}

extern "C" void tell_fault(int number) {
    CadAnswerHead head;
    head.kind = CadAnswerKind::kSignal;
    head.signal = number;
    head.check = cad_answer_check({});
    send(reinterpret_cast<const char*>(&head), sizeof head);
    _exit(1);
}

/// The host may reap its children by itself, and then never learns what ended this one.
void catch_faults() {
    static std::array<char, kHandlerStack> memory;
    stack_t stack{};
    stack.ss_sp = memory.data();
    stack.ss_size = memory.size();
    sigaltstack(&stack, nullptr);
    struct sigaction action {};
    action.sa_handler = tell_fault;
    action.sa_flags = SA_ONSTACK | SA_RESETHAND;
    sigemptyset(&action.sa_mask);
    for (const int number : kFaults) sigaction(number, &action, nullptr);
}

/// No core file, and no more memory than the machine has: damaged files ask for any amount.
void limit() {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they map terabytes
    const auto bytes = rlim_t(sysconf(_SC_PHYS_PAGES)) * rlim_t(sysconf(_SC_PAGESIZE));
    rlimit memory{};
    getrlimit(RLIMIT_AS, &memory);
    memory.rlim_cur = std::min(memory.rlim_max, bytes);
    setrlimit(RLIMIT_AS, &memory);
#endif
}

template <class Reader>
TopoDS_Shape read_exchange(const char* path) {
    auto* reader = new Reader;  // never destroyed: of a damaged file that could fail
    if (reader->ReadFile(path) != IFSelect_RetDone) answer(CadAnswerKind::kUnreadable);
    reader->TransferRoots();
    return reader->NbShapes() > 0 ? reader->OneShape() : TopoDS_Shape();
}

TopoDS_Shape read(std::string_view format, const char* path) {
    if (format == "STEP") return read_exchange<STEPControl_Reader>(path);
    if (format == "IGES") {
        IGESControl_Controller::Init();
        Interface_Static::SetIVal("read.surfacecurve.mode", kFreecadIgesCurveMode);
        return read_exchange<IGESControl_Reader>(path);
    }
    std::string text;
    if (path) {
        std::ifstream file(path, std::ios::binary);
        text.assign(std::istreambuf_iterator<char>(file), {});
    } else {
        text.assign(std::istreambuf_iterator<char>(std::cin), {});
    }
    const TopoDS_Shape shape = read_brep_text(text);
    if (shape.IsNull()) answer(CadAnswerKind::kUnreadable);
    return shape;
}

CadFacts facts_of(const TopoDS_Shape& handed_over) {
    CadFacts facts;
    try {
        const Shape shape = make_shape(handed_over, "", MissingCurves::kAreDone);
        facts.valid = shape.valid();
        const Box box = shape.extents();
        facts.extents = {box.min().x(), box.min().y(), box.min().z(),
                         box.max().x(), box.max().y(), box.max().z()};
        facts.meshed = 1;
    } catch (const InputError&) {
        // The host says so when it is asked.
    }
    return facts;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3 || fcntl(kAnswerDescriptor, F_GETFD) < 0) {
        std::cerr << "This program is beltgrinding's own: it reads CAD files for it.\n";
        return 2;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != std::atoi(arguments[1])) return 1;  // the host had ended before
    catch_faults();
    limit();
    try {
        const TopoDS_Shape shape = read(arguments[2], count > 3 ? arguments[3] : nullptr);
        if (shape.IsNull()) answer(CadAnswerKind::kNullShape);
        add_missing_curves(shape);
        const std::string bytes = pack_shape(shape);
        // What fails in the host must fail here: it is tried on what the host will have.
        const CadFacts facts = facts_of(unpack_shape(bytes));
        answer(CadAnswerKind::kShape,
               std::string(reinterpret_cast<const char*>(&facts), sizeof facts) + bytes);
    } catch (const Standard_OutOfMemory&) {
        answer(CadAnswerKind::kMemory);
    } catch (const Standard_Failure& failure) {
        answer(CadAnswerKind::kFailure, failure.GetMessageString());
    } catch (const std::bad_alloc&) {
        answer(CadAnswerKind::kMemory);
    } catch (const std::exception& error) {
        answer(CadAnswerKind::kFailure, error.what());
    }
}

#include "brep/shape_tasks.h"

#include <sys/prctl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <new>

#include "beltgrinding/error.h"
#include "foreign/answer.h"
#include "shape_answer.h"
#include "shape_impl.h"
#include "shape_transfer.h"

namespace beltgrinding {
namespace {

constexpr int kTrialSeconds = 3;  // of processor time, for a face: a sound one takes milliseconds
constexpr int kMostEndless = 2;   // faces; a file with more is not worth the time
constexpr int kNoMemory = 3;      // status of a trial

/// What a trial says of one face, through a pipe.
struct TriedFace {
    double area = kNoArea;  // mm2
    signed char sign = 1;
};

/// What a trial says of the whole shape.
struct TriedWhole {
    bool valid = false, meshed = false;
    std::array<double, 6> extents{};
};

/// OpenCASCADE cannot be stopped, only killed: after so much time, or with what started it.
void limit_trial() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
        std::signal(number, SIG_DFL);
}

void restart_clock() {
    const itimerval limit{{0, 0}, {kTrialSeconds, 0}};
    setitimer(ITIMER_VIRTUAL, &limit, nullptr);
}

template <class T>
void tell(int pipe, const T& value) {
    // Smaller than a pipe's buffer: whole or not at all.
    if (write(pipe, &value, sizeof value) != sizeof value) _exit(1);
}

template <class T>
bool hear(int pipe, T& value) {
    std::size_t done = 0;
    while (done < sizeof value) {
        const ssize_t n = read(pipe, reinterpret_cast<char*>(&value) + done, sizeof value - done);
        if (n <= 0) return false;
        done += std::size_t(n);
    }
    return true;
}

/// Asks for the whole, unless `first` is above 0, and for the faces from `first` on.
[[noreturn]] void try_out(const Shape& shape, bool whole, std::size_t first, int pipe) {
    limit_trial();
    try {
        restart_clock();
        if (whole) {
            TriedWhole told;
            told.valid = shape.valid();
            try {
                const Box box = shape.extents();
                Eigen::Map<Vec3>(told.extents.data()) = box.min();
                Eigen::Map<Vec3>(told.extents.data() + 3) = box.max();
                told.meshed = true;
            } catch (const InputError&) {
                // The host says so when it is asked.
            }
            tell(pipe, told);
        }
        for (std::size_t face = first; face < shape.face_count(); ++face) {
            restart_clock();
            TriedFace told;
            try {
                told.area = shape.face_area(face);
                if (!std::isfinite(told.area)) told.area = std::numeric_limits<double>::quiet_NaN();
            } catch (const InputError&) {
                told.area = kNoArea;
            }
            told.sign = shape.impl().inside_out(face) ? -1 : 1;
            tell(pipe, told);
        }
    } catch (const std::bad_alloc&) {
        _exit(kNoMemory);
    } catch (...) {
        std::abort();
    }
    _exit(0);
}

/// All that the host will ask of the shape, asked in a process of its own: what has no end there
/// costs the answer to that question, not the file.
TriedShape tried(const TopoDS_Shape& handed_over) {
    const Shape shape = make_shape(handed_over, "shape", MissingCurves::kAreDone);
    TriedShape found;
    found.areas.assign(shape.face_count(), kEndlessArea);
    found.signs.assign(shape.impl().solids.size(), 0);
    bool whole = true;
    std::size_t face = 0;
    for (int endless = 0; endless < kMostEndless && (whole || face < shape.face_count());) {
        std::array<int, 2> ends{};
        if (pipe(ends.data()) != 0) throw std::bad_alloc();
        const pid_t trial = fork();
        if (trial < 0) throw std::bad_alloc();
        if (trial == 0) {
            close(ends[0]);
            try_out(shape, whole, face, ends[1]);
        }
        close(ends[1]);
        TriedWhole all;
        if (whole && hear(ends[0], all)) {
            found.valid = all.valid;
            const auto& e = all.extents;
            if (all.meshed) found.extents = Box(Vec3(e[0], e[1], e[2]), Vec3(e[3], e[4], e[5]));
            whole = false;
        }
        TriedFace told;
        while (!whole && face < shape.face_count() && hear(ends[0], told)) {
            const int solid = shape.impl().solid_of_face[face];
            if (solid >= 0) found.signs[std::size_t(solid)] = told.sign;
            found.areas[face++] = told.area;
        }
        close(ends[0]);
        int status = 0;
        while (waitpid(trial, &status, 0) < 0 && errno == EINTR) {
        }
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
        if (WIFEXITED(status)) throw std::bad_alloc();
        if (WTERMSIG(status) != SIGVTALRM) std::raise(WTERMSIG(status));  // as a fault of this one
        ++endless;
        if (whole) {
            whole = false;
        } else {
            ++face;
        }
    }
    return found;
}

}  // namespace

std::string shape_answer(const TopoDS_Shape& shape) {
    add_missing_curves(shape);
    const std::string bytes = pack_shape(shape);
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    if (faces.IsEmpty()) return pack_tried(std::nullopt) + bytes;  // the host says so
    // What fails in the host must fail here: it is tried on what the host will have.
    return pack_tried(tried(unpack_shape(bytes))) + bytes;
}

std::string triangulation_answer(std::string_view input) {
    MeshingParameters parameters;
    if (!take_bytes(input, parameters)) throw Standard_Failure("nothing to triangulate");
    return pack_shape(triangulated_copy(unpack_shape(input), parameters));
}

std::string faces_answer(std::string_view input) {
    const std::optional<TriangleMesh> mesh = unpack_triangles(input);
    if (!mesh) throw Standard_Failure("no mesh to make faces of");
    return pack_tried(std::nullopt) + pack_shape(faces_of_mesh(*mesh).impl().shape);
}

}  // namespace beltgrinding

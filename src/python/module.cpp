#if __has_include(<embree4/rtcore_config.h>)
#include <embree4/rtcore_config.h>
#else
#include <embree3/rtcore_config.h>
#endif

#include "arrays.h"
#include "base/threads.h"
#include "beltgrinding/run_context.h"
#include "facts.h"
#include "heightfield/kdop_tree.h"

namespace beltgrinding::python {

Frame frame_from(const Eigen::Matrix4d& matrix, const std::string& name,
                 const std::optional<Fact>& context) {
    const Eigen::Matrix3d r = matrix.topLeftCorner<3, 3>();
    const bool rigid = matrix.allFinite() && (r.transpose() * r).isIdentity(1e-6) &&
                       r.determinant() > 0.0 &&
                       matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1));
    if (!rigid) {
        const InputError error("call.frame",
                               "{name} is no rigid transform (4 x 4, rotation and translation)",
                               {{"name", name}});
        throw context ? error.within(*context) : error;
    }
    return Frame(matrix);
}

std::vector<Frame> poses_from(const Doubles& frames) {
    if (frames.ndim() != 3 || frames.shape(1) != 4 || frames.shape(2) != 4)
        throw InputError("call.frames", "frames must have the shape (n, 4, 4)");
    std::vector<Frame> poses(static_cast<std::size_t>(frames.shape(0)));
    using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i] = frame_from(Eigen::Map<const Rows>(frames.data() + 16 * i), "frame",
                              Fact{"call.pose", "pose {pose}: ", {{"pose", i + 1}}});
    return poses;
}

void bind_base(py::module_& m) {
    define_facts(m);
    static PyObject* const input_error = py::object(m.attr("InputError")).release().ptr();
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(std::move(thrown));
        } catch (const InputError& error) {
            raise(error, input_error);
        }
    });
    py::register_exception<Cancelled>(m, "Cancelled", PyExc_Exception);
    py::class_<RunContext>(m, "RunContext", "Progress and cancellation of one long call.")
        .def(py::init<>())
        .def("cancel", &RunContext::cancel, "Asks the call to end; from any thread.")
        .def("part", &RunContext::part, py::arg("begin"), py::arg("end"),
             "A context whose [0, 1] is shown as [begin, end] of this one's.")
        .def("report", &RunContext::report, py::arg("done"))
        .def("throw_if_cancelled", &RunContext::throw_if_cancelled)
        .def_property_readonly("cancelled", &RunContext::cancelled)
        .def_property_readonly("progress", &RunContext::progress, "In [0, 1].");
    m.attr("VERSION") = BELTGRINDING_VERSION;
    m.def(
        "set_threads",
        [](int count) {
            if (count < 0)
                throw InputError("call.threads", "the number of threads must not be negative");
            set_threads(static_cast<std::size_t>(count));
        },
        py::arg("count"),
        "How many threads computations may use from now on; 0: as many as the machine has. The "
        "results do not depend on it.");
    m.def("threads", &threads, "How many threads a computation may use.");
    m.def(
        "versions",
        [] {
            py::dict v;
            v["beltgrinding"] = BELTGRINDING_VERSION;
            v["eigen"] = std::to_string(EIGEN_WORLD_VERSION) + "." +
                         std::to_string(EIGEN_MAJOR_VERSION) + "." +
                         std::to_string(EIGEN_MINOR_VERSION);
            v["embree"] = RTC_VERSION_STRING;
            v["opencascade"] = BELTGRINDING_OCCT_VERSION;
            v["kdop_k"] = BELTGRINDING_KDOP_K;
            return v;
        },
        "Versions of this library and of what it was built with.");
}

}  // namespace beltgrinding::python

PYBIND11_MODULE(beltgrinding_core, m) {
    m.doc() = "Robotic belt-grinding simulation. Millimetre, newton, second, megapascal, radian.";
    using namespace beltgrinding::python;
    bind_base(m);
    bind_geometry(m);
    bind_height_field(m);
    bind_contact(m);
    bind_surrogate(m);
    bind_calibration(m);
    bind_events(m);
    bind_recording(m);
    bind_heat(m);
    bind_simulation(m);
    bind_planning(m);
    bind_inspection(m);
    bind_ground_mesh(m);
    bind_section(m);
    bind_picture(m);
    bind_thinning(m);
    bind_verdict(m);
    bind_robot(m);
    bind_collision(m);
    bind_toolpath(m);
    bind_posture(m);
}

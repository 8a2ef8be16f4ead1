// The binding `beltgrinding_scan`: apart from the core, since it is optional when built.
#include "arrays.h"
#include "beltgrinding/registration.h"
#include "facts.h"

namespace {

using namespace beltgrinding;
using namespace beltgrinding::python;

std::vector<Vec3> points_from(const Doubles& array, const char* what) {
    if (array.size() == 0) return {};
    if (array.ndim() != 2 || array.shape(1) != 3)
        throw InputError("call.points", "{name} must be of shape (n, 3)", {{"name", what}});
    std::vector<Vec3> points(static_cast<std::size_t>(array.shape(0)));
    std::copy_n(array.data(), array.size(), reinterpret_cast<double*>(points.data()));
    return points;
}

std::vector<Vec3f> normals_from(const Doubles& array, const char* what) {
    std::vector<Vec3f> normals;
    for (const Vec3& n : points_from(array, what)) normals.push_back(n.cast<float>());
    return normals;
}

}  // namespace

PYBIND11_MODULE(beltgrinding_scan, m) {
    m.doc() = "Alignment of scans. Millimetre, radian.";
    // The core's own exceptions: whoever catches them must not care which module threw.
    const py::module_ core = py::module_::import("beltgrinding_core");
    static PyObject* const input_error = py::object(core.attr("InputError")).release().ptr();
    static PyObject* const cancelled = py::object(core.attr("Cancelled")).release().ptr();
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(std::move(thrown));
        } catch (const InputError& error) {
            raise(error, input_error);
        } catch (const Cancelled& error) {
            PyErr_SetString(cancelled, error.what());
        }
    });
    m.def(
        "register_scan",
        [](const Doubles& scan, const Doubles& scan_normals, const Doubles& datum,
           const Doubles& datum_normals, double spacing, const Eigen::Matrix4d& start,
           double max_distance, double share, const std::array<bool, 6>& fixed, int iterations,
           std::size_t most_points) {
            const ScanPoints source{points_from(scan, "scan"),
                                    normals_from(scan_normals, "scan_normals")};
            const DatumSurface target{points_from(datum, "datum"),
                                      normals_from(datum_normals, "datum_normals"), spacing};
            RegistrationOptions options;
            options.start = Frame(start);
            options.max_distance = max_distance;
            options.share = share;
            options.fixed = fixed;
            options.iterations = iterations;
            options.most_points = most_points;
            Registration r;
            {
                const py::gil_scoped_release release;
                r = register_scan(source, target, options);
            }
            py::dict d;
            d["work_from_scan"] = r.work_from_scan.matrix();
            d["rms"] = r.rms;
            d["distance"] = r.distance;
            d["used"] = r.used;
            d["used_share"] = r.used_share;
            d["iterations"] = r.iterations;
            d["converged"] = r.converged;
            d["centre"] = r.centre;
            d["sd"] = r.sd;
            d["undetermined"] = r.undetermined;
            return d;
        },
        py::arg("scan"), py::arg("scan_normals"), py::arg("datum"), py::arg("datum_normals"),
        py::arg("spacing"), py::arg("start"), py::arg("max_distance"), py::arg("share"),
        py::arg("fixed"), py::arg("iterations") = 100, py::arg("most_points") = 100'000,
        "Points (n, 3) mm and unit normals ((0, 3): not known) of the scan and of the datum; "
        "start: "
        "work_from_scan (4, 4). Returns a dict of work_from_scan, rms, used_share, sd, "
        "undetermined, ...");
    m.def(
        "measure_cloud",
        [](const Doubles& cloud, const Doubles& points, const Doubles& normals,
           const std::vector<double>& start, double reach, std::size_t neighbours) {
            const auto in = points_from(cloud, "cloud");
            const auto at = points_from(points, "points");
            const auto along = normals_from(normals, "normals");
            std::vector<double> heights;
            {
                const py::gil_scoped_release release;
                heights = measure_cloud(in, at, along, start, reach, neighbours);
            }
            return own(std::move(heights));
        },
        py::arg("cloud"), py::arg("points"), py::arg("normals"), py::arg("start"), py::arg("reach"),
        py::arg("neighbours") = 12,
        "(n,) heights in mm of a cloud, in the work frame, along the normals; NaN where there is "
        "none within reach.");
}

#include "belt/face_arc.h"
#include "dict.h"
#include "gap/wheel_fit.h"
#include "raster/raster.h"
#include "simulation_settings.h"

namespace beltgrinding::python {
namespace {

using Indices = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

void check_rows(const py::array& array, py::ssize_t columns, const char* name) {
    if (array.ndim() != 2 || array.shape(1) != columns) {
        throw InputError("call.rows", "{name} must have the shape (n, {columns})",
                         {{"name", name}, {"columns", columns}});
    }
}

std::vector<Vec3> vectors(const Doubles& array, const char* name) {
    check_rows(array, 3, name);
    std::vector<Vec3> result(static_cast<std::size_t>(array.shape(0)));
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = Eigen::Map<const Vec3>(array.data() + 3 * i);
    return result;
}

py::array_t<double> rows(const std::vector<Vec3>& data, const std::vector<std::size_t>& chosen) {
    py::array_t<double> array({static_cast<py::ssize_t>(chosen.size()), py::ssize_t{3}});
    for (std::size_t i = 0; i < chosen.size(); ++i)
        Eigen::Map<Vec3>(array.mutable_data() + 3 * i) = data[chosen[i]];
    return array;
}

RasterSurface surface_from(const Doubles& points, const Doubles& normals, const Indices& triangles,
                           const Doubles& scalars, double period) {
    RasterSurface surface;
    surface.point = vectors(points, "points");
    surface.normal = vectors(normals, "normals");
    check_rows(triangles, 3, "triangles");
    check_rows(scalars, 3, "scalars");
    const auto count = static_cast<std::size_t>(triangles.shape(0));
    if (static_cast<std::size_t>(scalars.shape(0)) != count)
        throw InputError("call.scalars", "scalars needs a row for every triangle");
    surface.triangles.resize(count);
    surface.scalar.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::copy_n(triangles.data() + 3 * i, 3, surface.triangles[i].begin());
        std::copy_n(scalars.data() + 3 * i, 3, surface.scalar[i].begin());
    }
    surface.period = period;
    return surface;
}

py::dict raster(const Doubles& points, const Doubles& normals, const Indices& triangles,
                const Doubles& scalars, double period, double step_over, const std::string& spacing,
                double weld, double split_turn, double smoothing, double chord_error,
                double max_distance, double max_turn, double lever, const RunContext* given,
                const Bools& wanted) {
    RasterSurface surface = surface_from(points, normals, triangles, scalars, period);
    surface.wanted.assign(wanted.data(), wanted.data() + wanted.size());
    RasterOptions options;
    options.step_over = step_over;
    if (spacing == "even") {
        options.spacing = RasterSpacing::kEven;
    } else if (spacing != "lines") {
        throw InputError("call.raster_spacing", "spacing is '{name}'; use lines or even",
                         {{"name", spacing}});
    }
    options.weld = weld;
    options.split_turn = split_turn;
    options.smoothing = smoothing;
    const PoseSpacing pose_spacing{chord_error, max_distance, max_turn, lever};
    RasterLines found;
    std::vector<std::vector<std::size_t>> kept;
    {
        const py::gil_scoped_release release;
        found = raster_lines(surface, options, given != nullptr ? *given : RunContext());
        for (const RasterLine& line : found.lines) kept.push_back(thin(line, pose_spacing));
    }
    py::list lines;
    for (std::size_t i = 0; i < found.lines.size(); ++i) {
        const RasterLine& line = found.lines[i];
        py::dict d;
        d["points"] = rows(line.point, kept[i]);
        d["normals"] = rows(line.normal, kept[i]);
        d["tangents"] = rows(line.tangent, kept[i]);
        d["level"] = line.level;
        d["closed"] = line.closed;
        lines.append(d);
    }
    py::dict result;
    result["lines"] = lines;
    result["distance"] = own(std::move(found.distance));
    result["uncovered_area"] = found.uncovered_area;
    result["area"] = found.area;
    return result;
}

}  // namespace

void bind_toolpath(py::module_& m) {
    m.def("raster_lines", &raster, py::arg("points"), py::arg("normals"), py::arg("triangles"),
          py::arg("scalars"), py::arg("period") = 0.0, py::arg("step_over") = 10.0,
          py::arg("spacing") = "lines", py::arg("weld") = 0.0, py::arg("split_turn") = 0.7,
          py::arg("smoothing") = 0.0, py::arg("chord_error") = 0.02, py::arg("max_distance") = 10.0,
          py::arg("max_turn") = 0.1, py::arg("lever") = 0.0, py::arg("context") = nullptr,
          py::arg("wanted") = Bools(),
          "Passes on a triangulated surface: level lines of a scalar that is given at the three "
          "corners of every triangle. points, normals (n, 3), triangles, scalars (m, 3); lengths "
          "in mm, angles in rad; wanted: (m,) bool, of the triangles those on which lines are, "
          "empty: "
          "all. Returns dict(lines: list of dict(points, normals, tangents "
          "(k, 3), level, closed), distance (levels,) mm, uncovered_area, area mm2).");
    m.def(
        "wheel_fit",
        [](const py::object& wheel, const Doubles& frames, const Doubles& points,
           const Doubles& normals, const RunContext* context, bool whole) {
            const ContactWheel shape = wheel_from(Record(wheel));
            const std::vector<Frame> poses = poses_from(frames);
            const auto point = vectors(points, "points"), normal = vectors(normals, "normals");
            std::vector<double> depth;
            {
                const py::gil_scoped_release release;
                depth = wheel_fit(shape, poses, point, normal,
                                  context != nullptr ? *context : RunContext(), whole);
            }
            return own(std::move(depth));
        },
        py::arg("wheel"), py::arg("work_from_contact"), py::arg("points"), py::arg("normals"),
        py::arg("context") = nullptr, py::arg("whole") = false,
        "How deep the undeformed wheel, or with whole=False its half that faces the work, reaches "
        "into a surface at each pose, mm (n,).");
    m.def(
        "run_fit",
        [](const py::object& machine, double behind, const Doubles& frames, const Doubles& points,
           const RunContext* context) {
            const BeltMachine belt = machine_from(Record(machine));
            belt.validate();
            const FlatRun run{belt.run.length, -belt.run.position, belt.belt.width, behind,
                              face_arc(belt)};
            const std::vector<Frame> poses = poses_from(frames);
            const auto point = vectors(points, "points");
            std::vector<double> depth;
            {
                const py::gil_scoped_release release;
                depth = run_fit(run, poses, point, context != nullptr ? *context : RunContext());
            }
            return own(std::move(depth));
        },
        py::arg("machine"), py::arg("behind"), py::arg("work_from_contact"), py::arg("points"),
        py::arg("context") = nullptr,
        "How deep points reach through the belt of a free belt or a platen (a job's "
        "belt_machine), which touches nothing, into the `behind` mm that lie behind it at each "
        "pose, "
        "mm (n,).");
}

}  // namespace beltgrinding::python

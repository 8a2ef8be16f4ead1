#include <numbers>

#include "contact/displaced.h"
#include "dict.h"
#include "models/press_belt.h"
#include "models/single_contact.h"
#include "simulation_settings.h"
#include "surrogate/regression.h"

namespace beltgrinding::python {

void refuse_rest(const py::dict& d, const char* where) {
    if (d.empty()) return;
    throw InputError("call.unknown_key", "{where}: unknown key '{key}'",
                     {{"where", where}, {"key", py::str((*d.begin()).first).cast<std::string>()}});
}

py::dict copy_of(const py::dict& d) {
    return d.attr("copy")().cast<py::dict>();
}

namespace {

constexpr double kUsualForce = 50.0;  // N, for a foundation as stiff as the rim if none is given

Workpiece workpiece_from(const py::dict& given) {
    py::dict d = copy_of(given);
    Workpiece workpiece;
    workpiece.shape = Workpiece::shape_named(take<std::string>(d, "shape", "plane"));
    workpiece.radius = take(d, "radius", workpiece.radius);
    workpiece.width = take(d, "width", workpiece.width);
    workpiece.ring_radius = take(d, "ring_radius", workpiece.ring_radius);
    workpiece.edge = take(d, "edge", workpiece.edge);
    workpiece.tilt = take(d, "tilt_deg", 0.0) * std::numbers::pi / 180.0;
    workpiece.axis_angle = take(d, "axis_angle_deg", 0.0) * std::numbers::pi / 180.0;
    refuse_rest(d, "workpiece");
    return workpiece;
}

}  // namespace

py::array_t<double> cells(const ContactGrid& grid, const Eigen::ArrayXd& values) {
    py::array_t<double> array({grid.ny, grid.nx});
    Eigen::Map<Eigen::ArrayXd>(array.mutable_data(), grid.cells()) = values;
    return array;
}

py::dict contact_to_dict(const ContactGrid& grid, const ContactSolution& solution) {
    py::array_t<double> s(grid.nx), y(grid.ny);
    for (int i = 0; i < grid.nx; ++i) s.mutable_at(i) = grid.s(i);
    for (int j = 0; j < grid.ny; ++j) y.mutable_at(j) = grid.y(j);
    py::dict d;
    d["x"] = s;
    d["y"] = y;
    d["pressure"] = cells(grid, solution.pressure);
    d["cell_area"] = grid.cell_area();
    d["force"] = solution.force;
    d["approach"] = solution.approach;
    d["contact_area"] = solution.area;
    d["peak_pressure"] = solution.peak_pressure;
    d["iterations"] = solution.iterations;
    d["converged"] = solution.converged;
    return d;
}

void add_displaced(py::dict& d, const ContactGrid& grid, const ContactSolution& solution,
                   const Eigen::ArrayXd& coverage) {
    const DisplacedPressure found = displaced(grid, solution, coverage);
    d["displaced_pressure"] = cells(grid, found.pressure);
    py::array_t<double> beside({2, grid.nx}), reach({2, grid.nx});
    const auto fill = [](py::array_t<double>& array, const Eigen::ArrayXd& values) {
        Eigen::Map<Eigen::ArrayXd> to(array.mutable_data(), array.size());
        if (values.size() == to.size())
            to = values;
        else
            to.setZero();
    };
    fill(beside, found.beside);
    fill(reach, found.reach);
    d["beside"] = beside;
    d["reach"] = reach;
}

void bind_contact(py::module_& m) {
    m.def(
        "check_wheel", [](const py::object& wheel) { wheel_from(Record(wheel)).validate(); },
        py::arg("wheel"), "Raises InputError for a wheel that cannot be.");
    m.def(
        "single_contact",
        [](const py::object& wheel, const py::dict& workpiece, const py::object& elasticity,
           std::optional<double> force, std::optional<double> approach, double spacing,
           double tolerance) {
            SingleContact contact;
            contact.wheel = wheel_from(Record(wheel));
            contact.workpiece = workpiece_from(workpiece);
            if (force.has_value() == approach.has_value()) {
                throw InputError("call.force_or_approach",
                                 "contact: give either a force or an approach");
            }
            contact.force_control = force.has_value();
            contact.force = force.value_or(0.0);
            contact.approach = approach.value_or(0.0);
            contact.spacing = spacing;
            contact.tolerance = tolerance;
            const auto elastic =
                compliance_from(Record(elasticity), contact.wheel, force.value_or(kUsualForce));
            SingleContactResult result;
            {
                const py::gil_scoped_release release;
                result = press(contact, *elastic);
            }
            py::dict d = contact_to_dict(result.grid, result.solution);
            d["gap"] = cells(result.grid, result.gap);
            d["coverage"] = cells(result.grid, result.coverage);
            add_displaced(d, result.grid, result.solution, result.coverage);
            d["beyond_placed"] = 0.0;
            d["time"] = result.time;
            d["model"] = result.model;
            return d;
        },
        py::arg("wheel"), py::arg("workpiece"), py::arg("elasticity"),
        py::arg("force") = py::none(), py::arg("approach") = py::none(), py::arg("spacing") = 0.5,
        py::arg("tolerance") = 1e-4,
        "One contact of a wheel with an analytic workpiece: dict(x (nx,) along the circumference, "
        "y (ny,), pressure (ny, nx) MPa, force N, approach mm from first touch, contact_area mm2, "
        "peak_pressure, iterations, converged, time s of all solves, model; displaced_pressure "
        "(ny, "
        "nx), where the rubber has moved to, and beyond the side faces at -y and +y: beside (2, "
        "nx) "
        "MPa, up to reach (2, nx) mm).");
    m.def(
        "press_belt",
        [](const py::object& machine, double first, double second, double angle,
           std::optional<double> force, std::optional<double> approach, double tolerance) {
            if (force.has_value() == approach.has_value()) {
                throw InputError("call.force_or_approach",
                                 "contact: give either a force or an approach");
            }
            PressedBelt pressed;
            pressed.machine = machine_from(Record(machine));
            pressed.first = first;
            pressed.second = second;
            pressed.angle = angle;
            pressed.force_control = force.has_value();
            pressed.force = force.value_or(0.0);
            pressed.approach = approach.value_or(0.0);
            pressed.tolerance = tolerance;
            SingleContactResult result;
            {
                const py::gil_scoped_release release;
                result = press(pressed);
            }
            py::dict d = contact_to_dict(result.grid, result.solution);
            d["gap"] = cells(result.grid, result.gap);
            d["coverage"] = cells(result.grid, result.coverage);
            return d;
        },
        py::arg("machine"), py::arg("first"), py::arg("second"), py::arg("angle") = 0.0,
        py::arg("force") = py::none(), py::arg("approach") = py::none(),
        py::arg("tolerance") = 1e-3,
        "A free belt or a platen (a job's belt_machine) on a part with the curvatures "
        "first, 1/mm, positive: convex, along the direction at angle (rad) to the belt's travel, "
        "and second, square to it: as single_contact, gap and coverage (ny, nx); x along the "
        "belt.");
}

}  // namespace beltgrinding::python

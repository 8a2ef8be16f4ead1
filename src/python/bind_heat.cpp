#include <vector>

#include "arrays.h"
#include "beltgrinding/heat.h"

namespace beltgrinding::python {

void bind_heat(py::module_& m) {
    py::class_<PartHeat>(m, "PartHeat",
                         "The heat in a part that is ground, from program to program.")
        .def(py::init([](const HeightField& field, double spacing, double conductivity,
                         double heat_capacity, double density) {
                 const py::gil_scoped_release release;
                 return PartHeat(field, spacing, {conductivity, heat_capacity, density});
             }),
             py::arg("field"), py::arg("spacing"), py::arg("conductivity"),
             py::arg("heat_capacity"), py::arg("density"),
             "spacing mm between its nodes; W/(m K), J/(kg K), kg/m3. Raises InputError.")
        .def("__len__", &PartHeat::size)
        .def("copy", [](const PartHeat& heat) { return PartHeat(heat); })
        .def_property_readonly("spacing", &PartHeat::spacing, "mm")
        .def_property_readonly("bytes", &PartHeat::bytes)
        .def_property_readonly(
            "samples",
            [](const PartHeat& heat) { return own(std::vector<std::uint32_t>(heat.samples())); },
            "(nodes,): the sample that each node is.")
        .def_property_readonly(
            "conductivity", [](const PartHeat& heat) { return heat.material().conductivity; },
            "W/(m K)")
        .def_property_readonly(
            "heat_capacity", [](const PartHeat& heat) { return heat.material().heat_capacity; },
            "J/(kg K)")
        .def_property_readonly(
            "density", [](const PartHeat& heat) { return heat.material().density; }, "kg/m3")
        .def_property_readonly(
            "thickness",
            [](const PartHeat& heat) { return own(std::vector<float>(heat.thickness())); },
            "(nodes,) mm: the section's under each node; infinite: a half-space.")
        .def("set_thickness", &PartHeat::set_thickness, py::arg("thickness"),
             "(nodes,) mm: the section's under each node; NaN: a half-space. Before any heat.");
}

}  // namespace beltgrinding::python

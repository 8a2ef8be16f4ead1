#include <limits>

#include "arrays.h"
#include "beltgrinding/height_field.h"
#include "beltgrinding/stock.h"
#include "facts.h"
#include "hdf5_files.h"
#include "heightfield/sound_field.h"
#include "heightfield/spread.h"

namespace beltgrinding::python {
namespace {

py::dict to_dict(const StockReport& report) {
    py::dict d;
    d["missed"] = report.missed;
    d["defective"] = report.defective;
    d["volume"] = report.volume;
    d["warnings"] = to_list(report.warnings);
    return d;
}

}  // namespace

void bind_height_field(py::module_& m) {
    m.attr("NEVER") = RemovalTrace::kNever;
    m.attr("ON_BOUNDARY") = static_cast<int>(kOnBoundary);
    m.attr("MISSED") = static_cast<int>(kMissed);
    m.attr("DEFECTIVE") = static_cast<int>(kDefective);
    m.attr("DEGENERATE") = static_cast<int>(kDegenerate);

#define BELTGRINDING_VIEW(name, member, Scalar, row)                      \
    def_property_readonly(name, [](const py::object& self) {              \
        return view<Scalar>(self.cast<HeightField&>().member, row, self); \
    })
    py::class_<HeightField> bound(m, "HeightField",
                                  "Samples of the design surface and the stock on them; arrays are "
                                  "read-only views in mm, work frame.");
    bound.def_property_readonly("size", &HeightField::size)
        .def_property_readonly("bytes", &HeightField::bytes)
        .def_readonly("spacing", &HeightField::spacing)
        .def_readonly("depth", &HeightField::depth)
        .BELTGRINDING_VIEW("points", point, double, 3)
        .BELTGRINDING_VIEW("normals", normal, float, 3)
        .def_property_readonly(
            "rays",
            [](const py::object& self) {
                const auto& field = self.cast<const HeightField&>();
                return view<float>(field.rays.empty() ? field.normal : field.rays, 3, self);
            },
            "(n, 3): along which heights are measured, from the points; the normals, but beside "
            "sharp edges between faces, where they lean towards the edge's bisector and are longer "
            "than 1, so that a height is the part along the normal.")
        .BELTGRINDING_VIEW("areas", area, float, 1)
        .BELTGRINDING_VIEW("stock_height", stock_height, float, 1)
        .BELTGRINDING_VIEW("height", height, double, 1)
        .BELTGRINDING_VIEW("height_sd", height_sd, float, 1)
        .BELTGRINDING_VIEW("height_error", height_error, float, 1)
        .BELTGRINDING_VIEW("measured", measured, float, 1)
        .BELTGRINDING_VIEW("faces", face, std::uint32_t, 1)
        .BELTGRINDING_VIEW("flags", flags, std::uint8_t, 1)
        .def_property_readonly(
            "triangles",
            [](const HeightField& field) {
                py::array_t<std::uint32_t> all(
                    {static_cast<py::ssize_t>(field.triangles.size()), py::ssize_t{3}});
                std::uint32_t* out = all.mutable_data();
                for (const Triangle& triangle : field.triangles)
                    out = std::copy(triangle.begin(), triangle.end(), out);
                all.attr("flags").attr("writeable") = false;
                return all;
            },
            "(m, 3) uint32 between samples; unpacked at each look, unlike the other arrays.")
        .def_property_readonly(
            "trace",
            [](const py::object& self) -> py::object {
                const RemovalTrace& trace = self.cast<const HeightField&>().trace;
                if (trace.empty()) return py::none();
                py::dict d;
                d["first"] = view<std::uint32_t>(trace.first, 1, self);
                d["last"] = view<std::uint32_t>(trace.last, 1, self);
                d["dominant"] = view<std::uint32_t>(trace.dominant, 1, self);
                d["dominant_depth"] = view<float>(trace.dominant_depth, 1, self);
                d["peak_pressure"] = view<float>(trace.peak_pressure, 1, self);
                return d;
            },
            "Which motions removed from each sample: a dict of (n,) arrays first, last, dominant "
            "(numbers of motions through all programs from 0; NEVER: none), dominant_depth (mm "
            "that the dominant one removed), peak_pressure (MPa, largest that the sample saw); "
            "None where it was not kept.")
        .def_property_readonly(
            "heat",
            [](const py::object& self) -> py::object {
                const HeatTrace& heat = self.cast<const HeightField&>().heat;
                if (heat.empty()) return py::none();
                py::dict d;
                d["rise"] = view<float>(heat.rise, 1, self);
                d["motion"] = view<std::uint32_t>(heat.motion, 1, self);
                return d;
            },
            "How hot each sample became: a dict of (n,) arrays rise (K, greatest above the start's "
            "temperature) and motion (as in trace, at that moment; NEVER: no heat came there); "
            "None where it was not computed.")
        .def_property_readonly(
            "finish",
            [](const py::object& self) -> py::object {
                const FinishTrace& finish = self.cast<const HeightField&>().finish;
                if (finish.empty()) return py::none();
                std::vector<float> roughness(finish.settled.size());
                for (std::size_t i = 0; i < roughness.size(); ++i)
                    roughness[i] = finish.roughness(i);
                py::dict d;
                d["roughness"] = own(std::move(roughness));
                d["settled"] = view<float>(finish.settled, 1, self);
                d["unknown"] = view<float>(finish.unknown, 1, self);
                d["lay"] = view<float>(finish.lay, 3, self);
                d["crossing"] = view<float>(finish.crossing, 1, self);
                d["passes"] = view<std::uint32_t>(finish.passes, 1, self);
                d["motion"] = view<std::uint32_t>(finish.motion, 1, self);
                d["outside"] = view<std::uint8_t>(finish.outside, 1, self);
                return d;
            },
            "What finish the passes left: a dict of (n,) arrays roughness (Ra, um; NaN: not "
            "known), settled and unknown (of which it is made: um, share), crossing (rad between "
            "the scratches of the last two passes; NaN: fewer), "
            "passes (how many), motion (of the last pass, as in trace; NEVER: none), outside (what "
            "of the last pass was not measured: 0 nothing, 1 pressure, 2 belt speed, 3 feed, 4 "
            "wear), and lay (n, 3), along which the last pass scratched (unit, work frame; 0: no "
            "pass); None where it was not computed.")
        .def("check", &check_sound,
             "Raises RuntimeError naming what of it no reader of its file would take: a fault of "
             "the program.")
        .def("copy", [](const HeightField& field) { return HeightField(field); })
        .def(
            "set_height",
            [](HeightField& field, const py::array_t<double, py::array::forcecast>& height) {
                if (height.ndim() != 1 || static_cast<std::size_t>(height.size()) != field.size()) {
                    throw InputError("call.heights", "set_height needs one value per sample");
                }
                const auto values = height.unchecked<1>();
                for (std::size_t i = 0; i < field.size(); ++i) {
                    const double value = values(static_cast<py::ssize_t>(i));
                    if (!std::isfinite(value)) {
                        throw InputError("call.height", "height {index} is not finite",
                                         {{"index", i}});
                    }
                }
                for (std::size_t i = 0; i < field.size(); ++i) {
                    field.height[i] = values(static_cast<py::ssize_t>(i));
                }
            },
            py::arg("height"))
        .def(
            "set_height_sd",
            [](HeightField& field, const std::vector<float>& sd, double freedom) {
                if (sd.size() != field.size()) {
                    throw InputError("call.height_sd", "set_height_sd needs one value per sample");
                }
                field.height_sd = sd;
                field.sd_freedom = freedom;
            },
            py::arg("sd"), py::arg("freedom") = std::numeric_limits<double>::infinity(),
            "Standard deviation of every height, mm: the scale of Student's t with degrees of "
            "freedom, inf: of a normal distribution.")
        .def_readonly("sd_freedom", &HeightField::sd_freedom)
        .def(
            "set_height_error",
            [](HeightField& field,
               const py::array_t<float, py::array::c_style | py::array::forcecast>& given,
               int rings) {
                std::vector<float> error(given.data(), given.data() + given.size());
                for (const float one : error) {
                    if (!(one >= 0.0F) || std::isinf(one)) {
                        throw InputError("call.height_error",
                                         "the error of a height is no length of 0 or more");
                    }
                }
                spread_largest(field, error, rings);
                field.height_error = std::move(error);
            },
            py::arg("error"), py::arg("rings") = 0,
            "Estimate of what the contact's cells leave open of every height, mm, 0 or more: each "
            "the largest of the samples that up to so many sides of triangles lead to.")
        .def(
            "set_measured",
            [](HeightField& field, const std::vector<float>& measured) {
                if (!measured.empty() && measured.size() != field.size()) {
                    throw InputError("call.measured",
                                     "set_measured needs one value per sample, or none");
                }
                for (const float height : measured) {
                    if (std::isinf(height))
                        throw InputError("call.measured_height", "a measured height is not finite");
                }
                field.measured = measured;
            },
            py::arg("measured"), "Height of a scan over every sample, mm; NaN: not scanned.");
    bind_hdf5<HeightField>(bound, "Returns (HeightField, attributes).", &read_hdf5,
                           &read_hdf5_image);
#undef BELTGRINDING_VIEW

    m.def(
        "apply_allowance",
        [](HeightField& field, double allowance) {
            return to_dict(apply_allowance(field, allowance));
        },
        py::arg("field"), py::arg("allowance"), "Uniform stock, mm.");
    m.def(
        "add_stock",
        [](HeightField& field, const std::vector<double>& thickness) {
            return to_dict(add_stock(field, thickness));
        },
        py::arg("field"), py::arg("thickness"),
        "More stock on that which is there, (n,) mm; where rays missed it stays so.");
    m.def(
        "apply_left",
        [](HeightField& field, const HeightField& left, bool finish, const RunContext* context) {
            StockReport report;
            {
                const py::gil_scoped_release release;
                report =
                    apply_left(field, left, finish, context != nullptr ? *context : RunContext());
            }
            return to_dict(report);
        },
        py::arg("field"), py::arg("left"), py::arg("finish") = false, py::arg("context") = nullptr,
        "What an earlier run of the same design left: heights, flags and, if wanted, finish.");
    m.def(
        "apply_mesh",
        [](HeightField& field, const TriangleMesh& mesh, double above, double below,
           const RunContext* context, double least_cosine, double unit) {
            StockOptions options;
            options.search_above = above;
            options.search_below = below;
            options.least_cosine = least_cosine;
            options.unit = unit;
            StockReport report;
            {
                const py::gil_scoped_release release;
                report =
                    apply_mesh(field, mesh, options, context != nullptr ? *context : RunContext());
            }
            return to_dict(report);
        },
        py::arg("field"), py::arg("mesh"), py::arg("search_above") = 10.0,
        py::arg("search_below") = 2.0, py::arg("context") = nullptr, py::arg("least_cosine") = 0.0,
        py::arg("unit_mm") = 1.0,
        "Stock from a mesh, by rays; not surfaces met at a smaller cosine. unit_mm: of the mesh's "
        "file, "
        "for messages.");
}

}  // namespace beltgrinding::python

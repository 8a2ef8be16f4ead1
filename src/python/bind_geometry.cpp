#include "arrays.h"
#include "beltgrinding/mesh_reader.h"
#include "beltgrinding/shape.h"
#include "beltgrinding/stock.h"
#include "facts.h"

namespace beltgrinding::python {
namespace {

using Vertices = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

TriangleMesh mesh_from(const Vertices& vertices, const Indices& triangles) {
    if (vertices.ndim() != 2 || vertices.shape(1) != 3 || triangles.ndim() != 2 ||
        triangles.shape(1) != 3) {
        throw InputError("call.mesh",
                         "a mesh needs vertices of shape (n, 3) and triangles of shape (m, 3)");
    }
    TriangleMesh mesh;
    mesh.vertices.resize(static_cast<std::size_t>(vertices.shape(0)));
    mesh.triangles.resize(static_cast<std::size_t>(triangles.shape(0)));
    std::copy_n(vertices.data(), vertices.size(), reinterpret_cast<float*>(mesh.vertices.data()));
    std::copy_n(triangles.data(), triangles.size(),
                reinterpret_cast<std::uint32_t*>(mesh.triangles.data()));
    return mesh;
}

}  // namespace

void bind_geometry(py::module_& m) {
    py::class_<TriangleMesh>(m, "TriangleMesh", "A bare triangle mesh in millimetres.")
        .def(py::init(&mesh_from), py::arg("vertices"), py::arg("triangles"))
        .def_property_readonly("vertices",
                               [](const py::object& self) {
                                   return view<float>(self.cast<TriangleMesh&>().vertices, 3, self);
                               })
        .def_property_readonly("triangles", [](const py::object& self) {
            return view<std::uint32_t>(self.cast<TriangleMesh&>().triangles, 3, self);
        });
    m.def(
        "read_ply",
        [](const std::filesystem::path& path) {
            RawMesh data;
            {
                const py::gil_scoped_release release;
                data = read_ply(path);
            }
            py::array_t<double> vertices({data.vertices.size(), std::size_t{3}});
            std::copy_n(reinterpret_cast<const double*>(data.vertices.data()), vertices.size(),
                        vertices.mutable_data());
            py::array_t<std::uint32_t> triangles({data.triangles.size(), std::size_t{3}});
            std::copy_n(reinterpret_cast<const std::uint32_t*>(data.triangles.data()),
                        triangles.size(), triangles.mutable_data());
            return py::make_tuple(vertices, triangles, data.turned);
        },
        py::arg("path"),
        "(vertices (n, 3), triangles (m, 3), closed pieces that were inside out and are turned) of "
        "a PLY, in its unit.");
    m.def(
        "read_mesh",
        [](const std::filesystem::path& path, double unit_mm, const Eigen::Matrix4d& placement,
           const RunContext* context, const std::optional<py::dict>& told) {
            const Frame frame = frame_from(
                placement, "placement", Fact{"mesh.file", "{file}: ", {{"file", path.string()}}});
            MeshReport report;
            TriangleMesh mesh;
            {
                const py::gil_scoped_release release;
                mesh = read_mesh(path, unit_mm, frame, context != nullptr ? *context : RunContext(),
                                 &report);
            }
            if (told) {
                (*told)["unit_mm"] = report.unit;
                (*told)["warnings"] = to_list(report.warnings);
            }
            return mesh;
        },
        py::arg("path"), py::arg("unit_mm") = 1.0,
        py::arg("work_from_mesh") = Eigen::Matrix4d::Identity().eval(),
        py::arg("context") = nullptr, py::arg("report") = py::none(),
        "Reads STL, PLY, OBJ, OFF, 3MF; unit_mm: millimetres per unit of the file, 1: what a 3MF "
        "says. report: a dict that is given unit_mm, as it was taken, and warnings.");

    m.def("set_cad_reader", &set_cad_reader, py::arg("program"),
          "Path of the beltgrinding-cad-reader that reads foreign files; '': look for it.");
    py::class_<Shape>(m, "Shape", "A boundary representation; faces are numbered from 0.")
        .def_static(
            "read",
            [](const std::filesystem::path& path, const RunContext* context, double scale) {
                const py::gil_scoped_release release;
                return Shape::read(path, context != nullptr ? *context : RunContext(), scale);
            },
            py::arg("path"), py::arg("context") = nullptr, py::arg("scale") = 1.0,
            "Reads STEP, IGES or BREP, in a process of its own: a damaged file is an InputError.")
        .def_static(
            "read_brep",
            [](const std::string& text, const std::string& name, const RunContext* context,
               double scale) {
                const py::gil_scoped_release release;
                return Shape::read_brep(text, name, context != nullptr ? *context : RunContext(),
                                        scale);
            },
            py::arg("text"), py::arg("name") = "shape", py::arg("context") = nullptr,
            py::arg("scale") = 1.0,
            "The same for the text of a BREP file that came from elsewhere.")
        .def_static("from_brep", &Shape::from_brep, py::arg("text"), py::arg("name") = "shape",
                    py::arg("scale") = 1.0, py::call_guard<py::gil_scoped_release>(),
                    "Reads what FreeCAD's exportBrepToString makes, in this process.")
        .def("write_brep", &Shape::write_brep)
        .def_property_readonly("face_count", &Shape::face_count)
        .def_property_readonly("valid", &Shape::valid, "By OpenCASCADE's check.")
        .def("bounds_solid", &Shape::bounds_solid, py::arg("face"))
        .def("face_area", &Shape::face_area, py::arg("face"), "mm2")
        .def(
            "face_centre",
            [](const Shape& shape, std::size_t face) -> py::object {
                const auto found = shape.face_centre(face);
                if (!found) return py::none();
                return py::make_tuple(found->centroid, found->point, found->normal);
            },
            py::arg("face"),
            "(centroid of its area, place on the face nearest to it, unit normal there as the face "
            "is oriented, 0 where there is no such place), mm; None where they cannot be found.")
        .def("surface_type", &Shape::surface_type, py::arg("face"))
        .def("extents",
             [](const Shape& shape) {
                 const Box box = shape.extents();
                 return std::pair<Vec3, Vec3>(box.min(), box.max());
             })
        .def(
            "reversed",
            [](const Shape& shape, const RunContext* context) {
                const py::gil_scoped_release release;
                const auto found = shape.reversed(context != nullptr ? *context : RunContext());
                return std::vector<bool>(found.begin(), found.end());
            },
            py::arg("context") = nullptr,
            "For each face, True if its outside is against its orientation.")
        .def(
            "neighbours",
            [](const Shape& shape, const RunContext* context) {
                const py::gil_scoped_release release;
                return shape.neighbours(context != nullptr ? *context : RunContext());
            },
            py::arg("context") = nullptr,
            "For each face, a list of those that it has a border in common with.")
        .def("flipped", &Shape::flipped, py::arg("all"), py::arg("faces"),
             "The same shape with its loose faces, and then those of `faces` (from 0), flipped.")
        .def(
            "warnings", [](const Shape& shape) { return to_list(shape.warnings()); },
            "What is odd about it, a `Fact` each.");
    m.def(
        "shape_from_mesh",
        [](const TriangleMesh& mesh, const RunContext* context) {
            const py::gil_scoped_release release;
            return shape_from_mesh(mesh, context != nullptr ? *context : RunContext());
        },
        py::arg("mesh"), py::arg("context") = nullptr, "A faceted shell from a mesh.");
    m.def(
        "triangulate",
        [](const Shape& shape, double deflection, const RunContext* context,
           const std::vector<std::size_t>& faces) {
            const py::gil_scoped_release release;
            return triangulate(shape, deflection, context != nullptr ? *context : RunContext(),
                               faces);
        },
        py::arg("shape"), py::arg("deflection"), py::arg("context") = nullptr,
        py::arg("faces") = std::vector<std::size_t>(),
        "Triangles of faces (from 0; all if empty) to a chord error of deflection mm.");
    m.def(
        "sample_faces",
        [](const Shape& shape, const std::vector<std::size_t>& faces, double spacing, double depth,
           std::size_t max_bytes, const RunContext* context, bool parameters, double precision,
           double edge_spacing) {
            SamplingOptions options;
            options.precision = precision;
            options.edge_spacing = edge_spacing;
            options.spacing = spacing;
            options.depth = depth;
            options.max_bytes = max_bytes;
            options.parameters = parameters;
            SamplingReport report;
            HeightField field;
            {
                const py::gil_scoped_release release;
                field = sample_faces(shape, faces, options,
                                     context != nullptr ? *context : RunContext(), &report);
            }
            py::dict found;
            found["face_area"] = report.face_area;
            found["warnings"] = to_list(report.warnings);
            if (parameters) {
                py::array_t<double> uv({report.parameters.size(), std::size_t{2}});
                std::copy_n(reinterpret_cast<const double*>(report.parameters.data()), uv.size(),
                            uv.mutable_data());
                found["parameters"] = uv;
                found["period"] = report.period;
            }
            return py::make_tuple(std::move(field), found);
        },
        py::arg("shape"), py::arg("faces"), py::arg("spacing"), py::arg("depth") = 1.0,
        py::arg("max_bytes") = 0, py::arg("context") = nullptr, py::arg("parameters") = false,
        py::arg("precision") = 0.0, py::arg("edge_spacing") = 0.0,
        "Samples faces (from 0; all if empty), on curved places so densely that chords bulge by "
        "precision mm, edge_spacing mm apart at least (0: unused). Returns (HeightField, "
        "dict(face_area, warnings)); "
        "with parameters also parameters (n, 2): u, v of every sample, and period of every face.");
}

}  // namespace beltgrinding::python

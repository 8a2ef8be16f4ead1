#include <array>
#include <optional>

#include "arrays.h"
#include "brep/surface_mesh.h"
#include "facts.h"
#include "inspection/ground_mesh.h"
#include "meshio/mesh_3mf.h"
#include "meshio/mesh_writer.h"

namespace beltgrinding::python {
namespace {

py::dict to_dict(const MeshCheck& c) {
    py::dict d;
    d["closed"] = c.closed();
    d["border_edges"] = c.border_edges;
    d["non_manifold_edges"] = c.non_manifold_edges;
    d["turned_edges"] = c.turned_edges;
    d["components"] = c.components;
    d["euler"] = c.euler;
    d["volume"] = c.volume;
    d["area"] = c.area;
    return d;
}

/// (lower, upper, limit), mm, or none.
using Scale = std::optional<std::array<double, 3>>;

std::optional<ColourScale> scale_of(const Scale& given) {
    if (!given) return std::nullopt;
    return ColourScale{{(*given)[0], (*given)[1]}, (*given)[2], 0, {}};
}

}  // namespace

void bind_ground_mesh(py::module_& m) {
#define BELTGRINDING_VIEW(name, member, Scalar, row)                     \
    def_property_readonly(name, [](const py::object& self) {             \
        return view<Scalar>(self.cast<GroundMesh&>().member, row, self); \
    })
    py::class_<GroundMesh>(m, "GroundMesh",
                           "The whole part as ground; read-only arrays in mm, work frame.")
        .BELTGRINDING_VIEW("vertices", vertices, double, 3)
        .BELTGRINDING_VIEW("triangles", triangles, std::uint32_t, 3)
        .BELTGRINDING_VIEW("faces", face, std::uint32_t, 1)
        .BELTGRINDING_VIEW("deviation", deviation, float, 1)
        .BELTGRINDING_VIEW("standing", standing, std::uint8_t, 1)
        .def("report",
             [](const GroundMesh& mesh) {
                 py::dict d;
                 d["ground"] = to_dict(mesh.check);
                 d["design"] = to_dict(mesh.design_check);
                 d["expected_volume"] = mesh.expected_volume;
                 d["flipped"] = mesh.flipped;
                 d["flat"] = mesh.flat;
                 d["limited"] = mesh.limited;
                 d["slid"] = mesh.slid;
                 d["missed"] = mesh.missed;
                 d["defective"] = mesh.defective;
                 d["warnings"] = to_list(mesh.warnings);
                 return d;
             })
        .def("stl",
             [](const GroundMesh& mesh) {
                 return bytes_from([&](const FileMemory& memory) { mesh_stl(mesh, memory); });
             })
        .def(
            "ply",
            [](const GroundMesh& mesh, const Scale& scale) {
                const auto colours = scale_of(scale);
                return bytes_from([&](const FileMemory& memory) {
                    mesh_ply(mesh, colours ? &*colours : nullptr, memory);
                });
            },
            py::arg("scale") = py::none(),
            "Binary PLY; scale: (lower, upper, limit) of the colours, mm.")
        .def(
            "three_mf",
            [](const GroundMesh& mesh, const Scale& scale) {
                std::string file;
                {
                    const py::gil_scoped_release release;
                    const auto colours = scale_of(scale);
                    file = write_3mf(
                        mesh.vertices, mesh.triangles,
                        colours ? mesh_colours(mesh, *colours) : std::vector<std::uint32_t>());
                }
                return py::bytes(file);
            },
            py::arg("scale") = py::none(), "3MF; scale: (lower, upper, limit) of the colours, mm.")
        .def(
            "colours",
            [](const GroundMesh& mesh, double lower, double upper, double limit) {
                return own(mesh_colours(mesh, {{lower, upper}, limit, 0, {}}));
            },
            py::arg("lower"), py::arg("upper"), py::arg("limit"), "(n,) uint32, 0xRRGGBBAA.");
#undef BELTGRINDING_VIEW
    m.def(
        "ground_mesh",
        [](const Shape& shape, const HeightField& field, bool ground, double deflection,
           std::optional<double> spacing, const RunContext* context) {
            const py::gil_scoped_release release;
            const RunContext run = context != nullptr ? *context : RunContext();
            SurfaceMeshOptions options;
            options.deflection = deflection;
            options.spacing = spacing.value_or(field.spacing);
            std::vector<char> chosen(shape.face_count(), 0);
            for (const std::uint32_t f : field.face) {
                if (f >= chosen.size())
                    throw InputError("inspection.no_such_face",
                                     "the height field is not of this shape: it has face {face}, "
                                     "the shape has {count} faces",
                                     {{"face", f + 1}, {"count", chosen.size()}});
                if (!chosen[f]++) options.fine_faces.push_back(f);
            }
            const SurfaceMesh surface = surface_mesh(shape, options, run.part(0.0, 0.6));
            return ground_mesh(surface, field, ground, run.part(0.6, 1.0));
        },
        py::arg("shape"), py::arg("field"), py::arg("ground") = true, py::arg("deflection") = 0.05,
        py::arg("spacing") = py::none(), py::arg("context") = nullptr,
        "The mesh of the whole shape, its sampled faces displaced by the field's heights.");
}

}  // namespace beltgrinding::python

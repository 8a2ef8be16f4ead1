#include <limits>

#include "arrays.h"
#include "base/large_memory.h"
#include "picture/picture.h"

namespace beltgrinding::python {
namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// The rows of an (n, 3) array as `Row`s.
template <class Row, class T>
std::vector<Row> rows_of(const Array<T>& array, const char* what) {
    static_assert(sizeof(Row) == 3 * sizeof(T));
    if (array.size() == 0) return {};
    if (array.ndim() != 2 || array.shape(1) != 3)
        throw InputError("call.picture_rows", "picture: {name} have the shape (n, 3)",
                         {{"name", what}});
    std::vector<Row> rows;
    resize_large(rows, static_cast<std::size_t>(array.shape(0)));
    std::copy_n(array.data(), array.size(), reinterpret_cast<T*>(rows.data()));
    return rows;
}

ColouredSurface surface_of(const py::dict& given) {
    ColouredSurface surface;
    surface.vertices = rows_of<Vec3, double>(given["vertices"].cast<Array<double>>(), "vertices");
    surface.triangles = rows_of<Triangle, std::uint32_t>(
        given["triangles"].cast<Array<std::uint32_t>>(), "triangles");
    if (given.contains("normals"))
        surface.normals = rows_of<Vec3f, float>(given["normals"].cast<Array<float>>(), "normals");
    const auto colours = given["colours"].cast<Array<std::uint32_t>>();
    surface.colours.assign(colours.data(), colours.data() + colours.size());
    return surface;
}

}  // namespace

void bind_picture(py::module_& m) {
    py::class_<Renderer>(m, "Renderer", "Pictures of coloured triangles without a display.")
        .def(py::init([](const std::vector<py::dict>& surfaces, const RunContext* context) {
                 std::vector<ColouredSurface> taken;
                 taken.reserve(surfaces.size());
                 for (const py::dict& one : surfaces) taken.push_back(surface_of(one));
                 const RunContext watched = context != nullptr ? *context : RunContext();
                 const py::gil_scoped_release release;
                 return Renderer(std::move(taken), watched);
             }),
             py::arg("surfaces"), py::arg("context") = nullptr,
             "surfaces: dicts of vertices (n, 3) mm, triangles (m, 3), colours (n,) or (1,) "
             "0xRRGGBBAA and, for a smooth light, normals (n, 3).")
        .def_property_readonly("extents",
                               [](const Renderer& renderer) {
                                   return std::pair<Vec3, Vec3>(renderer.extents().min(),
                                                                renderer.extents().max());
                               })
        .def(
            "render",
            [](const Renderer& renderer, const Vec3& target, const Vec3& direction, const Vec3& up,
               double height, std::size_t columns, std::size_t rows, double near,
               const RunContext* context) {
                Picture picture;
                {
                    const RunContext watched = context != nullptr ? *context : RunContext();
                    const py::gil_scoped_release release;
                    picture = renderer.render({target, direction, up, height, near}, columns, rows,
                                              watched);
                }
                return std::pair(own(std::move(picture.rgb))
                                     .reshape({static_cast<py::ssize_t>(rows),
                                               static_cast<py::ssize_t>(columns), py::ssize_t{3}}),
                                 own(std::move(picture.depth))
                                     .reshape({static_cast<py::ssize_t>(rows),
                                               static_cast<py::ssize_t>(columns)}));
            },
            py::arg("target"), py::arg("direction"), py::arg("up"), py::arg("height"),
            py::arg("columns"), py::arg("rows"),
            py::arg("near") = std::numeric_limits<double>::infinity(), py::arg("context") = nullptr,
            "An orthographic camera that looks at target (mm) along direction, its picture height "
            "mm high, that sees nothing farther than near mm before target. Returns rgb (rows, "
            "columns, 3) uint8 and depth (rows, columns) float32, mm "
            "beyond target; NaN: nothing there.")
        .def(
            "seen",
            [](const Renderer& renderer, const Array<double>& points,
               const Array<double>& directions, double slack,
               const std::optional<Array<std::uint8_t>>& asked) {
                const auto from = rows_of<Vec3, double>(points, "points");
                const auto ways = rows_of<Vec3, double>(directions, "directions");
                std::span<const std::uint8_t> wanted;
                if (asked) wanted = {asked->data(), static_cast<std::size_t>(asked->size())};
                std::vector<std::uint8_t> seen;
                {
                    const py::gil_scoped_release release;
                    seen = renderer.seen(from, ways, slack, wanted);
                }
                return own(std::move(seen))
                    .reshape({static_cast<py::ssize_t>(from.size()),
                              static_cast<py::ssize_t>(ways.size())});
            },
            py::arg("points"), py::arg("directions"), py::arg("slack"),
            py::arg("asked") = py::none(),
            "Lines of sight, (n, m) uint8: 1 where nothing stands between points (n, 3) mm and a "
            "camera far away in directions (m, 3); what lies within slack mm does not hide. "
            "asked: (n, m), where it is False nothing is looked for, and the answer is 0.")
        .def(
            "farthest",
            [](const Renderer& renderer, const Array<double>& directions) {
                const auto ways = rows_of<Vec3, double>(directions, "directions");
                std::vector<Vec3> found;
                {
                    const py::gil_scoped_release release;
                    found = renderer.farthest(ways);
                }
                py::array_t<double> rows({static_cast<py::ssize_t>(found.size()), py::ssize_t{3}});
                std::copy_n(reinterpret_cast<const double*>(found.data()), 3 * found.size(),
                            rows.mutable_data());
                return rows;
            },
            py::arg("directions"),
            "(k, 3) mm: the vertices that lie farthest along each of directions (m, 3), and "
            "against it.");
}

}  // namespace beltgrinding::python

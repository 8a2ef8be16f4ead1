#include "arrays.h"
#include "mesh/thinning.h"

namespace beltgrinding::python {
namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T>
std::span<const T> span_of(const Array<T>& array) {
    return {array.data(), static_cast<std::size_t>(array.size())};
}

/// The rows of an (n, 3) array, where they lie.
template <class Row, class T>
std::span<const Row> rows_of(const Array<T>& array, const char* what) {
    static_assert(sizeof(Row) == 3 * sizeof(T));
    if (array.ndim() != 2 || array.shape(1) != 3)
        throw InputError("call.thinning_rows", "thinning: {name} have the shape (n, 3)",
                         {{"name", what}});
    return {reinterpret_cast<const Row*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

}  // namespace

void bind_thinning(py::module_& m) {
    m.def(
        "thinned",
        [](const Array<double>& points, const Array<float>& normals,
           const Array<std::uint32_t>& groups, std::size_t most, const Array<std::uint32_t>& keep) {
            const auto places = rows_of<Vec3, double>(points, "points");
            const auto facing = rows_of<Vec3f, float>(normals, "normals");
            ThinnedSamples thin;
            {
                const py::gil_scoped_release release;
                thin = thinned(places, facing, span_of(groups), most, span_of(keep));
            }
            return std::pair(own(std::move(thin.chosen)), own(std::move(thin.place)));
        },
        py::arg("points"), py::arg("normals"), py::arg("groups"), py::arg("most"), py::arg("keep"),
        "(chosen (k,), place (n,)) uint32: samples that stay, ascending, about most of them, and "
        "which of "
        "them stands for each of points (n, 3) mm with normals (n, 3): of those in a cube that "
        "belong "
        "to one of groups (n,) and face the same way the one nearest to their middle, or one of "
        "keep.");
    m.def(
        "replaced",
        [](const Array<std::uint32_t>& triangles, const Array<std::uint32_t>& place) {
            const auto given = rows_of<Triangle, std::uint32_t>(triangles, "triangles");
            std::vector<Triangle> proper;
            {
                const py::gil_scoped_release release;
                proper = replaced(given, span_of(place));
            }
            Array<std::uint32_t> rows({static_cast<py::ssize_t>(proper.size()), py::ssize_t{3}});
            std::copy_n(reinterpret_cast<const std::uint32_t*>(proper.data()), 3 * proper.size(),
                        rows.mutable_data());
            return rows;
        },
        py::arg("triangles"), py::arg("place"),
        "Triangles (m, 3) between the places (n,) of their corners, without those of which two are "
        "one.");
}

}  // namespace beltgrinding::python

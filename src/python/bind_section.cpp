#include "arrays.h"
#include "inspection/section.h"

namespace beltgrinding::python {
namespace {

/// (n, 3) array.
py::array_t<double> rows(const std::vector<Vec3>& vectors) {
    py::array_t<double> array({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
    auto out = array.mutable_unchecked<2>();
    for (std::size_t i = 0; i < vectors.size(); ++i)
        for (py::ssize_t k = 0; k < 3; ++k) out(static_cast<py::ssize_t>(i), k) = vectors[i][k];
    return array;
}

/// `freedom`: that of the field's standard deviations.
py::dict to_dict(Section&& section, double freedom) {
    py::list pieces;
    for (SectionPiece& piece : section.pieces) {
        py::dict d;
        d["face"] = piece.face;
        d["closed"] = piece.closed;
        d["s"] = own(std::move(piece.arc_length));
        d["point"] = rows(piece.point);
        d["normal"] = rows(piece.normal);
        d["ray"] = rows(piece.ray);
        d["stock_height"] = own(std::move(piece.stock_height));
        d["height"] = own(std::move(piece.height));
        if (!piece.height_sd.empty()) d["height_sd"] = own(std::move(piece.height_sd));
        pieces.append(d);
    }
    py::dict d;
    d["point"] = section.origin;
    d["normal"] = section.normal;
    d["pieces"] = pieces;
    d["sd_freedom"] = freedom;
    return d;
}

using Cut = Section (*)(const HeightField&, const Vec3&, const Vec3&);

template <Cut cut>
py::dict section(const HeightField& field, const Vec3& a, const Vec3& b) {
    Section found;
    {
        const py::gil_scoped_release release;
        found = cut(field, a, b);
    }
    return to_dict(std::move(found), field.sd_freedom);
}

}  // namespace

void bind_section(py::module_& m) {
    m.def("section_by_plane", &section<section_by_plane>, py::arg("field"), py::arg("point"),
          py::arg("normal"),
          "Section of the design surface by a plane: point, normal, pieces, each a dict of face, "
          "closed, s, point, normal, ray, stock_height, height and, where known, height_sd; mm.");
    m.def("section_between", &section<section_between>, py::arg("field"), py::arg("start"),
          py::arg("end"), "The line on the surface between two points (mm), as section_by_plane.");
}

}  // namespace beltgrinding::python

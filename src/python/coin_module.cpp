// The binding `beltgrinding_coin`: apart from the core, which must load where there is no Coin or
// another one.
#include <Inventor/SoDB.h>

#include <span>

#include "arrays.h"
#include "coin/so_height_field.h"

namespace {

using namespace beltgrinding::python;
using beltgrinding::InputError;
using beltgrinding::SoHeightField;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T>
std::span<const T> values(const Array<T>& array) {
    return {array.data(), static_cast<std::size_t>(array.size())};
}

SoHeightField& node_at(std::uintptr_t address) {
    SoHeightField* node = SoHeightField::at(address);
    if (node == nullptr)
        throw InputError("coin.no_node", "there is no SoHeightField at this address");
    return *node;
}

}  // namespace

PYBIND11_MODULE(beltgrinding_coin, m) {
    m.doc() =
        "SoHeightField in Coin's scene. A node is named by its address: int(node.this) of pivy's.";
    m.def(
        "register_node",
        [] {
            if (!SoDB::isInitialized()) return false;
            SoHeightField::initClass();
            return true;
        },
        "Tells Coin the type SoHeightField. False if the Coin that this module is linked with was "
        "not started: the program runs another one.");
    m.def(
        "set_samples",
        [](std::uintptr_t node, const Array<double>& points, const Array<float>& normals,
           const Array<std::uint32_t>& triangles) {
            node_at(node).setSamples(values(points), values(normals), values(triangles));
        },
        py::arg("node"), py::arg("points"), py::arg("normals"), py::arg("triangles"),
        "Design points (n, 3) in mm, rays of the samples (n, 3), triangles (m, 3).");
    m.def(
        "set_heights",
        [](std::uintptr_t node, const Array<double>& heights) {
            node_at(node).setHeights(values(heights));
        },
        py::arg("node"), py::arg("heights"), "(n,) mm along the rays.");
    m.def(
        "set_colours",
        [](std::uintptr_t node, const Array<std::uint32_t>& colours) {
            node_at(node).setColours(values(colours));
        },
        py::arg("node"), py::arg("colours"), "(n,) uint32, 0xRRGGBBAA.");
    m.def(
        "set_values",
        [](std::uintptr_t node, const Array<double>& given, double low, double high,
           const Array<std::uint32_t>& palette, std::uint32_t missing) {
            node_at(node).setValues(values(given), low, high, values(palette), missing);
        },
        py::arg("node"), py::arg("values"), py::arg("low"), py::arg("high"), py::arg("palette"),
        py::arg("missing"),
        "(n,) values, coloured at every pixel by palette (m,) 0xRRGGBBAA, which spans low to high; "
        "missing: the colour of NaN.");
}

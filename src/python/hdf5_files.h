#pragma once

#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "arrays.h"
#include "base/large_memory.h"

namespace beltgrinding::python {

/// As py::bytes, in large pages where it pays: a file's bytes are copied once and then read.
inline py::bytes large_bytes(const std::string& image) {
    auto* made = PyBytes_FromStringAndSize(nullptr, static_cast<py::ssize_t>(image.size()));
    if (made == nullptr) throw py::error_already_set();
    expect_large_use(PyBytes_AS_STRING(made), image.size());
    std::memcpy(PyBytes_AS_STRING(made), image.data(), image.size());
    return py::reinterpret_steal<py::bytes>(made);
}

/// Binds the ways between an object and an HDF5 file: `write_hdf5`, `hdf5_into`, `hdf5`,
/// `from_hdf5`, `from_hdf5_bytes`. `read(path, attributes*)`, `read_image(bytes, name,
/// attributes*)`. Python's lock is free while they work.
template <class T, class Class, class Read, class ReadImage>
void bind_hdf5(Class& bound, const char* returns, Read read, ReadImage read_image) {
    bound
        .def(
            "write_hdf5",
            [](const T& object, const std::filesystem::path& path, const std::string& attributes) {
                const py::gil_scoped_release release;
                write_hdf5(object, path, attributes);
            },
            py::arg("path"), py::arg("attributes") = "")
        .def(
            "hdf5_into",
            [](const T& object, int file, const std::string& attributes) {
                raise_unless_written([&] { return write_hdf5(object, file, attributes); });
            },
            py::arg("file"), py::arg("attributes") = "",
            "The bytes that write_hdf5 writes, to an open, empty file, by its descriptor, as they "
            "are made. Raises OSError.")
        .def(
            "hdf5",
            [](const T& object, const std::string& attributes) {
                std::string image;
                {
                    const py::gil_scoped_release release;
                    image = hdf5_image(object, attributes);
                }
                return large_bytes(image);
            },
            py::arg("attributes") = "", "The bytes that write_hdf5 writes.")
        .def_static(
            "from_hdf5_bytes",
            [read_image](const py::bytes& image, const std::string& name) {
                const auto view = static_cast<std::string_view>(image);
                std::string attributes;
                T object;
                {
                    const py::gil_scoped_release release;
                    object = read_image(view, name, &attributes);
                }
                return py::make_tuple(std::move(object), attributes);
            },
            py::arg("image"), py::arg("name"),
            "As from_hdf5, of a file's bytes; errors tell the name.")
        .def_static(
            "from_hdf5",
            [read](const std::filesystem::path& path) {
                std::string attributes;
                T object;
                {
                    const py::gil_scoped_release release;
                    object = read(path, &attributes);
                }
                return py::make_tuple(std::move(object), attributes);
            },
            py::arg("path"), returns);
}

}  // namespace beltgrinding::python

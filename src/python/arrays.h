#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/large_memory.h"
#include "beltgrinding/error.h"
#include "beltgrinding/geometry.h"

namespace beltgrinding::python {

namespace py = pybind11;

/// A read-only numpy view of `data` as rows of `row` scalars; `owner` stays alive with it.
template <class Scalar, class T>
py::array view(const std::vector<T>& data, std::size_t row, const py::object& owner) {
    static_assert(sizeof(T) % sizeof(Scalar) == 0);
    const auto n = static_cast<py::ssize_t>(data.size());
    const auto m = static_cast<py::ssize_t>(row);
    py::array array = row == 1
                          ? py::array(py::dtype::of<Scalar>(), {n},
                                      {static_cast<py::ssize_t>(sizeof(T))}, data.data(), owner)
                          : py::array(py::dtype::of<Scalar>(), {n, m},
                                      {static_cast<py::ssize_t>(sizeof(T)),
                                       static_cast<py::ssize_t>(sizeof(Scalar))},
                                      data.data(), owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

/// Moves `data` into a numpy array of its own.
template <class Scalar>
py::array_t<Scalar> own(std::vector<Scalar>&& data) {
    auto* moved = new std::vector<Scalar>(std::move(data));
    const py::capsule owner(moved, [](void* p) { delete static_cast<std::vector<Scalar>*>(p); });
    return py::array_t<Scalar>(static_cast<py::ssize_t>(moved->size()), moved->data(), owner);
}

/// Python bytes that `write` fills where they lie: it is given a function that takes how many they
/// are and gives their memory. It runs without Python's lock.
template <class Write>
py::bytes bytes_from(Write&& write) {
    py::object made;
    {
        const py::gil_scoped_release release;
        write([&made](std::size_t size) {
            const py::gil_scoped_acquire lock;
            made = py::reinterpret_steal<py::object>(
                PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(size)));
            if (!made) throw py::error_already_set();
            char* const memory = PyBytes_AS_STRING(made.ptr());
            expect_large_use(memory, size);
            return memory;
        });
    }
    return py::reinterpret_borrow<py::bytes>(made);
}

/// A rigid transform from a 4 x 4 matrix; `name` stands for it in messages, after `context`.
Frame frame_from(const Eigen::Matrix4d& matrix, const std::string& name,
                 const std::optional<Fact>& context = std::nullopt);

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Rigid transforms from an array (n, 4, 4); messages number them from 1.
std::vector<Frame> poses_from(const Doubles& frames);

void bind_base(py::module_& m);
void bind_geometry(py::module_& m);
void bind_height_field(py::module_& m);
void bind_contact(py::module_& m);
void bind_events(py::module_& m);
void bind_surrogate(py::module_& m);
void bind_calibration(py::module_& m);
void bind_recording(py::module_& m);
void bind_heat(py::module_& m);
void bind_simulation(py::module_& m);
void bind_planning(py::module_& m);
void bind_inspection(py::module_& m);
void bind_ground_mesh(py::module_& m);
void bind_section(py::module_& m);
void bind_verdict(py::module_& m);
void bind_robot(py::module_& m);
void bind_picture(py::module_& m);
void bind_thinning(py::module_& m);
void bind_collision(py::module_& m);
void bind_toolpath(py::module_& m);

}  // namespace beltgrinding::python

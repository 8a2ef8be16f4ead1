#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cerrno>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/large_memory.h"
#include "base/whole_file.h"
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

/// Python bytes that `write` fills where they lie: it is given a function that gives the memory of
/// the next so many, of how many in all. It runs without Python's lock.
template <class Write>
py::bytes bytes_from(Write&& write) {
    py::object made;
    {
        const py::gil_scoped_release release;
        write([&made, next = static_cast<char*>(nullptr)](std::size_t size,
                                                          std::size_t whole) mutable {
            if (next == nullptr) {
                const py::gil_scoped_acquire lock;
                made = py::reinterpret_steal<py::object>(
                    PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(whole)));
                if (!made) throw py::error_already_set();
                next = PyBytes_AS_STRING(made.ptr());
                expect_large_use(next, whole);
            }
            return std::exchange(next, next + size);
        });
    }
    return py::reinterpret_borrow<py::bytes>(made);
}

/// Calls `write`, which returns why a file did not take what it was given, without Python's lock;
/// raises OSError of that.
template <class Write>
void raise_unless_written(Write&& write) {
    std::error_code error;
    {
        const py::gil_scoped_release release;
        error = write();
    }
    if (!error) return;
    errno = error.value();
    PyErr_SetFromErrno(PyExc_OSError);
    throw py::error_already_set();
}

/// As `bytes_from`, but to an open file, by its descriptor, a piece at a time. Raises OSError.
template <class Write>
void bytes_into(int file, Write&& write) {
    raise_unless_written([&] {
        std::vector<char> piece;
        std::size_t filled = 0;
        std::error_code error;
        const auto end_piece = [&] {
            if (!error) error = write_all(file, {piece.data(), filled});
        };
        write([&](std::size_t size, std::size_t /*whole*/) {
            end_piece();
            if (size > piece.size()) piece.resize(size);
            filled = size;
            return piece.data();
        });
        end_piece();
        return error;
    });
}

/// A rigid transform from a 4 x 4 matrix; `name` stands for it in messages, after `context`.
Frame frame_from(const Eigen::Matrix4d& matrix, const std::string& name,
                 const std::optional<Fact>& context = std::nullopt);

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Bools = py::array_t<bool, py::array::c_style | py::array::forcecast>;

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
void bind_posture(py::module_& m);

}  // namespace beltgrinding::python

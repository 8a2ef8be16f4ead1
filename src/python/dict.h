#pragma once

#include <memory>
#include <string>

#include "arrays.h"
#include "beltgrinding/contact_model.h"
#include "beltgrinding/event.h"
#include "surrogate/regression.h"

namespace beltgrinding::python {

/// Takes the value of `key` out of `d`; what is left in the end is unknown.
template <class T>
T take(py::dict& d, const char* key, T fallback) {
    if (!d.contains(key)) return fallback;
    try {
        T value = d[key].cast<T>();
        d.attr("pop")(key);
        return value;
    } catch (const py::cast_error&) {
        throw InputError("call.wrong_type", "'{key}' has a value of the wrong type",
                         {{"key", key}});
    }
}

/// Throws InputError naming the first key that is left in `d`.
void refuse_rest(const py::dict& d, const char* where);

py::dict copy_of(const py::dict& d);

/// A surrogate's regression from what `train_regression` gives.
TrainedRegression regression_from(const py::dict& given);

/// One dict of its members per event.
py::list events_to_list(const std::vector<Event>& events);

/// (ny, nx) array of one value per cell.
py::array_t<double> cells(const ContactGrid& grid, const Eigen::ArrayXd& values);

/// x, y, pressure, cell_area, force, approach, contact_area, peak_pressure, iterations, converged.
py::dict contact_to_dict(const ContactGrid& grid, const ContactSolution& solution);
/// Adds where the pressure acts: displaced_pressure, beside and reach (see single_contact).
void add_displaced(py::dict& d, const ContactGrid& grid, const ContactSolution& solution,
                   const Eigen::ArrayXd& coverage);

}  // namespace beltgrinding::python

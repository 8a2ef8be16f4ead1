#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "beltgrinding/error.h"
#include "beltgrinding/fact.h"

namespace beltgrinding::python {

namespace py = pybind11;

/// Defines the classes of facts.py, `Fact` and `InputError`, in `beltgrinding_core`.
void define_facts(py::module_& core);

/// Text from outside, such as a path, need not be UTF-8: what is not becomes U+FFFD.
py::str text(const std::string& utf8);

/// {name: int, float or str}
py::dict to_dict(const Arguments& arguments);

/// {"code", "text", "arguments"}, as it stands in files.
py::dict to_dict(const Fact& fact);

/// A list of `beltgrinding_core.Fact`: English sentences that know their facts.
py::list to_list(const std::vector<Fact>& facts);

/// Sets Python's error: an instance of `type`, which is `beltgrinding_core.InputError`.
void raise(const InputError& error, py::handle type);

}  // namespace beltgrinding::python

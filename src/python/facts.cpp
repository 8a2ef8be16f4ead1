#include "facts.h"

#include <pybind11/eval.h>

#include <algorithm>

namespace beltgrinding::python {

extern const char* const kFactsPy;  // facts.py, by CMakeLists.txt

namespace {

py::object made(const py::handle& type, const Fact& fact) {
    return type(text(fact.code), text(fact.text), **to_dict(fact.arguments));
}

}  // namespace

void define_facts(py::module_& core) {
    // As of the module itself, so that they are found there again when they are unpickled.
    py::dict names;
    names["__name__"] = core.attr("__name__");
    py::exec(kFactsPy, names);
    core.attr("Fact") = names["Fact"];
    core.attr("InputError") = names["InputError"];
}

py::str text(const std::string& utf8) {
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(utf8.data(), static_cast<Py_ssize_t>(utf8.size()), "replace"));
}

py::dict to_dict(const Arguments& arguments) {
    py::dict found;
    for (const Argument& argument : arguments) {
        py::object value;
        if (const auto* words = std::get_if<std::string>(&argument.value)) {
            value = text(*words);
        } else if (const auto* number = std::get_if<double>(&argument.value)) {
            value = py::float_(*number);
        } else {
            value = py::int_(std::get<std::int64_t>(argument.value));
        }
        found[text(argument.name)] = value;
    }
    return found;
}

py::dict to_dict(const Fact& fact) {
    py::dict found;
    found["code"] = text(fact.code);
    found["text"] = text(fact.text);
    found["arguments"] = to_dict(fact.arguments);
    return found;
}

py::list to_list(const std::vector<Fact>& facts) {
    const py::object type = py::module_::import("beltgrinding_core").attr("Fact");
    py::list list;
    for (const Fact& fact : facts) list.append(made(type, fact));
    return list;
}

void raise(const InputError& error, py::handle type) {
    try {
        py::object value = made(type, error.fact());
        const std::vector<Fact>& context = error.context();
        std::for_each(context.rbegin(), context.rend(), [&](const Fact& outer) {
            value = value.attr("within")(text(outer.code), text(outer.text),
                                         **to_dict(outer.arguments));
        });
        PyErr_SetObject(type.ptr(), value.ptr());
    } catch (py::error_already_set& failure) {
        failure.restore();
    } catch (const std::exception&) {
        PyErr_SetString(type.ptr(), error.what());
    }
}

}  // namespace beltgrinding::python

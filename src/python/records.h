#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.h"

namespace beltgrinding::python {

/// One of Python's dataclasses, such as those of a job (beltgrinding/job/settings.py), read as it
/// is.
class Record {
  public:
    explicit Record(py::object object) : object_(std::move(object)) {}

    /// The value of an attribute. Throws InputError for one of the wrong type.
    template <class T>
    T get(const char* name) const {
        const py::object value = object_.attr(name);
        if constexpr (std::is_same_v<T, Record>) {
            return Record(value);
        } else {
            try {
                return value.cast<T>();
            } catch (const py::cast_error&) {
                throw InputError("call.wrong_type", "'{key}' has a value of the wrong type",
                                 {{"key", name}});
            }
        }
    }

    bool is_none() const { return object_.is_none(); }

    /// Whether there is more than None.
    bool has(const char* name) const { return !object_.attr(name).is_none(); }

    /// Puts the value into `target`; None leaves `target` as it is.
    template <class T>
    void take(const char* name, T& target) const {
        if (has(name)) target = get<T>(name);
    }

    Record in(const char* name) const { return get<Record>(name); }

    /// The records of a tuple or list.
    std::vector<Record> each(const char* name) const {
        std::vector<Record> found;
        for (const auto& one : get<py::sequence>(name)) {
            found.emplace_back(py::reinterpret_borrow<py::object>(one));
        }
        return found;
    }

  private:
    py::object object_;
};

}  // namespace beltgrinding::python

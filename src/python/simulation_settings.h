#pragma once

#include <memory>

#include "arrays.h"
#include "beltgrinding/contact_model.h"
#include "beltgrinding/simulation.h"

namespace beltgrinding::python {

// What a simulation is given, from dicts. All throw InputError naming a key that has a value of the
// wrong type or is unknown.

std::unique_ptr<RemovalLaw> law_from(const py::dict& given);
BeltWear wear_from(const py::dict& given);
BeltState belt_from(const py::dict& given);
BeltMachine machine_from(const py::dict& given);
/// Of the belt, where that is pressed itself; else of the wheel.
std::unique_ptr<ContactModel> contact_from(const py::dict& compliance,
                                           const ProcessSettings& process);
SimulationOptions options_from(const py::dict& wheel_given, const py::dict& given);

}  // namespace beltgrinding::python

#pragma once

#include <memory>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/simulation.h"
#include "records.h"

namespace beltgrinding::python {

// What a simulation is given, from the job's records (beltgrinding/job/settings.py) as they are,
// whose units become the library's here: mm, N, s, rad, t.

ContactWheel wheel_from(const Record& wheel);
/// Of a `belt_machine`; of one whose wheel presses, only that it is one.
BeltMachine machine_from(const Record& machine);
std::unique_ptr<RemovalLaw> law_from(const Record& law);
BeltWear wear_from(const Record& wear);
/// From a dict of work (J), volume (mm3) and time (s), as a result has it. Throws InputError.
BeltState belt_from(const py::dict& given);

/// The contact model of a `compliance`, or of a surrogate (beltgrinding/job/surrogate_file.py), for
/// `wheel` under about `force` N.
std::unique_ptr<ContactModel> compliance_from(const Record& elasticity, const ContactWheel& wheel,
                                              double force);
/// Of the belt, where that is pressed itself; else of the wheel. `input`: as of `options_from`.
std::unique_ptr<ContactModel> contact_from(const Record& input, const ProcessSettings& process);
/// `input`: an EngineInput (beltgrinding/job/engine_input.py).
SimulationOptions options_from(const Record& input);

}  // namespace beltgrinding::python

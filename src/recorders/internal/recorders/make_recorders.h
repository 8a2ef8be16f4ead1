#pragma once

#include "beltgrinding/simulation_options.h"
#include "engine/recorder.h"
#include "engine/step_queue.h"

namespace beltgrinding {

/// The recorders of what is asked for. `steps`: the simulation's; `rigid`: the tool is. All of them
/// must outlive them. Throws InputError where the field's trace or finish is of another one.
Recorders make_recorders(const SampleBlocks& blocks, const ToolPath& path, const RemovalLaw& law,
                         const SimulationOptions& options, const StepLog& steps, bool rigid);

}  // namespace beltgrinding

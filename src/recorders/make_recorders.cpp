#include "recorders/make_recorders.h"

#include <memory>

#include "event_recorder.h"
#include "finish_recorder.h"
#include "heat_recorder.h"
#include "influence_recorder.h"
#include "playback_recorder.h"
#include "resolution_recorder.h"
#include "shift_recorder.h"
#include "step_recorder.h"
#include "trace_recorder.h"

namespace beltgrinding {

Recorders make_recorders(const SampleBlocks& blocks, const ToolPath& path, const RemovalLaw& law,
                         const SimulationOptions& options, const StepLog& steps, bool rigid) {
    const OutputRequest& outputs = options.outputs;
    const ProcessSettings& process = options.process;
    const std::size_t motions = path.poses().size();
    Recorders all;
    if (outputs.recording != nullptr)
        all.add(std::make_unique<PlaybackRecorder>(blocks, *outputs.recording, path.duration()));
    all.add(std::make_unique<StepRecorder>(options.must_touch));
    const HeatRecorder* heat = nullptr;
    if (options.heat.part != nullptr && !rigid) {
        auto one = std::make_unique<HeatRecorder>(blocks, options.heat, process.belt_speed,
                                                  process.pause, path.duration());
        heat = one.get();
        all.add(std::move(one));
    }
    all.add(std::make_unique<EventRecorder>(blocks, path, options, law, steps, heat));
    if (outputs.trace) all.add(std::make_unique<TraceRecorder>(blocks));
    if (options.finish.wanted && !rigid)
        all.add(std::make_unique<FinishRecorder>(blocks, options.finish, process.belt_speed,
                                                 options.resolution.max_travel));
    if (outputs.influence) all.add(std::make_unique<InfluenceRecorder>(blocks, motions, law));
    if (outputs.cell_errors && !rigid) all.add(std::make_unique<ResolutionRecorder>(blocks));
    all.add(std::make_unique<ShiftRecorder>(blocks, outputs.shifted_laws, process));
    if (outputs.force_influence)
        all.add(std::make_unique<ForceInfluenceRecorder>(blocks, motions, law));
    for (const auto& make : outputs.recorders) all.add(make(blocks));
    return all;
}

}  // namespace beltgrinding

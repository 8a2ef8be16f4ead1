#include "beltgrinding/simulation.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/stopwatch.h"
#include "beltgrinding/error.h"
#include "checkpoints/checkpoint_keeper.h"
#include "contact_grid.h"
#include "engine/grinding.h"
#include "engine/recorder.h"
#include "engine/step_queue.h"
#include "engine/wheel_control.h"
#include "ground.h"
#include "recorders/make_recorders.h"

namespace beltgrinding {
namespace {

// Share of the wheel's indentation that may be ground in a step where the wheel follows the
// surface: beyond, the step is cut, since the wheel would sink where it has long gone on.
constexpr double kCoarse = 1.0;
constexpr double kCoarseShare = 0.01;       // of the parts at one place, for a step beyond cutting
constexpr double kLeastIndentation = 1e-6;  // mm
constexpr std::size_t kReportEvery = 16;    // steps between two looks at progress and cancel

StepQueue steps_of(const ToolPath& path, const SimulationOptions& options) {
    const Resolution& resolution = options.resolution;
    StepQueue steps(path, {resolution.max_travel, resolution.max_angle, options.process.force});
    if (steps.planned() == 0) {
        throw InputError(
            "simulation.no_grinding_motion",
            "the path has no motion that grinds: it needs at least two poses, and other "
            "motions than rapid ones");
    }
    return steps;
}

void validate(const HeightField& field, const SimulationOptions& options) {
    check_field(field);
    options.process.validate();
    options.resolution.validate();
    options.limits.validate(field.size());
    options.heat.validate(field.size());
    options.finish.validate();
}

/// The parts of a simulation while it runs.
struct Run {
    SampleBlocks& blocks;
    StepQueue& steps;
    StepLog& log;
    Pressing& pressing;
    Grinding& grinding;
    WheelControl& control;
    Recorders& recorders;
    std::uint32_t first_motion;

    /// Grinds the step whose turn it is, or cuts it: a wheel that would go on too far in it, or
    /// remove too much, is looked at in each part.
    void step();
    void grind(PressState state, double removal, double most);
};

void Run::step() {
    const PathStep& step = steps.step();
    grinding.rest_until(step.time - 0.5 * step.duration);
    grinding.expect(step, step.duration);
    const PressState state = control.look(blocks, step);
    if (const double parts = steps.divisible() ? control.parts(step) : 1.0; parts > 1.0)
        return steps.cut(parts);
    double removal = 0.0, most = 0.0;  // mm
    if (state != PressState::kNoContact) {
        removal = grinding.removal(step);
        most = kCoarse * std::max(pressing.indentation(), kLeastIndentation);
        if (removal > most && steps.divisible(removal / most)) return steps.cut(removal / most);
    }
    grind(state, removal, most);
}

void Run::grind(PressState state, double removal, double most) {
    const PathStep& step = steps.step();
    const std::uint32_t motion = first_motion + step.pose;
    const bool touches = state != PressState::kNoContact;
    recorders.tell(&Recorder::begin_step, StepTurn{step, motion, pressing});
    log.add(step, steps.number());
    blocks.clear_changes();
    if (touches)
        recorders.tell(&Recorder::touched,
                       Touch{pressing, state, grinding.belt(), removal, most, steps.parts()});
    StepEnd end{step, motion, pressing, state, touches || control.moves(), control.moves()};
    if (end.ground) {
        // A step that is told to be too coarse is not worth many parts, each of which maps anew.
        const double share = std::min(removal > most ? kCoarseShare : steps.share(), steps.share());
        const double asked = grinding.integrated_rate();
        end.volume = control.grind(grinding, step, share);
        end.asked = grinding.integrated_rate() - asked;
        end.impulse = grinding.impulse();
        end.greatest_force = grinding.greatest_force();
        end.deepest = grinding.deepest();
        end.bounce = control.bounce();
    }
    control.end(step);
    end.changes = blocks.changes();
    recorders.tell(&Recorder::end_step, end);
    steps.done();
}

void refuse_rigid(const ContactModel& model, const ProcessSettings& process) {
    if (!model.rigid()) return;
    if (process.wear.loads()) {
        throw InputError("simulation.rigid_loading",
                         "a geometric (rigid) tool cuts all that it meets, however loaded the belt "
                         "is; set the wear's loading share to 0");
    }
    if (process.force_control) {
        throw InputError("simulation.rigid_force",
                         "a geometric (rigid) tool has no force; set the control to position");
    }
}

/// All that goes on from step to step, the ground first.
std::vector<Stateful*> all_of(Stateful& ground, Stateful& pressing, Stateful& grinding,
                              Stateful& control, const Recorders& recorders) {
    std::vector<Stateful*> all = {&ground, &pressing, &grinding, &control};
    for (const auto& one : recorders.all()) all.push_back(one.get());
    return all;
}

/// Hands over the heights and what was recorded.
void finish(HeightField& field, const Run& run, SimulationResult& result) {
    run.recorders.tell(&Recorder::end);
    std::vector<double> heights = run.blocks.heights();
    for (std::size_t s = 0; s < field.size(); ++s)
        result.removed_volume += field.area[s] * (field.height[s] - heights[s]);
    result.model = run.pressing.describe();
    result.belt = run.grinding.belt();
    result.integrated_rate = run.grinding.integrated_rate();
    field.trace.clear();
    run.recorders.tell(&Recorder::keep, field, result);
    field.height.swap(heights);
    for (const PhaseTimes& times :
         {run.pressing.times(), run.grinding.times(), run.recorders.times()})
        result.wall += times;
}

}  // namespace

SimulationResult simulate(HeightField& field, const ToolPath& path, const ContactModel& model,
                          const RemovalLaw& law, const SimulationOptions& options,
                          const RunContext& context) {
    validate(field, options);
    const ProcessSettings& process = options.process;
    StepQueue steps = steps_of(path, options);
    SimulationResult result;
    result.process_time = path.duration();
    std::optional<SampleBlocks> blocks;  // the field stays as it is until all is done
    {
        const Stopwatch watch(result.wall.build);
        blocks.emplace(field, context);
    }
    StepLog log;
    Recorders recorders = make_recorders(*blocks, path, law, options, log, model.rigid());
    const double cell = contact_cell(field, tool_envelope(process).wheel, options.resolution);
    refuse_rigid(model, process);
    Pressing pressing(process, cell, options.resolution.contact_tolerance, model, context);
    Grinding grinding(*blocks, pressing, law, process, options.resolution.contact_tolerance,
                      recorders);
    const auto control = make_wheel_control(process, pressing);
    Ground ground(*blocks, options.outputs.first_motion);
    CheckpointKeeper checkpoints(options.outputs.checkpoints, steps, blocks->count(),
                                 all_of(ground, pressing, grinding, *control, recorders));
    {
        const Stopwatch watch(result.wall.build);
        pressing.map().prepare(*blocks);
    }
    recorders.tell(&Recorder::begin);
    checkpoints.restore(log);
    grinding.watch(checkpoints.changed());
    result.resumed = log.steps.size();
    result.unchanged = checkpoints.unchanged();

    Run run{*blocks,  steps,    log,       pressing,
            grinding, *control, recorders, options.outputs.first_motion};
    for (std::size_t i = 0; steps.next(); ++i) {
        if (i % kReportEvery == 0) {
            context.throw_if_cancelled();
            context.report(steps.progress());
        }
        checkpoints.look();
        run.step();
    }
    checkpoints.end();
    grinding.rest_until(path.duration());
    finish(field, run, result);
    context.report(1.0);
    return result;
}

}  // namespace beltgrinding

#include "beltgrinding/simulation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "actuated_wheel.h"
#include "base/stopwatch.h"
#include "beltgrinding/error.h"
#include "checkpoint_keeper.h"
#include "finish_keeper.h"
#include "grinding.h"
#include "heat_keeper.h"
#include "heightfield/sample_blocks.h"
#include "influence_keeper.h"
#include "pressing.h"
#include "process_monitor.h"
#include "simulation/recording.h"
#include "step_queue.h"
#include "trace_keeper.h"

namespace beltgrinding {
namespace {

// The wheel's cells must each hold samples: never finer than this many sample spacings.
constexpr double kSamplesPerCell = 1.5;
constexpr double kMostCellsAcross = 2000;
// Share of the wheel's indentation that may be ground in a step where the wheel follows the
// surface: beyond, the step is cut, since the wheel would sink where it has long gone on.
constexpr double kCoarse = 1.0;
constexpr double kCoarseShare = 0.01;       // of the parts at one place, for a step beyond cutting
constexpr double kLeastIndentation = 1e-6;  // mm
constexpr std::size_t kReportEvery = 16;    // steps between two looks at progress and cancel

void refuse_empty(const HeightField& field) {
    if (field.size() == 0) {
        throw InputError("simulation.empty_field",
                         "the height field is empty; select a face with an area");
    }
}

/// mm, of the wheel's grid. Throws InputError if the wheel's roundness would be lost in it, or if
/// its cells would be too many across.
double contact_cell(const HeightField& field, const ContactWheel& wheel,
                    const Resolution& resolution) {
    const double cell = std::max(resolution.contact_spacing, kSamplesPerCell * field.spacing);
    if (cell > wheel.radius) {
        const Arguments arguments = {{"cell", cell}, {"radius", wheel.radius}};
        if (cell > resolution.contact_spacing) {
            throw InputError("simulation.samples_too_coarse",
                             "the contact's cells of {cell:.3g} mm are larger than the wheel's "
                             "radius of {radius:.3g} mm; lower the samples' spacing",
                             arguments);
        }
        throw InputError("simulation.cells_too_coarse",
                         "the contact's cells of {cell:.3g} mm are larger than the wheel's radius "
                         "of {radius:.3g} mm; lower the contact spacing",
                         arguments);
    }
    if (wheel.width / cell > kMostCellsAcross) {
        throw InputError("simulation.cells_too_many",
                         "contact cells of {cell:.3g} mm are too many across a wheel of "
                         "{width:.3g} mm; raise the contact spacing, or check the wheel's width",
                         {{"cell", cell}, {"width", wheel.width}});
    }
    return cell;
}

void refuse_force_of_rigid(const ContactModel& model, const ProcessSettings& process) {
    if (model.rigid() && process.force_control) {
        throw InputError("simulation.rigid_force",
                         "a geometric (rigid) tool has no force; set the control to position");
    }
}

/// Clears a recording unless told to keep it: what a cancelled or failed run left of it is nothing.
class RecordingGuard {
  public:
    explicit RecordingGuard(Recording* recording) : recording_(recording) {}
    ~RecordingGuard() {
        if (recording_ != nullptr) recording_->clear();
    }
    RecordingGuard(const RecordingGuard&) = delete;
    RecordingGuard& operator=(const RecordingGuard&) = delete;
    void keep() { recording_ = nullptr; }

  private:
    Recording* recording_;
};

}  // namespace

SimulationResult simulate(HeightField& field, const ToolPath& path, const ContactModel& model,
                          const RemovalLaw& law, const SimulationOptions& options,
                          const RunContext& context) {
    const ProcessSettings& process = options.process;
    const Resolution& resolution = options.resolution;
    refuse_empty(field);
    process.validate();
    resolution.validate();
    options.limits.validate(field.size());
    options.heat.validate(field.size());
    options.finish.validate();
    StepQueue steps(path, {resolution.max_travel, resolution.max_angle, process.force});
    if (steps.planned() == 0) {
        throw InputError(
            "simulation.no_grinding_motion",
            "the path has no motion that grinds: it needs at least two poses, and other "
            "motions than rapid ones");
    }

    SimulationResult result;
    result.process_time = path.duration();
    result.steps.reserve(steps.planned());
    PhaseTimes& wall = result.wall;
    Recording* const recording = options.outputs.recording;
    RecordingGuard recording_guard(recording);
    std::optional<SampleBlocks> built;  // the field stays as it is until all is done
    {
        const Stopwatch watch(wall.build);
        built.emplace(field, context);
    }
    SampleBlocks& blocks = *built;
    if (recording != nullptr) recording->begin(field, path.duration(), blocks.samples());
    std::optional<CheckpointKeeper> keeper;
    if (options.outputs.checkpoints != nullptr) {
        keeper.emplace(*options.outputs.checkpoints, steps, blocks, options);
        keeper->restore(blocks);
    }
    ProcessMonitor monitor(blocks, path, process, options.limits, law);
    std::optional<TraceKeeper> trace;
    if (options.outputs.trace) trace.emplace(blocks);
    std::optional<InfluenceKeeper> influence;
    if (options.outputs.influence) influence.emplace(field.size());
    const double cell = contact_cell(field, tool_envelope(process).wheel, resolution);
    refuse_force_of_rigid(model, process);
    Pressing pressing(process, cell, resolution.contact_tolerance, model);
    {
        const Stopwatch watch(wall.build);
        pressing.map().prepare(blocks);
    }
    std::optional<HeatKeeper> heat;
    if (options.heat.part != nullptr && !model.rigid()) {
        const Stopwatch watch(wall.build);
        heat.emplace(blocks, options.heat, process.belt_speed);
    }
    std::optional<FinishKeeper> finish;
    if (options.finish.wanted && !model.rigid()) {
        const Stopwatch watch(wall.build);
        finish.emplace(blocks, options.finish, process.belt_speed, resolution.max_travel);
    }
    Grinding grinding(blocks, pressing, law, options, trace ? &*trace : nullptr,
                      heat ? &*heat : nullptr, finish ? &*finish : nullptr);
    std::optional<ActuatedWheel> wheel;  // of a force control that takes time
    if (process.force_control && !process.dynamics.ideal()) wheel.emplace(process, pressing);
    bool touched = false;
    const CheckpointKeeper::Parts running{blocks,
                                          monitor,
                                          pressing,
                                          grinding,
                                          trace ? &*trace : nullptr,
                                          influence ? &*influence : nullptr,
                                          heat ? &*heat : nullptr,
                                          finish ? &*finish : nullptr,
                                          wheel ? &*wheel : nullptr,
                                          recording,
                                          result.steps,
                                          touched};
    if (keeper) {
        keeper->restore(running);
        result.resumed = result.steps.size();
        result.unchanged = keeper->unchanged();
    }

    for (std::size_t i = 0; steps.next(); ++i) {
        if (i % kReportEvery == 0) {
            context.throw_if_cancelled();
            context.report(steps.progress());
        }
        if (keeper) keeper->look(running);
        const PathStep& step = steps.step();
        grinding.expect(step, step.duration);
        const auto state = wheel ? wheel->look(blocks, step)
                                 : pressing.press(blocks, step.work_from_contact, step.force);
        const bool moving = wheel && wheel->moves();
        if (wheel && steps.divisible()) {
            if (const double parts = wheel->parts(step); parts > 1.0) {
                steps.cut(parts);
                continue;
            }
        }
        double removal = 0.0, most = 0.0;  // mm
        if (state != Pressing::State::kNoContact) {
            removal = grinding.removal(step);
            most = kCoarse * std::max(pressing.indentation(), kLeastIndentation);
            if (removal > most && steps.divisible(removal / most)) {
                steps.cut(removal / most);
                continue;
            }
        }
        monitor.begin(step, steps.number());
        StepRecord record;
        record.time = step.time;
        record.pose = step.pose;
        record.duration = static_cast<float>(step.duration);
        record.feed = static_cast<float>(step.feed);

        if (finish) finish->begin_step(step, options.outputs.first_motion + step.pose);
        blocks.clear_changes();
        record.segments = static_cast<std::uint32_t>(pressing.localised());
        if (state != Pressing::State::kNoContact) {
            touched = true;
            const ContactSolution& contact = pressing.solution();
            record.approach = static_cast<float>(pressing.approach());
            record.contact_area = static_cast<float>(contact.area);
            record.peak_pressure = static_cast<float>(contact.peak_pressure);
            {
                const Stopwatch watch(wall.events);
                monitor.pressed(pressing, state, grinding.belt());
                if (removal > most) monitor.coarse(pressing, removal, most, steps.parts());
            }
        }
        if (state != Pressing::State::kNoContact || moving) {
            // A step that is told to be too coarse is not worth many parts, each of which maps
            // anew.
            const double share =
                std::min(removal > most ? kCoarseShare : steps.share(), steps.share());
            const double asked = grinding.integrated_rate();
            const double volume = moving  ? grinding.grind(step, share, *wheel)
                                  : wheel ? grinding.grind(wheel->lagging(step), share)
                                          : grinding.grind(step, share);
            touched = touched || grinding.impulse() > 0.0;
            record.force = static_cast<float>(grinding.impulse() / step.duration);
            record.deepest_approach = static_cast<float>(grinding.deepest());
            record.removal_rate = static_cast<float>(volume / step.duration);
            const Stopwatch watch(wall.events);
            monitor.ground(blocks.changes());
            monitor.lost(pressing, grinding.integrated_rate() - asked, volume);
            if (moving) monitor.moved(pressing, state, grinding.greatest_force(), wheel->bounce());
        }
        if (wheel) wheel->end(step);
        if (heat) {
            const Stopwatch watch(wall.heat);
            heat->end_step(step.time - 0.5 * step.duration, step.duration,
                           options.outputs.first_motion + step.pose);
            if (heat->hottest() > 0.0) monitor.heated(*heat, options.heat);
        }
        const auto changes = blocks.changes();
        if (trace && !changes.empty()) {
            const Stopwatch watch(wall.trace);
            trace->remove(changes, options.outputs.first_motion + step.pose);
        }
        if (influence && !changes.empty()) influence->remove(blocks, changes, step.pose);
        if (recording != nullptr) {
            recording->add_step(blocks, changes, step.time + 0.5 * step.duration);
        }
        result.steps.push_back(record);
        steps.done();
    }
    if (keeper) keeper->end(running);
    if (!touched && options.must_touch) {
        throw InputError(
            "simulation.never_touches",
            "the wheel never touches the stock on this path; check the frames of the "
            "cell (tool in hand or part in hand), the unit and the travel of the force "
            "control");
    }
    if (trace) trace->end();
    std::vector<double> heights = blocks.heights();
    for (std::size_t s = 0; s < field.size(); ++s)
        result.removed_volume += field.area[s] * (field.height[s] - heights[s]);
    context.report(1.0);
    result.events = monitor.take();
    result.model = pressing.describe();
    result.belt = grinding.belt();
    result.integrated_rate = grinding.integrated_rate();
    result.shifts = grinding.take_shifts();
    if (influence) result.influence = influence->take(path.poses().size());
    if (options.outputs.force_influence)
        result.force_influence = grinding.take_force_influence(path.poses().size());
    wall += pressing.times();
    wall += grinding.times();
    if (recording != nullptr) recording->end(blocks);
    if (heat) {
        const Stopwatch watch(wall.heat);
        heat->keep(path.duration(), field);
    }
    if (finish) {
        const Stopwatch watch(wall.finish);
        finish->keep(field);
    }
    if (trace) {
        trace->keep(field);
    } else {
        field.trace.clear();
    }
    field.height.swap(heights);
    recording_guard.keep();
    return result;
}

PoseContact contact_at(const HeightField& field, const ToolPath& path, std::size_t pose,
                       const ContactModel& model, const ProcessSettings& process,
                       const Resolution& resolution) {
    auto found = contacts_at(field, path, {pose}, model, process, resolution);
    if (!found.front()) {
        throw InputError("simulation.no_contact_at_pose",
                         "the wheel does not touch the stock at pose {pose}", {{"pose", pose + 1}});
    }
    return std::move(*found.front());
}

std::vector<std::optional<PoseContact>> contacts_at(const HeightField& field, const ToolPath& path,
                                                    const std::vector<std::size_t>& poses,
                                                    const ContactModel& model,
                                                    const ProcessSettings& process,
                                                    const Resolution& resolution,
                                                    const RunContext& context) {
    refuse_empty(field);
    process.validate();
    resolution.validate();
    for (const std::size_t pose : poses) {
        if (pose >= path.poses().size()) {
            throw InputError("simulation.no_such_pose",
                             "there is no pose {pose}; the path has {count}",
                             {{"pose", pose + 1}, {"count", path.poses().size()}});
        }
    }
    if (model.rigid()) {
        throw InputError("simulation.rigid_pressure",
                         "a geometric (rigid) tool has no pressure; choose an elastic model");
    }
    const SampleBlocks blocks(field, context);
    std::vector<std::optional<PoseContact>> result;
    for (const std::size_t pose : poses) {
        context.throw_if_cancelled();
        const PathPose& at = path.poses()[pose];
        PoseContact contact;
        contact.commanded = at.force >= 0.0 ? at.force : process.force;
        // One of its own each: a contact must not depend on the one before.
        Pressing pressing(process, contact_cell(field, tool_envelope(process).wheel, resolution),
                          resolution.contact_tolerance, model);
        const auto state = pressing.press(blocks, path.frames().work_from_contact(at.base_from_tcp),
                                          contact.commanded);
        if (state == Pressing::State::kNoContact) {
            result.emplace_back();
            continue;
        }
        contact.grid = pressing.map().grid();
        contact.gap = pressing.map().gap();
        contact.coverage = pressing.map().coverage();
        contact.solution = pressing.solution();
        contact.model = pressing.describe();
        contact.placed = pressing.approach() - contact.solution.approach;
        result.push_back(std::move(contact));
    }
    return result;
}

}  // namespace beltgrinding

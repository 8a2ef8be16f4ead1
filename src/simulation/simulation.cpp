#include "beltgrinding/simulation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/stopwatch.h"
#include "beltgrinding/error.h"
#include "heightfield/kdop_tree.h"
#include "pressing.h"
#include "process_monitor.h"
#include "trace_keeper.h"

namespace beltgrinding {
namespace {

// Explicit integration in time: in one go the surface may recede by this share of the wheel's
// indentation, so that the pressure follows the removal.
constexpr double kRecession = 0.1;
constexpr int kMaxParts = 200;  // of a step
// The wheel's cells must each hold samples: never finer than this many sample spacings.
constexpr double kSamplesPerCell = 1.5;
constexpr double kMostCellsAcross = 2000;
constexpr double kJoule = 1e-3;           // of a N mm
constexpr std::size_t kReportEvery = 16;  // steps between two looks at progress and cancel

void validate(const HeightField& field, const SimulationOptions& options) {
    options.wheel.validate();
    if (field.size() == 0)
        throw InputError("simulation.empty_field",
                         "the height field is empty; select a face with an area");
    const auto positive = [](double value, const char* code, const char* form) {
        if (!std::isfinite(value) || value <= 0.0) {
            throw InputError(code, form);
        }
    };
    positive(options.belt_speed, "simulation.belt_speed",
             "the belt speed must be positive and finite");
    positive(options.contact_spacing, "simulation.contact_spacing",
             "the contact grid's spacing must be positive and finite");
    positive(options.contact_tolerance, "simulation.contact_tolerance",
             "the contact tolerance must be positive and finite");
    if (options.force_control)
        positive(options.force_travel, "simulation.force_travel",
                 "the travel of the force control must be positive and finite");
    if (!std::isfinite(options.robot_stiffness) || options.robot_stiffness < 0.0) {
        throw InputError("simulation.robot_stiffness",
                         "the robot's stiffness must be zero (rigid) or positive");
    }
    options.belt.validate();
    if (!std::isfinite(options.heat_limit) || options.heat_limit < 0.0) {
        throw InputError("simulation.heat_limit",
                         "the limit of heat must be zero (none) or positive");
    }
    const std::size_t limits = options.lower_limits.size();
    if (limits > 1 && limits != field.size()) {
        throw InputError("simulation.lower_limits",
                         "the lower limits are neither one for all nor one per sample");
    }
    for (const double limit :
         {options.pressure_limit, options.orientation_jump, options.tilt_limit}) {
        if (!std::isfinite(limit) || limit < 0.0) {
            throw InputError(
                "simulation.limits",
                "the limits of pressure, orientation jump and tilt must be zero (none) or "
                "positive");
        }
    }
    if (!std::isfinite(options.belt_wear) || options.belt_wear < 0.0) {
        throw InputError("simulation.belt_wear", "the belt's wear factor must be zero or positive");
    }
}

/// mm, of the wheel's grid. Throws InputError if the wheel's roundness would be lost in it, or if
/// its cells would be too many across.
double contact_cell(const HeightField& field, const SimulationOptions& options) {
    const double cell = std::max(options.contact_spacing, kSamplesPerCell * field.spacing);
    if (cell > options.wheel.radius) {
        const Arguments arguments = {{"cell", cell}, {"radius", options.wheel.radius}};
        if (cell > options.contact_spacing) {
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
    if (options.wheel.width / cell > kMostCellsAcross) {
        throw InputError("simulation.cells_too_many",
                         "contact cells of {cell:.3g} mm are too many across a wheel of "
                         "{width:.3g} mm; raise the contact spacing, or check the wheel's width",
                         {{"cell", cell}, {"width", options.wheel.width}});
    }
    return cell;
}

void refuse_force_of_rigid(const ContactModel& model, const SimulationOptions& options) {
    if (model.rigid() && options.force_control) {
        throw InputError("simulation.rigid_force",
                         "a geometric (rigid) tool has no force; set the control to position");
    }
}

/// Restores the heights unless told to keep them: a cancelled or failed run leaves no trace.
class HeightGuard {
  public:
    explicit HeightGuard(HeightField& field) : field_(field), before_(field.height) {}
    ~HeightGuard() {
        if (!kept_) field_.height.swap(before_);
    }
    HeightGuard(const HeightGuard&) = delete;
    HeightGuard& operator=(const HeightGuard&) = delete;
    void keep() { kept_ = true; }
    const std::vector<double>& before() const { return before_; }

  private:
    HeightField& field_;
    std::vector<double> before_;
    bool kept_ = false;
};

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

/// Removes what the law says for the pressed wheel during one step, in as many parts as the
/// pressure needs to follow. Returns the volume, mm3.
double grind(HeightField& field, Pressing& pressing, const RemovalLaw& law, const PathStep& step,
             const SimulationOptions& options, TraceKeeper* trace,
             std::vector<std::uint32_t>& changed, SimulationResult& result) {
    double volume = 0.0;
    double left = step.duration;
    Eigen::ArrayXd rate, shifted;
    if (pressing.rigid()) {  // all that overlaps goes, whatever the law
        volume = pressing.map().cut(field, changed);
        result.belt.volume += volume;
        result.belt.time += step.duration;
        result.integrated_rate += volume;
        return volume;
    }
    while (left > 0.0) {
        double part = left;
        if (trace != nullptr) {
            const Stopwatch watch(result.trace_s);
            trace->press(pressing.map(), pressing.solution().pressure);
        }
        {
            const Stopwatch watch(result.removal_s);
            const ContactSolution& contact = pressing.solution();
            const ProcessState state{options.belt_speed,
                                     options.belt_wear * options.wear.remaining(result.belt),
                                     step.feed, contact.force, contact.area};
            law.rate(contact.pressure, state, rate);
            const double fastest = rate.maxCoeff();
            const double indentation = pressing.indentation();
            if (fastest > 0.0) {
                part =
                    std::clamp(kRecession * indentation / fastest, step.duration / kMaxParts, left);
            }
            // No cell recedes below the unloaded wheel, however far beyond reason the force is.
            const Eigen::ArrayXd most = (contact.approach - pressing.map().gap()).max(0.0) / part;
            rate = rate.min(most);
            for (std::size_t k = 0; k < options.shifted_laws.size(); ++k) {
                options.shifted_laws[k]->rate(contact.pressure, state, shifted);
                pressing.map().spread(shifted.min(most) - rate, part,
                                      result.shifts.col(static_cast<Eigen::Index>(k)));
            }
            const double removed = pressing.map().remove(field, rate, part, changed);
            volume += removed;
            result.belt.work += kJoule * contact.force * options.belt_speed * part;
            result.belt.volume += removed;
            result.belt.time += part;
            result.integrated_rate +=
                (rate * pressing.map().coverage()).sum() * pressing.map().grid().cell_area() * part;
        }
        left -= part;
        if (left <= 1e-12 * step.duration) break;
        if (pressing.press_again(field, step.force, result) == Pressing::State::kNoContact) break;
    }
    return volume;
}

}  // namespace

SimulationResult simulate(HeightField& field, const ToolPath& path, const ContactModel& model,
                          const RemovalLaw& law, const SimulationOptions& options,
                          const RunContext& context) {
    validate(field, options);
    SteppingOptions stepping = options.stepping;
    stepping.default_force = options.force;
    const std::vector<PathStep> steps = path.steps(stepping);
    if (steps.empty()) {
        throw InputError(
            "simulation.no_grinding_motion",
            "the path has no motion that grinds: it needs at least two poses, and other "
            "motions than rapid ones");
    }

    SimulationResult result;
    result.process_time = path.duration();
    result.steps.reserve(steps.size());
    result.belt = options.belt;
    result.shifts = Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(field.size()),
                                          static_cast<Eigen::Index>(options.shifted_laws.size()));
    HeightGuard guard(field);
    RecordingGuard recording_guard(options.recording);
    if (options.recording != nullptr) options.recording->begin(field, path.duration());
    ProcessMonitor monitor(field, path, steps, options, law);
    std::optional<TraceKeeper> trace;
    if (options.trace) trace.emplace(field);
    std::unique_ptr<SegmentTree> tree;
    {
        const Stopwatch watch(result.build_s);
        tree = std::make_unique<SegmentTree>(field, context);
    }
    const double cell = contact_cell(field, options);
    refuse_force_of_rigid(model, options);
    Pressing pressing(options, cell, model);
    std::vector<std::uint32_t> changed;
    bool touched = false;

    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (i % kReportEvery == 0) {
            context.throw_if_cancelled();
            context.report(static_cast<double>(i) / static_cast<double>(steps.size()));
        }
        const PathStep& step = steps[i];
        StepRecord record;
        record.time = step.time;
        record.pose = step.pose;
        record.duration = static_cast<float>(step.duration);
        record.feed = static_cast<float>(step.feed);

        changed.clear();
        const auto state = pressing.press(field, *tree, step.work_from_contact, step.force, result);
        record.segments = static_cast<std::uint32_t>(pressing.localised());
        if (state != Pressing::State::kNoContact) {
            touched = true;
            const ContactSolution contact = pressing.solution();
            record.force = static_cast<float>(contact.force);
            record.approach = static_cast<float>(pressing.approach());
            record.contact_area = static_cast<float>(contact.area);
            record.peak_pressure = static_cast<float>(contact.peak_pressure);
            {
                const Stopwatch watch(result.events_s);
                monitor.pressed(i, pressing, state, result.belt);
            }
            const double volume = grind(field, pressing, law, step, options,
                                        trace ? &*trace : nullptr, changed, result);
            record.removal_rate = static_cast<float>(volume / step.duration);
            {
                const Stopwatch watch(result.refit_s);
                std::sort(changed.begin(), changed.end());
                changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
                tree->refit(field, changed);
            }
            const Stopwatch watch(result.events_s);
            monitor.ground(i, changed);
        }
        if (trace && !changed.empty()) {
            const Stopwatch watch(result.trace_s);
            trace->remove(field, changed, options.first_motion + step.pose);
        }
        if (options.recording != nullptr) {
            options.recording->add_step(field, changed, step.time + 0.5 * step.duration);
        }
        result.steps.push_back(record);
    }
    if (!touched && options.must_touch) {
        throw InputError(
            "simulation.never_touches",
            "the wheel never touches the stock on this path; check the frames of the "
            "cell (tool in hand or part in hand), the unit and the travel of the force "
            "control");
    }
    for (std::size_t s = 0; s < field.size(); ++s) {
        result.removed_volume += field.area[s] * (guard.before()[s] - field.height[s]);
    }
    context.report(1.0);
    result.events = monitor.take();
    result.model = pressing.describe();
    if (options.recording != nullptr) options.recording->end(field);
    if (trace) {
        trace->keep(field);
    } else {
        field.trace.clear();
    }
    guard.keep();
    recording_guard.keep();
    return result;
}

PoseContact contact_at(const HeightField& field, const ToolPath& path, std::size_t pose,
                       const ContactModel& model, const SimulationOptions& options) {
    validate(field, options);
    if (pose >= path.poses().size()) {
        throw InputError("simulation.no_such_pose", "there is no pose {pose}; the path has {count}",
                         {{"pose", pose + 1}, {"count", path.poses().size()}});
    }
    const PathPose& at = path.poses()[pose];
    if (model.rigid()) {
        throw InputError("simulation.rigid_pressure",
                         "a geometric (rigid) tool has no pressure; choose an elastic model");
    }
    PoseContact contact;
    contact.commanded = at.force >= 0.0 ? at.force : options.force;
    const SegmentTree tree(field);
    Pressing pressing(options, contact_cell(field, options), model);
    SimulationResult phases;
    const auto state = pressing.press(
        field, tree, path.frames().work_from_contact(at.base_from_tcp), contact.commanded, phases);
    if (state == Pressing::State::kNoContact) {
        throw InputError("simulation.no_contact_at_pose",
                         "the wheel does not touch the stock at pose {pose}", {{"pose", pose + 1}});
    }
    contact.grid = pressing.map().grid();
    contact.gap = pressing.map().gap();
    contact.coverage = pressing.map().coverage();
    contact.solution = pressing.solution();
    contact.model = pressing.describe();
    contact.placed = pressing.approach() - contact.solution.approach;
    return contact;
}

}  // namespace beltgrinding

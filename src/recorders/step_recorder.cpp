#include "step_recorder.h"

#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {

void StepRecorder::begin_step(const StepTurn& turn) {
    StepRecord record;
    record.time = turn.step.time;
    record.pose = turn.step.pose;
    record.duration = static_cast<float>(turn.step.duration);
    record.feed = static_cast<float>(turn.step.feed);
    record.segments = static_cast<std::uint32_t>(turn.pressing.localised());
    records_.push_back(record);
}

void StepRecorder::touched(const Touch& touch) {
    touched_ = true;
    const ContactSolution& contact = touch.pressing.solution();
    StepRecord& record = records_.back();
    record.approach = static_cast<float>(touch.pressing.approach());
    record.contact_area = static_cast<float>(contact.area);
    record.peak_pressure = static_cast<float>(contact.peak_pressure);
}

void StepRecorder::end_step(const StepEnd& end) {
    if (!end.ground) return;
    touched_ = touched_ || end.impulse > 0.0;
    StepRecord& record = records_.back();
    record.force = static_cast<float>(end.impulse / end.step.duration);
    record.deepest_approach = static_cast<float>(end.deepest);
    record.removal_rate = static_cast<float>(end.volume / end.step.duration);
}

void StepRecorder::end() {
    if (touched_ || !must_touch_) return;
    throw InputError("simulation.never_touches",
                     "the wheel never touches the stock on this path; check the frames of the "
                     "cell (tool in hand or part in hand), the unit and the travel of the force "
                     "control, and that the surface's normals point out of the part");
}

void StepRecorder::keep(HeightField&, SimulationResult& result) {
    result.steps = std::move(records_);
    result.touched = touched_;
}

StepPart StepRecorder::take(std::span<const std::uint32_t>) {
    const auto from = records_.begin() + static_cast<std::ptrdiff_t>(given_);
    given_ = records_.size();
    return {{{from, records_.end()}}, touched_};
}

void StepRecorder::put(std::span<const StepPart* const> parts) {
    for (const StepPart* part : parts) {
        append<StepRecord>(records_, part->records.values);
        touched_ = part->touched;
    }
    given_ = records_.size();
}

}  // namespace beltgrinding

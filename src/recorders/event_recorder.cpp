#include "event_recorder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace beltgrinding {
namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr std::size_t kPause = 4;    // steps: noise at a threshold makes one event, not many
constexpr double kMetre = 1e-3;      // of a mm
constexpr double kStill = 1e-9;      // mm, no way
constexpr double kLostShare = 0.01;  // of what the law takes: less is not told
constexpr std::size_t kLanes = SampleBlocks::kLanes;

/// The bit of a position in its block.
std::uint64_t lane_of(std::size_t position) {
    return std::uint64_t{1} << position % kLanes;
}

}  // namespace

EventRecorder::EventRecorder(const SampleBlocks& blocks, const ToolPath& path,
                             const SimulationOptions& options, const RemovalLaw& law,
                             const StepLog& steps, const HeatRecorder* heat)
    : Keeps(&PhaseTimes::events),
      blocks_(blocks),
      field_(blocks.field()),
      path_(path),
      process_(options.process),
      limits_(options.limits),
      request_(options.heat),
      law_(law),
      steps_(steps.steps),
      planned_(steps.planned),
      heat_(heat),
      events_(path, kPause) {}

void EventRecorder::begin() {
    if (limits_.lower.empty()) return;
    below_.assign(blocks_.count(), 0);
    for (std::size_t k = 0; k < field_.size(); ++k) {
        if (blocks_.height(k) < lower_limit(k)) below_[k / kLanes] |= lane_of(k);
        highest_limit_ = std::max(highest_limit_, lower_limit(k));
    }
}

double EventRecorder::lower_limit(std::size_t position) const {
    const auto& limits = limits_.lower;
    return limits[limits.size() == 1 ? 0 : blocks_.sample(position)];
}

void EventRecorder::put(Event& event, std::size_t position) const {
    event.point = blocks_.top(position);
    event.face = field_.face[blocks_.sample(position)] + 1;
}

void EventRecorder::put(Event& event, const Pressing& pressing, double s, double y) const {
    if (const auto position = pressing.map().sample_near(s, y)) put(event, *position);
}

void EventRecorder::begin_step(const StepTurn& turn) {
    // A pass ends where the wheel leaves the work, and where it turns back.
    if (const std::size_t n = touched_.size(); n > 0) {
        const auto place = [](const PathStep& one) { return one.work_from_contact.translation(); };
        const bool back = n > 1 && (place(steps_[n - 1]) - place(steps_[n - 2]))
                                           .dot(place(turn.step) - place(steps_[n - 1])) < -kStill;
        if (touched_[n - 1] == 0 || back) ++pass_;
    }
    touched_.push_back(0);
}

void EventPart::append(const EventPart& next) {
    EventPart both = next;
    both.touched = std::move(touched);
    both.touched.append(next.touched);
    *this = std::move(both);
}

std::size_t EventPart::bytes() const {
    constexpr std::size_t kFact = 256;  // with its arguments, about
    std::size_t bytes = touched.bytes() + events.open.size() * sizeof(EventLog::Open);
    for (const Event& event : events.events) bytes += sizeof(Event) + kFact * event.facts.size();
    return bytes;
}

EventPart EventRecorder::take(std::span<const std::uint32_t>) {
    const auto from = touched_.begin() + static_cast<std::ptrdiff_t>(given_);
    given_ = touched_.size();
    return {{{from, touched_.end()}}, events_.state(), lost_, pass_};
}

void EventRecorder::put(std::span<const EventPart* const> parts) {
    for (const EventPart* part : parts) append<std::uint8_t>(touched_, part->touched.values);
    given_ = touched_.size();
    if (parts.empty()) return;
    const EventPart& now = *parts.back();
    events_.restore(now.events);
    lost_ = now.lost;
    pass_ = now.pass;
}

Event* EventRecorder::note(const char* kind, std::size_t index, double value, int part,
                           double badness) {
    return events_.note(kind, planned_[index], steps_[index], value, part, badness);
}

void EventRecorder::touched(const Touch& touch) {
    const auto& [pressing, state, belt, removal, most, parts] = touch;
    const std::size_t index = steps_.size() - 1;
    touched_[index] = 1;
    if (!pressing.rigid()) {  // of whose pressure nothing is known
        if (state == Pressing::State::kBeyondTravel) note_force(index, pressing);
        note_limits(index, pressing, belt);
        note_compression(index, pressing, state);
        note_distribution(index, pressing);
        note_hollow(index, pressing, false);
        note_hollow(index, pressing, true);
    }
    if (removal > most) coarse(touch);
}

void EventRecorder::end_step(const StepEnd& end) {
    if (end.ground) {
        ground(end.changes);
        lost(end);
        if (end.moving) moved(end);
    }
    if (heat_ != nullptr && heat_->hottest() > 0.0) heated();
}

void EventRecorder::note_force(std::size_t index, const Pressing& pressing) {
    const PathStep& step = steps_[index];
    const double force = pressing.solution().force;
    const bool low = force < step.force;
    // On the way to the surface and off it, less than the commanded force is no fault.
    if (low && step.plunging) return;
    Event* event = note(low ? "force_not_reached" : "force_exceeded", index, force);
    if (event == nullptr) return;
    event->limit = step.force;
    const Arguments arguments = {
        {"force", force}, {"commanded", step.force}, {"travel", process_.force_travel}};
    if (pressing.approach() > 0.0) {
        event->facts = {{"event.travel_ends_towards",
                         "{force:.3g} N in place of {commanded:.3g} N: the force control is at the "
                         "end of its travel, {travel:.3g} mm towards the work",
                         arguments}};
    } else {
        event->facts = {{"event.travel_ends_away",
                         "{force:.3g} N in place of {commanded:.3g} N: the force control is at the "
                         "end of its travel, {travel:.3g} mm away from the work",
                         arguments}};
    }
    put(*event, pressing, 0.0, 0.0);
}

void EventRecorder::note_limits(std::size_t index, const Pressing& pressing,
                                const BeltState& belt) {
    const PathStep& step = steps_[index];
    const ContactSolution& contact = pressing.solution();
    const auto put_at_peak = [&](Event& event) {
        Eigen::Index cell = 0;
        contact.pressure.maxCoeff(&cell);
        const ContactGrid& grid = pressing.map().grid();
        put(event, pressing, grid.s(static_cast<int>(cell) % grid.nx),
            grid.y(static_cast<int>(cell) / grid.nx));
    };
    if (!contact.converged) {
        if (Event* event = note("not_converged", index, contact.iterations)) {
            event->facts = {{"event.not_converged",
                             "the contact did not converge in {iterations} iterations",
                             {{"iterations", contact.iterations}}}};
            put_at_peak(*event);
        }
    }
    const double peak = contact.peak_pressure;
    if (limits_.pressure > 0.0 && peak > limits_.pressure) {
        if (Event* event = note("over_pressure", index, peak)) {
            event->limit = limits_.pressure;
            event->facts = {
                {"event.over_pressure",
                 "the pressure reaches {pressure:.3g} MPa, above the limit of {limit:.3g} MPa",
                 {{"pressure", peak}, {"limit", limits_.pressure}}}};
            put_at_peak(*event);
        }
    }
    const double heat = kMetre * peak * process_.belt_speed;
    const double heat_limit = kMetre * limits_.heat;
    if (heat_limit > 0.0 && heat > heat_limit) {
        if (Event* event = note("burn_risk", index, heat)) {
            event->limit = heat_limit;
            event->facts = {{"event.burn_risk",
                             "pressure times belt speed reaches {heat:.3g} MPa m/s, above the "
                             "limit of {limit:.3g} MPa m/s",
                             {{"heat", heat}, {"limit", heat_limit}}}};
            put_at_peak(*event);
        }
    }
    const ProcessState state{process_.belt_speed, 1.0, step.feed, contact.force, contact.area};
    if (const auto outside = law_.outside(peak, state)) {
        const double ratio = outside->value / outside->limit;
        const double badness = ratio > 0.0 ? std::abs(std::log(ratio)) : HUGE_VAL;
        Event* event = note("law_out_of_range", index, outside->value, 0, badness);
        if (event != nullptr) {
            event->limit = outside->limit;
            event->unit = outside->unit;
            event->facts = {outside->fact,
                            {"event.last_value_used", "the curve's last value is used", {}}};
            put_at_peak(*event);
        }
    }
    if (!process_.wear.measured(belt)) {
        if (Event* event = note("belt_out_of_range", index, belt.work)) {
            event->facts = {{"event.belt_not_measured",
                             "the belt has done more than its wear was measured for: {work:.4g} J",
                             {{"work", belt.work}}}};
        }
    }
}

void EventRecorder::heated() {
    const HeatRequest& request = request_;
    if (!(request.burn > 0.0)) return;
    const double rise = heat_->hottest(), highest = request.start + request.high * rise;
    if (!(highest > request.burn)) return;
    // Beside that of pressure times belt speed, in the same steps.
    constexpr int kByTemperature = 1;
    const double likely = request.start + rise, least = request.start + request.low * rise;
    Event* event = note("burn_risk", steps_.size() - 1, likely, kByTemperature);
    if (event == nullptr) return;
    event->limit = request.burn;
    event->unit = "°C";
    const Arguments arguments = {
        {"likely", likely}, {"least", least}, {"highest", highest}, {"limit", request.burn}};
    if (likely > request.burn) {
        event->severity = Severity::kError;
        event->facts = {{"event.burns",
                         "the surface reaches {likely:.0f} °C (from {least:.0f} to {highest:.0f} "
                         "°C, friction and partition being uncertain), above the material's limit "
                         "of {limit:.0f} °C",
                         arguments}};
    } else {
        event->severity = Severity::kWarning;
        event->facts = {{"event.may_burn",
                         "the surface reaches {likely:.0f} °C, but up to {highest:.0f} °C where "
                         "friction and partition are at the upper end of their ranges, above the "
                         "material's limit of {limit:.0f} °C",
                         arguments}};
    }
    put(*event, heat_->hottest_position());
}

void EventRecorder::ground(std::span<const SampleBlocks::Change> changes) {
    const std::size_t index = steps_.size() - 1;
    double deepest = 0.0, worst = 0.0;
    std::size_t deepest_at = 0, worst_at = 0;
    bool fresh = false;  // a sample was within its limits before
    const double of_interest = std::max(highest_limit_, -field_.depth);
    const auto look = [&](std::size_t k) {
        const double height = blocks_.height(k);
        if (height < deepest) deepest = height, deepest_at = k;
        if (below_.empty() || height >= lower_limit(k)) return;
        std::uint64_t& below = below_[k / kLanes];
        fresh = fresh || (below & lane_of(k)) == 0;
        below |= lane_of(k);
        if (height - lower_limit(k) < worst) worst = height - lower_limit(k), worst_at = k;
    };
    for (const SampleBlocks::Change& change : changes)
        if (blocks_.lowest(change.block) < of_interest) for_changed({&change, 1}, look);
    if (fresh) {
        if (Event* event = note("gouge", index, blocks_.height(worst_at), 0, -worst)) {
            event->limit = lower_limit(worst_at);
            event->facts = {{"event.gouge",
                             "ground to {height:.3f} mm, below the lower limit of {limit:.3g} mm",
                             {{"height", blocks_.height(worst_at)}, {"limit", event->limit}}}};
            put(*event, worst_at);
        }
    }
    if (deepest < -field_.depth) {
        if (Event* event = note("depth_exceeded", index, deepest)) {
            event->limit = -field_.depth;
            event->facts = {
                {"event.depth_exceeded",
                 "ground {depth:.3g} mm below the design, deeper than the segments reach",
                 {{"depth", -deepest}}}};
            put(*event, deepest_at);
        }
    }
}

void EventRecorder::note_orientation_jumps() {
    if (!(limits_.orientation_jump > 0.0)) return;
    const auto& poses = path_.poses();
    double time = 0.0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        PathStep step;
        step.pose = static_cast<std::uint32_t>(i);
        step.duration = path_.duration(i);
        step.time = time + 0.5 * step.duration;
        time += step.duration;
        const double angle = angle_between(poses[i - 1].base_from_tcp, poses[i].base_from_tcp);
        if (poses[i].rapid || angle <= limits_.orientation_jump) continue;
        // Each is a mistake of its own: steps of numbers far apart are never one event.
        Event* event = events_.note("orientation_jump", i * (kPause + 1), step, kDegrees * angle);
        if (event == nullptr) continue;
        event->limit = kDegrees * limits_.orientation_jump;
        event->facts = {{"event.orientation_jump",
                         "the tool turns by {angle:.1f} deg from pose to pose",
                         {{"angle", kDegrees * angle}}}};
        event->point = path_.frames().work_from_contact(path_.base_from_tcp(i, 0.5)).translation();
    }
}

// Between two contacts of a pass. A pass ends with a rapid motion, where the wheel lifts off along
// its pressing direction, and where it turns back.
void EventRecorder::note_lost_contact() {
    const auto& poses = path_.poses();
    std::vector<std::uint32_t> rapids(poses.size(), 0);  // up to the pose
    for (std::size_t i = 1; i < poses.size(); ++i) {
        rapids[i] = rapids[i - 1] + (poses[i].rapid ? 1u : 0u);
    }
    const auto position = [&](std::size_t i) { return steps_[i].work_from_contact.translation(); };
    std::size_t last = steps_.size();  // the last contact of this pass; none
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        if (touched_[i] == 0) continue;
        const std::size_t before = std::exchange(last, i);
        if (before >= steps_.size() || i == before + 1) continue;
        if (rapids[steps_[i].pose] != rapids[steps_[before].pose]) continue;
        const Vec3 heading =
            before > 0 ? Vec3(position(before) - position(before - 1)) : Vec3(Vec3::Zero());
        bool lost = true;
        for (std::size_t k = before + 1; k < i && lost; ++k) {
            const bool pressing = !process_.force_control || steps_[k].force > 0.0;
            const bool back = heading.dot(position(k) - position(k - 1)) < -kStill;
            lost = pressing && !steps_[k].plunging && !back;
        }
        if (!lost) continue;
        double way = 0.0;
        for (std::size_t k = before + 1; k < i; ++k) {
            way += steps_[k].feed * steps_[k].duration;
            Event* event = note("loss_of_contact", k, way);
            if (event == nullptr) continue;
            if (process_.machine.free_face()) {
                event->facts = {{"event.belt_loses_contact",
                                 "the belt loses the work for {way:.3g} mm of its way",
                                 {{"way", way}}}};
            } else {
                event->facts = {{"event.loss_of_contact",
                                 "the wheel loses the work for {way:.3g} mm of its way",
                                 {{"way", way}}}};
            }
            event->point = position(before + (k - before + 1) / 2);
        }
    }
}

void EventRecorder::moved(const StepEnd& end) {
    const Pressing& pressing = end.pressing;
    const double force = end.greatest_force, bounce = end.bounce;
    const std::size_t index = steps_.size() - 1;
    const PathStep& step = steps_[index];
    if (force > 0.0) touched_[index] = 1;
    const double most = (1.0 + limits_.overshoot) * step.force;
    const bool stopped = end.state == Pressing::State::kBeyondTravel;  // is told as such
    if (limits_.overshoot > 0.0 && step.force > 0.0 && force > most && !stopped) {
        if (Event* event = note("force_overshoot", index, force)) {
            event->limit = most;
            event->facts = {{"event.force_overshoot",
                             "{force:.3g} N in place of {commanded:.3g} N: the force control does "
                             "not follow the surface quickly enough",
                             {{"force", force}, {"commanded", step.force}}}};
            put(*event, pressing, 0.0, 0.0);
        }
    }
    if (bounce > 0.0 && bounce <= limits_.bounce) {
        if (Event* event = note("bounces", index, bounce)) {
            event->limit = limits_.bounce;
            if (pressing.flat()) {
                event->facts = {{"event.belt_bounces",
                                 "the belt leaves the work and is back after {time:.3g} s",
                                 {{"time", bounce}}}};
            } else {
                event->facts = {{"event.bounces",
                                 "the wheel leaves the work and is back after {time:.3g} s",
                                 {{"time", bounce}}}};
            }
            put(*event, pressing, 0.0, 0.0);
        }
    }
}

void EventRecorder::lost(const StepEnd& end) {
    const double less = end.asked - end.volume;
    lost_.asked += end.asked;
    lost_.lost += less;
    if (less <= lost_.most) return;
    lost_.most = less;
    lost_.step = steps_.size() - 1;
    lost_.position = end.pressing.map().sample_near(0.0, 0.0);
}

void EventRecorder::note_lost_volume() {
    if (!(lost_.lost > kLostShare * lost_.asked)) return;
    Event* event = note("volume_lost", lost_.step, lost_.lost);
    event->limit = kLostShare * lost_.asked;
    event->facts = {{"event.volume_lost",
                     "{lost:.3g} mm3 of the {asked:.4g} mm3 that the law takes on the whole path "
                     "({share:.1f} %) are taken from nowhere, most of it here",
                     {{"lost", lost_.lost},
                      {"asked", lost_.asked},
                      {"share", 100.0 * lost_.lost / lost_.asked}}}};
    if (lost_.position) put(*event, *lost_.position);
}

void EventRecorder::end() {
    note_lost_volume();
    note_orientation_jumps();
    note_lost_contact();
    ended_ = events_.take();
}

void EventRecorder::keep(HeightField&, SimulationResult& result) {
    result.events = std::move(ended_);
}

}  // namespace beltgrinding

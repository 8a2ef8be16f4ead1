#include "heat_recorder.h"

#include <algorithm>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// Of a step's beginning in what is noted; and of alpha t over the travel squared, where none is
// left. The greatest rise under a contact of some travels' length then differs least between steps.
constexpr double kBefore = 0.25, kAhead = 4.0;

}  // namespace

HeatRecorder::HeatRecorder(const SampleBlocks& blocks, const HeatRequest& request,
                           double belt_speed, double pause, double duration)
    : Keeps(&PhaseTimes::heat),
      blocks_(blocks),
      request_(request),
      belt_speed_(belt_speed),
      start_(request.part->state().time + pause),
      duration_(duration),
      conduction_(*request.part),
      position_(request.part->size(), 0),
      area_(request.part->size(), 0.0),
      force_(request.part->size(), 0.0),
      work_(request.part->size(), 0.0),
      contact_(request.part->size(), 0.0) {
    const auto& node_of = request.part->node_of();
    const auto samples = blocks.samples();
    constexpr std::size_t kLanes = SampleBlocks::kLanes;
    static_assert(kLanes == 64, "a bit each in NodeShare");
    for (std::size_t begin = 0; begin < samples.size(); begin += kLanes) {
        const std::size_t here = shares_.size();
        first_.push_back(static_cast<std::uint32_t>(here));
        std::size_t at = here;
        for (std::size_t k = begin; k < std::min(begin + kLanes, samples.size()); ++k) {
            const std::uint32_t node = node_of[samples[k]];
            // Neighbours often have the same.
            if (at == shares_.size() || shares_[at].node != node) {
                at = here;
                while (at < shares_.size() && shares_[at].node != node) ++at;
                if (at == shares_.size()) shares_.push_back({0, node});
            }
            shares_[at].samples |= std::uint64_t{1} << (k - begin);
            area_[node] += blocks.field().area[samples[k]];
            if (request.part->samples()[node] == samples[k])
                position_[node] = static_cast<std::uint32_t>(k);
        }
        if (shares_.size() - here > forces_.size()) forces_.resize(shares_.size() - here);
    }
    first_.push_back(static_cast<std::uint32_t>(shares_.size()));
}

std::string HeatRecorder::kind() const {
    return "heat in " + std::to_string(request_.part->size()) + " nodes";
}

void HeatRecorder::pressed(const Press& pressed) {
    const GapMap& map = pressed.pressing.map();
    const DisplacedPressure& pressure = pressed.pressing.displaced_pressure();
    const double force = pressed.pressing.pressing_force(), duration = pressed.duration;
    constexpr auto kLanes = SampleBlocks::kLanes;
    const auto press = [this](std::uint32_t node, double force_there) {
        if (!(force_there > 0.0)) return;  // its samples stand for nothing
        if (force_[node] == 0.0) pressed_.push_back(node);
        force_[node] += force_there;
    };
    const auto press_block = [&](std::size_t first, const float* values) {
        const std::size_t block = first / kLanes;
        const NodeShare* shares = &shares_[first_[block]];
        const std::size_t count = first_[block + 1] - first_[block];
        add_up_forces(values, blocks_.block(static_cast<std::uint32_t>(block)).area.data(), shares,
                      count, forces_.data());
        for (std::size_t k = 0; k < count; ++k) press(shares[k].node, forces_[k]);
    };
    map.for_pressed_blocks(
        pressure, press_block, [&](std::size_t position, double value, double on) {
            const std::size_t block = position / kLanes, lane = position % kLanes;
            const float area = blocks_.block(static_cast<std::uint32_t>(block)).area[lane];
            const NodeShare* share = &shares_[first_[block]];
            while ((share->samples >> lane & 1U) == 0) ++share;
            press(share->node, value * on * std::max(area, 0.0f));
        });
    // Their samples' mean pressure is the nodes'. The force is the contact's, to the last bit.
    const ThermalNodes& nodes = request_.part->nodes();
    double sum = 0.0;
    for (const std::uint32_t k : pressed_) {
        force_[k] *= nodes.area[k] / area_[k];
        sum += force_[k];
    }
    for (const std::uint32_t k : pressed_) {
        if (work_[k] == 0.0) worked_.push_back(k);
        work_[k] += force * force_[k] / sum * duration;
        force_[k] = 0.0;
    }
    pressed_.clear();
}

void HeatRecorder::end_step(const StepEnd& end) {
    const double duration = end.step.duration;
    const double travel = end.step.plunging ? 0.0 : end.step.feed * duration;
    conduction_.idle(start_ + (end.step.time - 0.5 * duration));
    const double share = request_.friction * request_.partition * belt_speed_ / duration;
    double power = 0.0, area = 0.0;
    for (const std::uint32_t k : worked_) {
        conduction_.add(k, share * work_[k]);
        power += share * work_[k];
        area += request_.part->nodes().area[k];
        contact_[k] += duration;
        work_[k] = 0.0;
    }
    worked_.clear();
    conduction_.advance(duration, end.motion, share_before(duration, travel));
    if (const double rise = conduction_.hottest(); rise > 0.0)
        refuse_vapour(rise, power, area, contact_[conduction_.hottest_node()]);
}

// A contact that stands still for a step heats the nodes that it is about to leave for too long.
// Heat that runs before the contact within the step evens that out.
double HeatRecorder::share_before(double duration, double travel) const {
    const double ahead = request_.part->material().diffusivity() * duration / (travel * travel);
    return travel > 0.0 ? kBefore * std::clamp((kAhead - ahead) / (kAhead - 1.0), 0.0, 1.0) : 0.0;
}

void HeatRecorder::refuse_vapour(double rise, double power, double area, double contact) const {
    const double greatest = request_.start + request_.high * rise;
    if (greatest <= HeatRequest::kVapour) return;
    throw InputError(
        "heat.boils",
        "the surface would reach {temperature:.4g} °C, up to {greatest:.4g} °C, where no metal is "
        "solid or liquid any more: {power:.4g} W flow into {area:.4g} mm², there for {contact:.4g} "
        "s so far; check force, belt speed, friction, partition, material and feed",
        {{"temperature", request_.start + rise},
         {"greatest", greatest},
         {"power", 1e-3 * power},
         {"area", area},
         {"contact", contact}});
}

std::size_t HeatRecorder::hottest_position() const {
    return position_[conduction_.hottest_node()];
}

void HeatRecorder::end() {
    conduction_.idle(start_ + duration_);
    settled_ = conduction_.settle();
}

void HeatRecorder::keep(HeightField& field, SimulationResult&) {
    request_.part->set_state(std::move(settled_));
    request_.part->keep(field);
}

}  // namespace beltgrinding

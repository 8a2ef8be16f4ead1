#include "heat_keeper.h"

#include <algorithm>

namespace beltgrinding {

HeatKeeper::HeatKeeper(const SampleBlocks& blocks, const HeatRequest& request, double belt_speed)
    : blocks_(blocks),
      request_(request),
      belt_speed_(belt_speed),
      start_(request.part->state().time),
      conduction_(*request.part),
      position_(request.part->size(), 0),
      area_(request.part->size(), 0.0),
      force_(request.part->size(), 0.0),
      work_(request.part->size(), 0.0) {
    const auto& node_of = request.part->node_of();
    const auto samples = blocks.samples();
    // Of whole blocks: the last one may have lanes without a sample.
    constexpr std::size_t kLanes = SampleBlocks::kLanes;
    node_.assign((samples.size() + kLanes - 1) / kLanes * kLanes, ThermalNodes::kNone);
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const std::uint32_t node = node_of[samples[k]];
        node_[k] = node;
        area_[node] += blocks.field().area[samples[k]];
        if (request.part->samples()[node] == samples[k])
            position_[node] = static_cast<std::uint32_t>(k);
    }
}

void HeatKeeper::press(const GapMap& map, const DisplacedPressure& pressure, double force,
                       double duration) {
    constexpr auto kLanes = SampleBlocks::kLanes;
    const auto press = [this](std::uint32_t node, double force_there) {
        if (!(force_there > 0.0)) return;  // its samples stand for nothing
        if (force_[node] == 0.0) pressed_.push_back(node);
        force_[node] += force_there;
    };
    // Samples of one node often follow each other.
    const auto press_block = [&](std::size_t first, const float* values) {
        const auto& area = blocks_.block(static_cast<std::uint32_t>(first / kLanes)).area;
        std::uint32_t node = ThermalNodes::kNone;
        double sum = 0.0;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::uint32_t next = node_[first + lane];
            if (next != node) {
                press(node, sum);
                node = next;
                sum = 0.0;
            }
            sum += double{values[lane]} * double{std::max(area[lane], 0.0f)};
        }
        press(node, sum);
    };
    map.for_pressed_blocks(pressure, press_block, [&](std::size_t position, double value) {
        const float area =
            blocks_.block(static_cast<std::uint32_t>(position / kLanes)).area[position % kLanes];
        press(node_[position], value * std::max(area, 0.0f));
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

void HeatKeeper::end_step(double begin, double duration, std::uint32_t motion) {
    conduction_.idle(start_ + begin);
    const double share = request_.friction * request_.partition * belt_speed_ / duration;
    for (const std::uint32_t k : worked_) {
        conduction_.add(k, share * work_[k]);
        work_[k] = 0.0;
    }
    worked_.clear();
    conduction_.advance(duration, motion);
}

std::size_t HeatKeeper::hottest_position() const {
    return position_[conduction_.hottest_node()];
}

void HeatKeeper::keep(double duration, HeightField& field) {
    conduction_.idle(start_ + duration);
    request_.part->set_state(conduction_.settle());
    request_.part->keep(field);
}

}  // namespace beltgrinding

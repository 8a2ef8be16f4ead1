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

void HeatKeeper::press(const GapMap& map, const DisplacedPressure& pressure, double force,
                       double duration) {
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
    map.for_pressed_blocks(pressure, press_block, [&](std::size_t position, double value) {
        const std::size_t block = position / kLanes, lane = position % kLanes;
        const float area = blocks_.block(static_cast<std::uint32_t>(block)).area[lane];
        const NodeShare* share = &shares_[first_[block]];
        while ((share->samples >> lane & 1U) == 0) ++share;
        press(share->node, value * std::max(area, 0.0f));
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

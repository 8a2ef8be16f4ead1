#include <algorithm>

#include "heat/conduction.h"
#include "heat/heat_rows.h"

// What is conducted outside the zone.

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
constexpr double kGrow = 0.25;  // of the time since heat came: an interval when none comes

}  // namespace

void Conduction::sweep(bool all) {
    put_beyond_back();
    layer_.conduct(zone_time_, zone_time_ - last_sweep_, factors_);
    last_sweep_ = zone_time_;
    const auto& nodes = layer_.nodes();
    for (const std::uint32_t k : nodes) changed_[k] = 1;
    if (rings_ <= kRings && (all || coarse_.due(zone_time_))) {
        hand_up(all);
        for (const std::uint32_t k : nodes)
            if (layer_.has(k))
                note_peak(k, sum_of_row(layer_.row(k)) + coarse_.rise(k, zone_time_).rise);
    } else {
        for (std::size_t i = 0; i < nodes.size(); ++i)
            note_peak(nodes[i], layer_.sums()[i] + coarse_.rise(nodes[i], zone_time_).rise);
    }
    take_beyond();
}

void Conduction::hand_up(bool all) {
    std::vector<std::uint32_t> nodes, ripe;
    std::vector<double> ages;
    const auto look = [&](std::uint32_t k, double old) {
        if (old <= coarse_.ripe()) return;
        nodes.push_back(k);
        ages.push_back(old);
    };
    for (const std::uint32_t k : layer_.nodes()) look(k, age(k));
    for (const std::uint32_t k : zone_.nodes) look(k, age(k));
    if (nodes.empty() && coarse_.empty()) return;
    const auto from_heat = [this](const Vec3& point) { return way(point); };
    coarse_.step(zone_time_, state_.heated, from_heat, all);
    if (coarse_.empty()) return;  // the part has too few nodes to be coarser
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::uint32_t k = nodes[i];
        const float keep = coarse_.kept(ages[i]);
        if (keep >= 1.0f) continue;
        if (keep == 0.0f && !in_zone(k)) {
            ripe.push_back(k);
            if (CoarseHeat::little(layer_.row(k))) continue;
        }
        const float* row = in_zone(k) ? &zone_rows_[place_[k] * kModes] : layer_.row(k);
        Row moved;
        for (std::size_t j = 0; j < kModes; ++j) moved[j] = (1.0f - keep) * row[j];
        coarse_.give(k, moved, zone_time_ - ages[i]);
    }
    coarse_.take([&](std::uint32_t k, const Row& row) {
        if (!in_zone(k) && !layer_.has(k)) {
            layer_.put(k, zone_time_);
            if (coarse_.kept(age(k)) == 0.0f) ripe.push_back(k);
        }
        float* rest = in_zone(k) ? &zone_rows_[place_[k] * kModes] : layer_.row(k);
        for (std::size_t j = 0; j < kModes; ++j) rest[j] -= row[j];
        changed_[k] = 1;
    });
    for (const std::uint32_t k : ripe) {
        if (!CoarseHeat::little(layer_.row(k))) continue;
        coarse_.give_rest(k, layer_.row(k));
        layer_.remove(k);
        changed_[k] = 1;
    }
    coarse_.read();
    for (const CoarseHeat::Risen& one : coarse_.risen(state_.peak))
        if (!in_zone(one.node) && !layer_.has(one.node)) note_peak(one.node, one.rise);
    find_base();
}

double Conduction::age(std::uint32_t node) const {
    return std::min(zone_time_ - state_.last[node],
                    in_zone(node) ? zone_age(ring_[node])
                                  : zone_time_ - state_.heated + way(nodes_.point[node]));
}

void Conduction::find_base() {
    base_.clear();
    slope_.clear();
    base_time_ = zone_time_;
    if (coarse_.empty()) return;
    for (const std::uint32_t k : zone_.nodes) {
        const CoarseHeat::Rise one = coarse_.rise(k, zone_time_);
        base_.push_back(one.rise);
        slope_.push_back(one.slope);
    }
}

void Conduction::catch_up(bool all) {
    forget_direct();
    note_ended();
    decay_bound(state_.time - zone_time_);
    if (!zone_.nodes.empty()) sweep();
    leave_zone();
    while (zone_time_ < state_.time) {
        const double step = std::max(unit_, kGrow * (zone_time_ - state_.heated));
        zone_time_ = std::min(state_.time, zone_time_ + step);
        sweep(all && zone_time_ == state_.time);
    }
}

const HeatState& Conduction::settle() {
    if (state_.time > zone_time_)
        catch_up();
    else
        sweep();
    note_ended();
    leave_zone();
    coarse_.settle(zone_time_, layer_);
    check_energy();
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) state_.warm[k] = layer_.has(k) ? 1 : 0;
    std::fill(changed_.begin(), changed_.end(), std::uint8_t{1});
    return state_;
}

}  // namespace beltgrinding

#include <algorithm>
#include <iterator>
#include <utility>

#include "heat/conduction.h"

// What a checkpoint holds.

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;

}  // namespace

std::size_t Conduction::Part::bytes() const {
    return nodes.size() * sizeof(Node) + (zone.size() + beyond.size()) * sizeof(std::uint32_t) +
           ring.size() + (rows.size() + base.size() + slope.size() + ended.size()) * sizeof(float) +
           coarse.bytes();
}

void Conduction::Part::append(const Part& next) {
    std::vector<Node> before;
    before.swap(nodes);
    *this = next;
    nodes.clear();
    // Of what is in both, the later one.
    std::set_union(next.nodes.begin(), next.nodes.end(), before.begin(), before.end(),
                   std::back_inserter(nodes),
                   [](const Node& a, const Node& b) { return a.node < b.node; });
}

Conduction::Part Conduction::next_part() {
    Part part;
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
        if (changed_[k] == 0 && !in_zone(k)) continue;
        changed_[k] = 0;
        Part::Node node{k,
                        state_.peak[k],
                        state_.source[k],
                        static_cast<std::uint8_t>(layer_.has(k) ? 1 : 0),
                        layer_.current(k),
                        state_.last[k],
                        {}};
        std::copy_n(layer_.row(k), kModes, node.modes.begin());
        part.nodes.push_back(node);
    }
    part.time = state_.time;
    part.flowed = state_.flowed;
    part.bound = state_.bound;
    part.most = state_.most;
    part.heated = state_.heated;
    part.zone_time = zone_time_;
    part.last_sweep = last_sweep_;
    part.motion = state_.motion;
    part.place = state_.place;
    part.half = state_.half;
    part.zone = zone_.nodes;
    part.beyond = beyond_;
    for (const std::uint32_t k : zone_.nodes) part.ring.push_back(ring_[k]);
    part.rows = zone_rows_;
    part.base = base_;
    part.slope = slope_;
    part.base_time = base_time_;
    for (const std::uint32_t k : last_) part.ended.push_back(ended_[k]);
    part.coarse = coarse_.parts();
    return part;
}

void Conduction::restore(std::span<const Part* const> parts) {
    for (const Part* part : parts) {
        for (const Part::Node& node : part->nodes) {
            const std::uint32_t k = node.node;
            state_.peak[k] = node.peak;
            state_.source[k] = node.source;
            state_.last[k] = node.last;
            layer_.remove(k);
            if (node.has != 0) layer_.put(k, node.current);
            layer_.current(k) = node.current;
            std::copy_n(node.modes.begin(), kModes, layer_.row(k));
        }
    }
    if (parts.empty()) return;
    const Part& now = *parts.back();
    state_.time = now.time;
    state_.flowed = now.flowed;
    state_.bound = now.bound;
    state_.most = now.most;
    state_.heated = now.heated;
    zone_time_ = now.zone_time;
    last_sweep_ = now.last_sweep;
    state_.motion = now.motion;
    state_.place = now.place;
    state_.half = now.half;
    zone_.nodes = now.zone;
    beyond_ = now.beyond;
    for (std::size_t i = 0; i < now.zone.size(); ++i) {
        ring_[now.zone[i]] = now.ring[i];
        layer_.lend(now.zone[i]);
    }
    place_zone();
    zone_rows_ = now.rows;
    base_ = now.base;
    slope_ = now.slope;
    base_time_ = now.base_time;
    if (!now.ended.empty()) last_ = now.zone;
    for (std::size_t i = 0; i < now.ended.size(); ++i) ended_[last_[i]] = now.ended[i];
    coarse_.restore(now.coarse);
}

}  // namespace beltgrinding

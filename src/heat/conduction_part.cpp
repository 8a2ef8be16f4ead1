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
           ring.size() + rows.size() * sizeof(float);
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

// Whatever changes of a node, the time changes that its modes are of; but in the zone.
Conduction::Part Conduction::next_part() {
    Part part;
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
        if (state_.warm[k] == 0 || (state_.current[k] < noted_ && !in_zone(k))) continue;
        Part::Node node{k,
                        state_.peak[k],
                        state_.source[k],
                        level_[k],
                        state_.current[k],
                        state_.conducted[k],
                        state_.last[k],
                        {}};
        std::copy_n(&state_.modes[k * kModes], kModes, node.modes.begin());
        part.nodes.push_back(node);
    }
    part.time = state_.time;
    part.heated = state_.heated;
    part.zone_time = noted_ = zone_time_;
    part.last_sweep = last_sweep_;
    part.motion = state_.motion;
    part.centre = state_.centre;
    part.radius = state_.radius;
    part.zone = zone_.nodes;
    part.beyond = beyond_;
    for (const std::uint32_t k : zone_.nodes) part.ring.push_back(ring_[k]);
    part.rows = zone_rows_;
    return part;
}

void Conduction::restore(std::span<const Part* const> parts) {
    for (const Part* part : parts) {
        for (const Part::Node& node : part->nodes) {
            const std::uint32_t k = node.node;
            state_.warm[k] = 1;
            state_.peak[k] = node.peak;
            state_.source[k] = node.source;
            level_[k] = node.level;
            state_.current[k] = node.current;
            state_.conducted[k] = node.conducted;
            state_.last[k] = node.last;
            std::copy_n(node.modes.begin(), kModes, &state_.modes[k * kModes]);
        }
    }
    if (parts.empty()) return;
    const Part& now = *parts.back();
    state_.time = now.time;
    state_.heated = now.heated;
    zone_time_ = noted_ = now.zone_time;
    last_sweep_ = now.last_sweep;
    state_.motion = now.motion;
    state_.centre = now.centre;
    state_.radius = now.radius;
    zone_.nodes = now.zone;
    beyond_ = now.beyond;
    for (std::size_t i = 0; i < now.zone.size(); ++i) ring_[now.zone[i]] = now.ring[i];
    place_zone();
    zone_rows_ = now.rows;
}

}  // namespace beltgrinding

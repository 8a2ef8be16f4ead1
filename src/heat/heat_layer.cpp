#include "heat/heat_layer.h"

#include <algorithm>
#include <cmath>

#include "heat/heat_rows.h"
#include "marked.h"

namespace beltgrinding {
namespace {

constexpr float kCold = 0.03f;    // K: less does not warm the neighbours
constexpr float kNoFast = 1e-3f;  // K: less of each of the faster modes is none

}  // namespace

HeatLayer::HeatLayer(const Grid& grid, double diffusivity, std::vector<float>& rows)
    : first_(grid.first),
      ways_(grid.neighbour.size()),
      dispersion_(grid.dispersion),
      diffusivity_(diffusivity),
      rows_(rows),
      current_(grid.area.size(), 0.0),
      mark_(grid.area.size(), kNothing),
      place_(grid.area.size(), 0) {
    for (std::uint32_t k = 0; k < size(); ++k) {
        for (std::uint32_t e = first_[k]; e < first_[k + 1]; ++e) {
            const std::uint32_t other = grid.neighbour[e];
            const double rate = diffusivity * grid.conductance[e] / grid.area[k];
            // Two halves of the way in a row, each with its section.
            const double depths = double{grid.depth[k]} + grid.depth[other];
            ways_[e] = {other, static_cast<float>(rate),
                        static_cast<float>(rate * 2.0 * grid.depth[other] / depths)};
        }
    }
}

void HeatLayer::remove(std::uint32_t node) {
    std::fill_n(row(node), kModes, 0.0f);
    mark_[node] = kNothing;
}

void HeatLayer::list(std::vector<std::uint32_t>& nodes) const {
    nodes.clear();
    for_marked(mark_, kHas, [&](std::uint32_t k) { nodes.push_back(k); });
}

void HeatLayer::spread(double now) {
    list(nodes_);
    bool any = false;
    for (const std::uint32_t k : nodes_) {
        if (greatest_of_row(row(k)) < kCold) continue;
        for (std::uint32_t e = first_[k]; e < first_[k + 1]; ++e) {
            if (mark_[ways_[e].other] != kNothing) continue;
            put(ways_[e].other, now);
            any = true;
        }
    }
    if (any) list(nodes_);
}

void HeatLayer::join() {
    patch_.clear();
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        const std::uint32_t k = nodes_[i];
        bool slow = fast_[i] == 0;
        double sum = 0.0;
        patch_.first.push_back(static_cast<std::uint32_t>(patch_.ways.size()));
        for (std::uint32_t e = first_[k]; e < first_[k + 1]; ++e) {
            const HeatWay& way = ways_[e];
            if (mark_[way.other] != kHas) continue;
            const std::uint32_t place = place_[way.other];
            slow = slow && fast_[place] == 0;
            patch_.ways.push_back({place, way.rate, way.mean_rate});
            sum += std::max(std::abs(way.rate), std::abs(way.mean_rate));
        }
        patch_.slow.push_back(slow ? 1 : 0);
        patch_.most = std::max(patch_.most, sum);
    }
    patch_.first.push_back(static_cast<std::uint32_t>(patch_.ways.size()));
}

void HeatLayer::conduct(double now, double duration, DepthFactors& factors) {
    spread(now);
    const std::size_t count = nodes_.size();
    if (now_.size() < count * kModes) now_.resize(count * kModes);
    fast_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t k = nodes_[i];
        float* one = &now_[i * kModes];
        std::copy_n(row(k), kModes, one);
        const double since = std::max(now - current_[k], 0.0);
        fast_[i] = decay_row(one, factors(since).decay.data()) > kNoFast ? 1 : 0;
        current_[k] = now;
        place_[k] = i;
    }
    if (duration > 0.0 && count > 0) {
        join();
        conductor_.conduct(patch_, duration, dispersion_ / (diffusivity_ * duration), now_);
    }
    for (std::size_t i = 0; i < count; ++i) std::copy_n(&now_[i * kModes], kModes, row(nodes_[i]));
    sums_.resize(count);
    sum_rows(now_.data(), count, sums_.data());
}

}  // namespace beltgrinding

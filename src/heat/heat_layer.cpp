#include "heat/heat_layer.h"

#include <algorithm>
#include <cmath>

#include "heat/heat_rows.h"
#include "heat/heat_spectrum.h"
#include "marked.h"

namespace beltgrinding {
namespace {

constexpr float kCold = 0.03f;    // K: less does not warm the neighbours
constexpr float kNoFast = 1e-3f;  // K: less of each of the faster modes is none
constexpr double kReach = 1.3;  // nodes that heat gets farther, by the root of alpha t / spacing^2
// alpha t over spacing^2: longer than anything stays on a level but the last; and where a spectrum
// costs less than a series.
constexpr double kLongest = 64.0;
constexpr double kEven = 16.0;

}  // namespace

HeatLayer::HeatLayer(const Grid& grid, double diffusivity, std::vector<float>& rows)
    : first_(grid.first),
      ways_(grid.neighbour.size()),
      spacing_(grid.spacing),
      dispersion_(grid.dispersion),
      diffusivity_(diffusivity),
      even_(grid.even),
      rows_(rows),
      current_(grid.area.size(), 0.0),
      mark_(grid.area.size(), kNothing),
      place_(grid.area.size(), 0) {
    for (std::uint32_t k = 0; k < size(); ++k) {
        for (std::uint32_t e = first_[k]; e < first_[k + 1]; ++e) {
            const std::uint32_t other = grid.neighbour[e];
            const double rate = diffusivity * grid.conductance[e] / grid.area[k];
            const double mass = double{grid.area[k]} * grid.depth[k];
            ways_[e] = {other, static_cast<float>(rate),
                        static_cast<float>(diffusivity * grid.sectional[e] / mass)};
        }
    }
}

void HeatLayer::add(std::uint32_t node, float* from, const Row& share) {
    float* to = row(node);
    for (std::size_t j = 0; j < kModes; ++j) {
        to[j] += share[j] * from[j];
        if (share[j] == 0.0f) from[j] = 0.0f;
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

void HeatLayer::spread(double now, double duration) {
    list(nodes_);
    bool any = false;
    front_.clear();
    for (const std::uint32_t k : nodes_)
        if (greatest_of_row(row(k)) >= kCold) front_.push_back(k);
    const double rings = std::ceil(kReach * std::sqrt(diffusivity_ * duration) / spacing_);
    for (double ring = 0.0; ring < std::max(rings, 1.0) && !front_.empty(); ++ring) {
        reached_.clear();
        for (const std::uint32_t k : front_) {
            for (std::uint32_t e = first_[k]; e < first_[k + 1]; ++e) {
                if (mark_[ways_[e].other] != kNothing) continue;
                put(ways_[e].other, now);
                reached_.push_back(ways_[e].other);
            }
        }
        any = any || !reached_.empty();
        front_.swap(reached_);
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

bool HeatLayer::conduct_even(double now, double duration, DepthFactors& factors) {
    const double squares = diffusivity_ * duration / (spacing_ * spacing_);
    if (even_ == nullptr || squares < kEven || !even_->spectrum().possible()) return false;
    if (std::find(mark_.begin(), mark_.end(), kElsewhere) != mark_.end()) return false;
    list(nodes_);
    for (const std::uint32_t k : nodes_)
        decay_row(row(k), factors(std::max(now - current_[k], 0.0)).decay.data());
    even_->spectrum().conduct(diffusivity_ * duration, rows_.data());
    nodes_.resize(size());
    sums_.resize(size());
    for (std::uint32_t k = 0; k < size(); ++k) {
        nodes_[k] = k;
        mark_[k] = kHas;
        current_[k] = now;
    }
    sum_rows(rows_.data(), size(), sums_.data());
    return true;
}

void HeatLayer::conduct(double now, double duration, DepthFactors& factors) {
    if (conduct_even(now, duration, factors)) return;
    duration = std::min(duration, kLongest * spacing_ * spacing_ / diffusivity_);
    spread(now, duration);
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

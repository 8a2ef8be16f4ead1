#include "heat/conduction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "heat/heat_rows.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
constexpr std::uint8_t kOutside = 255;
constexpr int kInnerRings = 3;  // that the heat may come to before a new zone is made
// A zone is kept until alpha t is this share of spacing^2: what goes over its border is conducted
// then, and could not go on further in longer times. Steps are divided, but not in more than so
// many.
constexpr double kBorder = 0.25;
constexpr int kMostParts = 4;
constexpr double kDue = 0.05;   // of the time in which what is there changes: an interval of sweeps
constexpr double kGrow = 0.25;  // of the time since heat came: an interval when none comes
constexpr std::size_t kLevels = 32;
constexpr int kLevelled = 8;         // sweeps from one look at the levels to the next
constexpr float kLeastRise = 1e-3f;  // K: less is none
constexpr double kCold = 0.01;       // K: less does not warm the neighbours

}  // namespace

Conduction::Conduction(const PartHeat& part, int rings)
    : nodes_(part.nodes()),
      rings_(rings),
      material_(part.material()),
      diffusivity_(material_.diffusivity()),
      longest_(kBorder * nodes_.spacing * nodes_.spacing / diffusivity_),
      state_(part.state()),
      power_(nodes_.size(), 0.0),
      ring_(nodes_.size(), kOutside),
      place_(nodes_.size(), ThermalNodes::kNone),
      direct_(nodes_.size(), 0.0f),
      level_(nodes_.size(), 0),
      zone_time_(state_.time),
      zone_made_(state_.time) {}

void Conduction::add(std::uint32_t node, double power) {
    if (!(power > 0.0)) return;
    if (power_[node] == 0.0) powered_.push_back(node);
    power_[node] += power;
}

void Conduction::advance(double duration, std::uint32_t motion) {
    if (!(duration > 0.0)) {
        for (const std::uint32_t k : powered_) power_[k] = 0.0;
        powered_.clear();
        return;
    }
    if (powered_.empty()) {
        idle(state_.time + duration);
        return;
    }
    if (state_.time > zone_time_) catch_up();
    state_.motion = motion;
    hottest_ = 0.0;
    const int parts =
        static_cast<int>(std::clamp(std::ceil(duration / longest_), 1.0, double{kMostParts}));
    for (int part = 0; part < parts; ++part) {
        if (!zone_holds()) make_zone();
        heat(duration / parts);
    }
    for (const std::uint32_t k : powered_) power_[k] = 0.0;
    powered_.clear();
}

void Conduction::idle(double time) {
    state_.time = std::max(state_.time, time);
    hottest_ = 0.0;
}

bool Conduction::zone_holds() const {
    if (zone_.nodes.empty() || state_.time - zone_made_ >= longest_) return false;
    return std::all_of(powered_.begin(), powered_.end(),
                       [this](std::uint32_t k) { return ring_[k] <= kInnerRings; });
}

void Conduction::make_zone() {
    // Breadth first from the heat, through the ways and through thin sections.
    std::vector<std::uint32_t> found = powered_;
    std::vector<std::uint8_t> ring(nodes_.size(), kOutside);
    for (const std::uint32_t k : powered_) ring[k] = 0;
    std::size_t begin = 0;
    std::vector<std::uint32_t> beside;
    for (int r = 0; r <= rings_; ++r) {
        const auto reach = [&](std::uint32_t k, std::vector<std::uint32_t>& list) {
            if (k == ThermalNodes::kNone || ring[k] != kOutside) return;
            ring[k] = static_cast<std::uint8_t>(r + (&list == &found && r < rings_ ? 1 : 0));
            list.push_back(k);
        };
        const std::size_t end = found.size();
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t node = found[k];
            auto& list = r < rings_ ? found : beside;
            reach(nodes_.opposite[node], list);
            for (std::uint32_t e = nodes_.first[node]; e < nodes_.first[node + 1]; ++e)
                reach(nodes_.neighbour[e], list);
        }
        begin = end;
    }
    for (const std::uint32_t k : beside) ring[k] = kOutside;
    std::sort(found.begin(), found.end());
    sweep(state_.time, found, false);
    leave_zone();
    ring_.swap(ring);
    zone_.nodes.swap(found);
    state_.centre.setZero();
    for (const std::uint32_t k : powered_) state_.centre += nodes_.point[k];
    state_.centre /= static_cast<double>(powered_.size());
    state_.radius = 0.0;
    for (const std::uint32_t k : powered_)
        state_.radius = std::max(state_.radius, (nodes_.point[k] - state_.centre).norm());
    for (const auto* list : {&zone_.nodes, &beside}) {
        for (const std::uint32_t k : *list) {
            if (state_.warm[k] == 0) state_.current[k] = state_.time;
            state_.warm[k] = 1;
            state_.last[k] = state_.time;
        }
    }
    // What was cold until now has nothing to conduct from before.
    for (const std::uint32_t k : zone_.nodes) state_.conducted[k] = state_.time;
    join(zone_, [](std::uint32_t, std::uint32_t) { return 1.0; });
    zone_made_ = zone_time_ = state_.time;
}

template <class Interval>
void Conduction::join(Patch& patch, Interval interval) {
    patch.first.assign(1, 0);
    patch.neighbour.clear();
    patch.rate.clear();
    patch.mean_rate.clear();
    patch.most = 0.0;
    for (std::size_t k = 0; k < patch.nodes.size(); ++k)
        place_[patch.nodes[k]] = static_cast<std::uint32_t>(k);
    for (const std::uint32_t node : patch.nodes) {
        double sum = 0.0;
        const double depth = 1.0 / nodes_.own[node].modes[0];
        for (std::uint32_t e = nodes_.first[node]; e < nodes_.first[node + 1]; ++e) {
            const std::uint32_t other = nodes_.neighbour[e];
            if (place_[other] == ThermalNodes::kNone) continue;
            const double time = interval(node, other);
            if (!(time > 0.0)) continue;
            const double rate = time * diffusivity_ * nodes_.conductance[e] / nodes_.area[node];
            // Two halves of the way in a row, each with its section.
            const double others = 1.0 / nodes_.own[other].modes[0];
            const double mean = rate * 2.0 * others / (depth + others);
            patch.neighbour.push_back(place_[other]);
            patch.rate.push_back(static_cast<float>(rate));
            patch.mean_rate.push_back(static_cast<float>(mean));
            sum += std::max(rate, mean);
        }
        patch.most = std::max(patch.most, sum);
        patch.first.push_back(static_cast<std::uint32_t>(patch.neighbour.size()));
    }
    for (const std::uint32_t node : patch.nodes) place_[node] = ThermalNodes::kNone;
}

// By as many stages as stability asks for: Meyer, Balsara, Aslam: A stabilized
// Runge-Kutta-Legendre method for explicit super-time-stepping (J. Comput. Phys. 257, 2014), RKL1.
void Conduction::conduct(const Patch& patch, double duration) {
    const double stiff = 2.0 * duration * patch.most;
    if (!(stiff > 0.0)) return;
    const int stages =
        std::max(1, static_cast<int>(std::ceil(0.5 * (std::sqrt(1.0 + 4.0 * stiff) - 1.0))));
    const std::size_t count = patch.nodes.size();
    for (auto& rows : rows_) rows.resize(count * kModes);
    auto gather = rows_[0].begin();
    for (const std::uint32_t k : patch.nodes)
        gather = std::copy_n(state_.modes.begin() + static_cast<std::ptrdiff_t>(k * kModes), kModes,
                             gather);
    const HeatWays ways{count, patch.first.data(), patch.neighbour.data(), patch.rate.data(),
                        patch.mean_rate.data()};
    const double share = 2.0 / (static_cast<double>(stages) * (stages + 1.0));
    float *before = rows_[0].data(), *now = rows_[1].data(), *next = rows_[2].data();
    conduct_stage(ways, before, before, now, 1.0f, 0.0f, static_cast<float>(share * duration));
    for (int j = 2; j <= stages; ++j) {
        const double a = (2.0 * j - 1.0) / j;
        conduct_stage(ways, now, before, next, static_cast<float>(a), static_cast<float>(1.0 - a),
                      static_cast<float>(a * share * duration));
        std::swap(before, now);
        std::swap(now, next);
    }
    for (std::size_t k = 0; k < count; ++k)
        std::copy_n(now + k * kModes, kModes, &state_.modes[patch.nodes[k] * kModes]);
}

void Conduction::set_duration(double duration) {
    if (duration == duration_) return;
    duration_ = duration;
    const auto& rates = DepthModes::rates();
    for (std::size_t j = 0; j < kModes; ++j) {
        const double lost = -std::expm1(-rates[j] * diffusivity_ * duration);
        decay_[j] = static_cast<float>(1.0 - lost);
        gain_[j] = static_cast<float>(j == 0 ? duration / material_.capacity()
                                             : lost / (material_.conductivity * rates[j]));
    }
}

void Conduction::decay(std::uint32_t node, double duration) {
    set_duration(duration);
    decay_row(&state_.modes[node * kModes], decay_.data());
}

void Conduction::heat(double duration) {
    const auto flux = [this](std::uint32_t k) {
        return k == ThermalNodes::kNone ? 0.0f : static_cast<float>(power_[k] / nodes_.area[k]);
    };
    // Half of the flux, conduction along the surface, the other half: second order in time.
    set_duration(0.5 * duration);
    for (int half = 0; half < 2; ++half) {
        for (const std::uint32_t node : zone_.nodes) {
            const float in = flux(node), there = flux(nodes_.opposite[node]);
            heat_row(&state_.modes[node * kModes], decay_.data(), gain_.data(),
                     nodes_.own[node].modes.data(), in, nodes_.other[node].modes.data(), there);
            direct_[node] = (nodes_.own[node].direct * in + nodes_.other[node].direct * there) /
                            static_cast<float>(material_.conductivity);
        }
        if (half == 0) conduct(zone_, duration);
    }
    state_.time += duration;
    state_.heated = zone_time_ = state_.time;
    for (const std::uint32_t k : zone_.nodes) state_.current[k] = state_.time;
    note_peaks(zone_.nodes, true);
}

double Conduction::rise(std::uint32_t node) const {
    double sum = direct_[node];
    for (std::size_t j = 0; j < kModes; ++j) sum += state_.modes[node * kModes + j];
    return sum;
}

void Conduction::note_peaks(std::span<const std::uint32_t> nodes, bool heated) {
    for (const std::uint32_t node : nodes) {
        const auto now = static_cast<float>(rise(node));
        if (now > std::max(state_.peak[node], kLeastRise)) {
            state_.peak[node] = now;
            state_.source[node] = state_.motion;
        }
        if (heated && now > hottest_) {
            hottest_ = now;
            hottest_node_ = node;
        }
    }
}

// What was heated changes in the time since; what is not yet, in that of the way to it.
void Conduction::set_levels(double now) {
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
        const double away =
            std::max((nodes_.point[k] - state_.centre).norm() - state_.radius, nodes_.spacing);
        const double way = now - state_.heated + away * away / (4.0 * diffusivity_);
        const double wanted = kDue * std::min(now - state_.last[k], way);
        const int level = wanted > longest_ ? std::ilogb(wanted / longest_) : 0;
        level_[k] = static_cast<std::uint8_t>(std::min(level, static_cast<int>(kLevels) - 1));
    }
}

void Conduction::sweep(double now, std::span<const std::uint32_t> must, bool everything) {
    enum : std::uint8_t { kNot, kBeside, kDueNow };
    const auto in_zone = [this](std::uint32_t k) { return ring_[k] != kOutside; };
    due_.assign(nodes_.size(), kNot);
    for (const std::uint32_t k : must)
        if (state_.warm[k] != 0) due_[k] = kDueNow;
    if (sweeps_++ % kLevelled == 0) set_levels(now);
    // All of a level at the same times: neighbours are due together.
    std::array<double, kLevels> begun;
    for (std::size_t level = 0; level < kLevels; ++level) {
        const double interval = std::ldexp(longest_, static_cast<int>(level));
        begun[level] = interval * std::floor(now / interval);
    }
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
        if (state_.warm[k] == 0) continue;
        if (everything || in_zone(k) || state_.conducted[k] < begun[level_[k]]) due_[k] = kDueNow;
    }
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
        if (due_[k] != kDueNow) continue;
        const float* row = &state_.modes[k * kModes];
        const bool cold = std::all_of(
            row, row + kModes, [](float t) { return std::abs(t) < static_cast<float>(kCold); });
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e) {
            const std::uint32_t other = nodes_.neighbour[e];
            if (due_[other] != kNot || (cold && state_.warm[other] == 0)) continue;
            due_[other] = kBeside;
            if (state_.warm[other] != 0) continue;
            // Before, there was nothing to go on from it.
            state_.warm[other] = 1;
            state_.current[other] = now;
            state_.conducted[other] = state_.conducted[k];
        }
    }
    auto& nodes = swept_.nodes;
    nodes.clear();
    for (std::uint32_t k = 0; k < nodes_.size(); ++k)
        if (due_[k] != kNot) nodes.push_back(k);
    join(swept_, [&](std::uint32_t a, std::uint32_t b) {
        if ((in_zone(a) && in_zone(b)) || (due_[a] == kBeside && due_[b] == kBeside)) return 0.0;
        return now - std::max(state_.conducted[a], state_.conducted[b]);
    });
    for (const std::uint32_t k : nodes) {
        if (const double since = now - state_.current[k]; since > 0.0) decay(k, since);
        state_.current[k] = now;
    }
    conduct(swept_, 1.0);
    for (const std::uint32_t k : nodes) {
        if (due_[k] == kDueNow) state_.conducted[k] = now;
    }
    note_peaks(nodes, false);
}

void Conduction::leave_zone() {
    for (const std::uint32_t k : zone_.nodes) {
        ring_[k] = kOutside;
        direct_[k] = 0.0f;
    }
    zone_.nodes.clear();
}

void Conduction::catch_up() {
    if (!zone_.nodes.empty()) {
        sweep(zone_time_, {}, false);
        leave_zone();
    }
    while (zone_time_ < state_.time) {
        const double step = std::max(longest_, kGrow * (zone_time_ - state_.heated));
        zone_time_ = std::min(state_.time, zone_time_ + step);
        sweep(zone_time_, {}, false);
    }
}

const HeatState& Conduction::settle() {
    if (state_.time > zone_time_) catch_up();
    sweep(state_.time, {}, true);
    zone_made_ = state_.time;
    return state_;
}

}  // namespace beltgrinding

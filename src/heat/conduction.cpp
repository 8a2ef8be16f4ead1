#include "heat/conduction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "heat/heat_rows.h"
#include "marked.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
constexpr int kInnerRings = 3;          // that the heat may come to before a new zone is made
constexpr std::uint8_t kFarRing = 100;  // and all behind
// alpha t over spacing^2: the shortest interval of sweeps; the longest part of a step, of which
// there are no more than so many; and where what comes in may all be taken at both ends.
constexpr double kUnit = 0.25;
constexpr double kPart = 1.0;
constexpr int kMostParts = 4;
constexpr double kBrief = 0.15;
constexpr std::array kSimpson = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
constexpr double kRounding = 1e-9;   // s: less is no time
constexpr float kLeastRise = 1e-3f;  // K: less is none

}  // namespace

Conduction::Conduction(const PartHeat& part, int rings)
    : nodes_(part.nodes()),
      rings_(rings),
      material_(part.material()),
      diffusivity_(material_.diffusivity()),
      unit_(kUnit * nodes_.spacing * nodes_.spacing / diffusivity_),
      state_(part.state()),
      power_(nodes_.size(), 0.0),
      ring_(nodes_.size(), kOutside),
      next_ring_(nodes_.size(), kOutside),
      place_(nodes_.size(), 0),
      direct_(nodes_.size(), 0.0f),
      zone_time_(state_.time),
      level_(nodes_.size(), kUnmarked),
      due_(nodes_.size(), kUnmarked),
      fast_(nodes_.size(), 0),
      spans_(nodes_.size(), 0),
      there_(nodes_.size(), 0),
      last_sweep_(state_.time),
      noted_(state_.time) {
    rate_.resize(nodes_.neighbour.size());
    mean_rate_.resize(nodes_.neighbour.size());
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
        const double depth = 1.0 / nodes_.own[k].modes[0];
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e) {
            const double rate = diffusivity_ * nodes_.conductance[e] / nodes_.area[k];
            // Two halves of the way in a row, each with its section.
            const double others = 1.0 / nodes_.own[nodes_.neighbour[e]].modes[0];
            rate_[e] = static_cast<float>(rate);
            mean_rate_[e] = static_cast<float>(rate * 2.0 * others / (depth + others));
        }
        if (state_.warm[k] != 0) level_[k] = level_of(k, state_.time);
    }
}

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
    const double longest = kPart * nodes_.spacing * nodes_.spacing / diffusivity_;
    const int parts =
        static_cast<int>(std::clamp(std::ceil(duration / longest), 1.0, double{kMostParts}));
    for (int part = 0; part < parts; ++part) {
        if (!zone_holds()) make_zone();
        heat(duration / parts);
        // What is outside the zone follows it.
        if (zone_time_ - last_sweep_ >= unit_) {
            sweep(zone_time_, {}, false);
            take_beyond();
        }
    }
    for (const std::uint32_t k : powered_) power_[k] = 0.0;
    powered_.clear();
}

void Conduction::idle(double time) {
    if (time > state_.time + kRounding) state_.time = time;
    hottest_ = 0.0;
}

bool Conduction::zone_holds() const {
    if (zone_.nodes.empty()) return false;
    return std::all_of(powered_.begin(), powered_.end(),
                       [this](std::uint32_t k) { return ring_[k] <= kInnerRings; });
}

// Breadth first from the heat, through the ways and through thin sections.
void Conduction::find_zone(std::vector<std::uint32_t>& beside) {
    std::vector<std::uint32_t> found = powered_;
    for (const std::uint32_t k : powered_) next_ring_[k] = 0;
    std::size_t begin = 0;
    for (int r = 0; r <= rings_; ++r) {
        auto& list = r < rings_ ? found : beside;
        const auto reach = [&](std::uint32_t k) {
            if (k == ThermalNodes::kNone || next_ring_[k] != kOutside) return;
            next_ring_[k] = static_cast<std::uint8_t>(std::min(r + 1, int{kFarRing}));
            list.push_back(k);
        };
        const std::size_t end = found.size();
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t node = found[k];
            reach(nodes_.opposite[node]);
            for (std::uint32_t e = nodes_.first[node]; e < nodes_.first[node + 1]; ++e)
                reach(nodes_.neighbour[e]);
        }
        begin = end;
    }
    for (const std::uint32_t k : beside) next_ring_[k] = kOutside;
}

void Conduction::make_zone() {
    std::vector<std::uint32_t> beside, nodes;
    find_zone(beside);
    for_marked(next_ring_, kFarRing, [&](std::uint32_t k) { nodes.push_back(k); });
    sweep(state_.time, nodes, false);
    leave_zone();
    ring_.swap(next_ring_);
    zone_.nodes.swap(nodes);
    beyond_.swap(beside);
    state_.centre.setZero();
    for (const std::uint32_t k : powered_) state_.centre += nodes_.point[k];
    state_.centre /= static_cast<double>(powered_.size());
    state_.radius = 0.0;
    for (const std::uint32_t k : powered_)
        state_.radius = std::max(state_.radius, (nodes_.point[k] - state_.centre).norm());
    for (const auto* list : {&zone_.nodes, &beyond_}) {
        for (const std::uint32_t k : *list) {
            if (state_.warm[k] == 0) state_.current[k] = state_.conducted[k] = state_.time;
            state_.warm[k] = 1;
            state_.last[k] = state_.time;
        }
    }
    place_zone();
    for (std::size_t i = 0; i < zone_.nodes.size(); ++i) {
        const std::uint32_t k = zone_.nodes[i];
        std::copy_n(&state_.modes[k * kModes], kModes, &zone_rows_[i * kModes]);
        level_[k] = kUnmarked;  // is in no sweep
    }
    zone_time_ = state_.time;
    take_beyond();
}

void Conduction::place_zone() {
    const std::size_t all = zone_.nodes.size() + 2 * beyond_.size();
    zone_rows_.resize(all * kModes);
    zone_.slow.assign(all, 0);
    std::uint32_t place = 0;
    for (const auto* list : {&zone_.nodes, &beyond_})
        for (const std::uint32_t k : *list) place_[k] = place++;
    for (const std::uint32_t k : zone_.nodes)
        if (nodes_.opposite[k] != ThermalNodes::kNone) thin_.push_back(k);
    join_zone();
}

// After its nodes come those beyond, which stay as they are, and then once more, for what flows
// into them.
void Conduction::join_zone() {
    const auto add = [this](std::uint32_t other, double sign, std::uint32_t edge) {
        zone_.ways.push_back({other, static_cast<float>(sign * rate_[edge]),
                              static_cast<float>(sign * mean_rate_[edge])});
        return static_cast<double>(std::max(rate_[edge], mean_rate_[edge]));
    };
    const auto end = [this] {
        zone_.first.push_back(static_cast<std::uint32_t>(zone_.ways.size()));
    };
    end();
    for (const std::uint32_t k : zone_.nodes) {
        double sum = 0.0;
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e)
            sum += add(place_[nodes_.neighbour[e]], 1.0, e);
        zone_.most = std::max(zone_.most, sum);
        end();
    }
    for (std::size_t i = 0; i < beyond_.size(); ++i) end();
    for (const std::uint32_t k : beyond_) {
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e) {
            if (!in_zone(nodes_.neighbour[e])) continue;
            add(place_[nodes_.neighbour[e]], 1.0, e);
            add(place_[k], -1.0, e);
        }
        end();
    }
}

void Conduction::put_beyond_back() {
    const std::size_t inside = zone_.nodes.size(), count = beyond_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t k = beyond_[i];
        const float* row = &zone_rows_[(inside + i) * kModes];
        const float* in = &zone_rows_[(inside + count + i) * kModes];
        for (std::size_t j = 0; j < kModes; ++j) state_.modes[k * kModes + j] = row[j] + in[j];
        state_.current[k] = zone_time_;
    }
}

void Conduction::take_beyond() {
    const std::size_t inside = zone_.nodes.size(), count = beyond_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t k = beyond_[i];
        float* row = &state_.modes[k * kModes];
        const double since = zone_time_ - state_.current[k];
        if (since > 0.0) decay_row(row, factors(since).decay.data());
        state_.current[k] = state_.last[k] = zone_time_;
        std::copy_n(row, kModes, &zone_rows_[(inside + i) * kModes]);
        std::fill_n(&zone_rows_[(inside + count + i) * kModes], kModes, 0.0f);
    }
}

void Conduction::leave_zone() {
    for (std::size_t i = 0; i < zone_.nodes.size(); ++i) {
        const std::uint32_t k = zone_.nodes[i];
        std::copy_n(&zone_rows_[i * kModes], kModes, &state_.modes[k * kModes]);
        state_.current[k] = state_.conducted[k] = state_.last[k] = zone_time_;
        ring_[k] = kOutside;
        level_[k] = 0;
    }
    zone_.clear();
    beyond_.clear();
    thin_.clear();
}

const Conduction::Factors& Conduction::factors(double duration) {
    const auto hash = std::bit_cast<std::uint64_t>(duration) * 0x9E3779B97F4A7C15ULL;
    Factors& known = known_[hash >> 58U];
    if (duration == known.duration) return known;
    known.duration = duration;
    const auto& rates = DepthModes::rates();
    for (std::size_t j = 0; j < kModes; ++j) {
        const double lost = -std::expm1(-rates[j] * diffusivity_ * duration);
        known.decay[j] = static_cast<float>(1.0 - lost);
        known.gain[j] = static_cast<float>(j == 0 ? duration / material_.capacity()
                                                  : lost / (material_.conductivity * rates[j]));
    }
    return known;
}

void Conduction::forget_direct() {
    for (const std::uint32_t k : heated_) direct_[k] = 0.0f;
    heated_.clear();
}

void Conduction::inject(const Row& gain) {
    for (const std::uint32_t k : heated_)
        heat_row(&zone_rows_[place_[k] * kModes], gain.data(), nodes_.own[k].modes.data(), flux(k),
                 nodes_.other[k].modes.data(), flux(nodes_.opposite[k]));
}

float Conduction::flux(std::uint32_t node) const {
    return node == ThermalNodes::kNone ? 0.0f
                                       : static_cast<float>(power_[node] / nodes_.area[node]);
}

void Conduction::heat(double duration) {
    forget_direct();
    heated_ = powered_;
    for (const std::uint32_t k : thin_)
        if (power_[k] == 0.0 && power_[nodes_.opposite[k]] > 0.0) heated_.push_back(k);
    // What comes in is conducted along the surface as if it came at the beginning, in the middle
    // and in the end; in a short time, at beginning and end. Decay and conduction may change
    // places.
    const bool brief = diffusivity_ * duration <= kBrief * nodes_.spacing * nodes_.spacing;
    const std::size_t times = brief ? 2 : 3;
    const std::array<double, 3> shares = brief ? std::array{0.5, 0.5, 0.0} : kSimpson;
    decay_rows(zone_rows_.data(), zone_.slow.size(), factors(duration).decay.data());
    double left = 1.0;
    const double between = duration / static_cast<double>(times - 1);
    for (std::size_t i = 0; i < times; ++i) {
        left -= shares[i];
        Row gain = factors(shares[i] * duration).gain;
        const Row& decay = factors(std::max(left, 0.0) * duration).decay;
        for (std::size_t j = 0; j < kModes; ++j) gain[j] *= decay[j];
        inject(gain);
        if (i + 1 < times)
            conductor_.conduct(zone_, between, nodes_.dispersion / (diffusivity_ * between),
                               zone_rows_);
    }
    zone_sums_.resize(zone_.nodes.size());
    sum_rows(zone_rows_.data(), zone_sums_.size(), zone_sums_.data());
    for (const std::uint32_t k : heated_) {
        direct_[k] =
            (nodes_.own[k].direct * flux(k) + nodes_.other[k].direct * flux(nodes_.opposite[k])) /
            static_cast<float>(material_.conductivity);
        zone_sums_[place_[k]] = sum_of_row(&zone_rows_[place_[k] * kModes]) + direct_[k];
    }
    state_.time += duration;
    state_.heated = zone_time_ = state_.time;
    for (std::size_t i = 0; i < zone_.nodes.size(); ++i) {
        note_peak(zone_.nodes[i], zone_sums_[i]);
        if (zone_sums_[i] > hottest_) {
            hottest_ = zone_sums_[i];
            hottest_node_ = zone_.nodes[i];
        }
    }
}

double Conduction::rise(std::uint32_t node) const {
    const float* row = in_zone(node) ? &zone_rows_[place_[node] * kModes]
                                     : &state_.modes[std::size_t{node} * kModes];
    return sum_of_row(row) + direct_[node];
}

void Conduction::note_peak(std::uint32_t node, float rise) {
    if (rise > std::max(state_.peak[node], kLeastRise)) {
        state_.peak[node] = rise;
        state_.source[node] = state_.motion;
    }
}

}  // namespace beltgrinding

#include <algorithm>
#include <cmath>

#include "heat/conduction.h"
#include "heat/heat_rows.h"
#include "marked.h"

// What is conducted outside the zone.

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
// A sweep's interval: of the time in which what is there changes, so much where heat gets farther
// in it than kShort, alpha t over spacing^2, else more. Where heat is still to come from the
// source, by kShort less.
constexpr double kShare = 0.08, kShortShare = 0.25;
constexpr double kShort = 1.0;
constexpr double kGrow = 0.25;      // of the time since heat came: an interval when none comes
constexpr double kFirstSpan = 2.0;  // of the unit
constexpr double kLonger = 16.0;    // each span than those after it
constexpr int kLevels = 32;
constexpr double kCold = 0.01;    // K: less does not warm the neighbours
constexpr float kNoFast = 1e-5f;  // K: less of each of the faster modes is none
enum : std::uint8_t { kDue = 0, kBeside = 1 };

}  // namespace

/// s, of what is conducted together: the last of a sweep's time, before it longer ones.
double Conduction::span_length(std::size_t span) const {
    if (span + 1 == kSpans) return HUGE_VAL;
    return span == 0 ? kFirstSpan * unit_
                     : span_length(span - 1) * (span == 1 ? kLonger - 1.0 : kLonger);
}

// What was heated changes in the time since; what is not yet, in that of the way to it.
std::uint8_t Conduction::level_of(std::uint32_t node, double now) const {
    const double away =
        std::max((nodes_.point[node] - state_.centre).norm() - state_.radius, nodes_.spacing);
    const double way = now - state_.heated + away * away / (4.0 * diffusivity_);
    const double since = now - state_.last[node];
    const double brief = kShort * nodes_.spacing * nodes_.spacing / diffusivity_;
    const double wanted =
        std::min({kShortShare * since, std::max(kShare * since, brief), kShare * way - brief});
    const int level = wanted > unit_ ? std::ilogb(wanted / unit_) : 0;
    return static_cast<std::uint8_t>(std::min(level, kLevels - 1));
}

void Conduction::find_due(double now, std::span<const std::uint32_t> must, bool everything) {
    const auto add = [this](std::uint32_t k) {
        if (due_[k] == kDue) return;
        due_[k] = kDue;
        touched_.push_back(k);
    };
    for (const std::uint32_t k : beyond_) add(k);
    for (const std::uint32_t k : must)
        if (state_.warm[k] != 0 && !in_zone(k)) add(k);
    // All of a level at the same times: neighbours are due together.
    int highest = everything ? kLevels - 1 : -1;
    for (int level = highest + 1; level < kLevels; ++level) {
        const double interval = std::ldexp(unit_, level);
        if (std::floor(now / interval) == std::floor(last_sweep_ / interval)) break;
        highest = level;
    }
    if (highest >= 0) for_marked(level_, static_cast<std::uint8_t>(highest), add);
    last_sweep_ = now;
}

void Conduction::find_beside(double now) {
    const std::size_t count = touched_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t k = touched_[i];
        const float* row = &state_.modes[k * kModes];
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e) {
            const std::uint32_t other = nodes_.neighbour[e];
            if (due_[other] != kUnmarked || in_zone(other)) continue;
            if (state_.warm[other] == 0) {
                const bool cold = std::all_of(row, row + kModes, [](float t) {
                    return std::abs(t) < static_cast<float>(kCold);
                });
                if (cold) continue;
                // Before, there was nothing to go on from it.
                state_.warm[other] = 1;
                state_.current[other] = now;
                state_.conducted[other] = state_.conducted[k];
                level_[other] = level_of(other, now);
            }
            due_[other] = kBeside;
            touched_.push_back(other);
        }
    }
    touched_.clear();
    for_marked(due_, kBeside, [this](std::uint32_t k) { touched_.push_back(k); });
}

// What is conducted for long begins alone; the others, when it has come to their time, join it. So
// long intervals do not make many stages of short ones.
void Conduction::divide(double now) {
    std::array<double, kSpans> lengths;
    for (std::size_t span = 0; span < kSpans; ++span) lengths[span] = span_length(span);
    for (const std::uint32_t k : touched_) {
        const bool beside = due_[k] == kBeside;
        const double conducted = state_.conducted[k];
        std::array<double, kSpans> sums{};
        std::size_t spans = 0;  // that the node takes part in
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e) {
            const std::uint32_t other = nodes_.neighbour[e];
            if (due_[other] == kUnmarked || (beside && due_[other] == kBeside) || in_zone(other))
                continue;
            double left = now - std::max(conducted, state_.conducted[other]);
            for (std::size_t span = 0; left > 0.0; left -= lengths[span++]) {
                const double length = std::min(left, lengths[span]);
                const auto part = static_cast<float>(length);
                HeatPatch& patch = swept_[span];
                patch.longest = std::max(patch.longest, length);
                for (; spans <= span; ++spans) {
                    swept_[spans].nodes.push_back(k);
                    swept_[spans].first.push_back(
                        static_cast<std::uint32_t>(swept_[spans].ways.size()));
                }
                patch.ways.push_back({other, part * rate_[e], part * mean_rate_[e]});
                sums[span] += part * std::max(rate_[e], mean_rate_[e]);
            }
        }
        for (std::size_t span = 0; span < spans; ++span)
            swept_[span].most = std::max(swept_[span].most, sums[span]);
    }
}

void Conduction::conduct(HeatPatch& patch) {
    const std::size_t count = patch.nodes.size();
    patch.first.push_back(static_cast<std::uint32_t>(patch.ways.size()));
    patch.slow.resize(count);
    rows_.resize(count * kModes);
    for (std::uint32_t i = 0; i < count; ++i) {
        there_[patch.nodes[i]] = i;
        std::copy_n(&state_.modes[patch.nodes[i] * kModes], kModes, &rows_[i * kModes]);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        bool slow = fast_[patch.nodes[i]] == 0;
        for (std::uint32_t e = patch.first[i]; e < patch.first[i + 1]; ++e) {
            std::uint32_t& other = patch.ways[e].other;
            slow = slow && fast_[other] == 0;
            other = there_[other];
        }
        patch.slow[i] = slow ? 1 : 0;
    }
    conductor_.conduct(patch, 1.0, nodes_.dispersion / (diffusivity_ * patch.longest), rows_,
                       sums_);
    for (std::size_t i = 0; i < count; ++i)
        std::copy_n(&rows_[i * kModes], kModes, &state_.modes[patch.nodes[i] * kModes]);
    patch.clear();
}

void Conduction::sweep(double now, std::span<const std::uint32_t> must, bool everything) {
    put_beyond_back();
    find_due(now, must, everything);
    find_beside(now);
    for (const std::uint32_t k : touched_) {
        float* row = &state_.modes[k * kModes];
        const double since = std::max(now - state_.current[k], 0.0);
        fast_[k] = decay_row(row, factors(since).decay.data()) > kNoFast ? 1 : 0;
        state_.current[k] = now;
    }
    divide(now);
    for (std::size_t span = kSpans; span-- > 0;)
        if (!swept_[span].nodes.empty()) conduct(swept_[span]);
    for (const std::uint32_t k : touched_) {
        note_peak(k, sum_of_row(&state_.modes[k * kModes]));
        if (due_[k] == kDue) {
            state_.conducted[k] = now;
            level_[k] = level_of(k, now);
        }
        due_[k] = kUnmarked;
    }
    touched_.clear();
}

void Conduction::catch_up() {
    forget_direct();
    if (!zone_.nodes.empty()) sweep(zone_time_, {}, false);
    leave_zone();
    while (zone_time_ < state_.time) {
        const double step = std::max(unit_, kGrow * (zone_time_ - state_.heated));
        zone_time_ = std::min(state_.time, zone_time_ + step);
        sweep(zone_time_, {}, false);
    }
}

const HeatState& Conduction::settle() {
    if (state_.time > zone_time_) catch_up();
    sweep(state_.time, {}, true);
    leave_zone();
    return state_;
}

}  // namespace beltgrinding

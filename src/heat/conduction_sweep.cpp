#include <algorithm>
#include <bit>
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
constexpr double kShare = 0.1, kShortShare = 0.25;
constexpr double kShort = 1.0;
constexpr double kGrow = 0.25;      // of the time since heat came: an interval when none comes
constexpr double kFirstSpan = 4.0;  // of the unit
constexpr double kLonger = 4.0;     // from a span's end to the next one's
constexpr int kLevels = 32;
constexpr double kCold = 0.01;    // K: less does not warm the neighbours
constexpr float kNoFast = 1e-3f;  // K: less of each of the faster modes is none
enum : std::uint8_t { kDue = 0, kBeside = 1 };

}  // namespace

/// s, from a sweep back, between which is conducted together: the last of its time, before it
/// longer ones.
std::array<double, Conduction::kSpans> Conduction::span_ends() const {
    std::array<double, kSpans> ends;
    double end = kFirstSpan * unit_;
    for (double& one : ends) {
        one = end;
        end *= kLonger;
    }
    ends.back() = HUGE_VAL;
    return ends;
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
    if (wanted <= unit_) return 0;
    // The whole part of its logarithm: the exponent of the number.
    const auto bits = std::bit_cast<std::uint64_t>(wanted / unit_);
    const auto level = static_cast<int>(bits >> 52U) - 1023;
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

template <class Visit>
void Conduction::for_due_ways(std::uint32_t node, double now, Visit visit) const {
    const bool beside = due_[node] == kBeside;
    const double conducted = state_.conducted[node];
    for (std::uint32_t e = nodes_.first[node]; e < nodes_.first[node + 1]; ++e) {
        const std::uint32_t other = nodes_.neighbour[e];
        if (due_[other] == kUnmarked || (beside && due_[other] == kBeside)) continue;
        const double left = now - std::max(conducted, state_.conducted[other]);
        if (left > 0.0) visit(e, left);
    }
}

void Conduction::order(double now) {
    const auto ends = span_ends();
    std::array<std::uint32_t, kSpans + 2> begin{};  // by spans, descending; nodes
    for (const std::uint32_t k : touched_) {
        double longest = 0.0;
        for_due_ways(k, now,
                     [&](std::uint32_t, double left) { longest = std::max(longest, left); });
        std::uint8_t spans = longest > 0.0 ? 1 : 0;
        while (spans > 0 && longest > ends[spans - 1U]) ++spans;
        spans_[k] = spans;
        ++begin[kSpans - spans + 1];
    }
    for (std::size_t n = 0; n <= kSpans; ++n) begin[n + 1] += begin[n];
    ordered_.resize(touched_.size());
    for (const std::uint32_t k : touched_) {
        there_[k] = begin[kSpans - spans_[k]]++;
        ordered_[there_[k]] = k;
    }
}

// What is conducted for long begins alone; the others, when it has come to their time, join it. So
// long intervals do not make many stages of short ones.
void Conduction::divide(double now) {
    const auto ends = span_ends();
    std::array<std::uint32_t, kSpans> count{};  // ways
    std::size_t most = 0;
    for (const std::uint32_t k : ordered_) most += nodes_.first[k + 1] - nodes_.first[k];
    for (std::size_t span = 0; span < kSpans; ++span) {
        HeatPatch& patch = swept_[span];
        patch.first.clear();
        patch.slow.clear();
        patch.most = patch.longest = 0.0;
        if (patch.ways.size() < most) patch.ways.resize(most);
    }
    for (const std::uint32_t k : ordered_) {
        const std::uint8_t spans = spans_[k];
        if (spans == 0) break;
        for (std::size_t span = 0; span < spans; ++span) swept_[span].first.push_back(count[span]);
        std::array<double, kSpans> sums{};
        bool slow = fast_[k] == 0;
        for_due_ways(k, now, [&](std::uint32_t e, double left) {
            const std::uint32_t other = nodes_.neighbour[e], place = there_[other];
            slow = slow && fast_[other] == 0;
            double before = 0.0;
            for (std::size_t span = 0; span == 0 || left > ends[span - 1]; ++span) {
                const double length = std::min(left, ends[span]) - before;
                before = ends[span];
                const auto part = static_cast<float>(length);
                HeatPatch& patch = swept_[span];
                patch.longest = std::max(patch.longest, length);
                patch.ways[count[span]++] = {place, part * rate_[e], part * mean_rate_[e]};
                sums[span] += part * std::max(rate_[e], mean_rate_[e]);
            }
        });
        for (std::size_t span = 0; span < spans; ++span) {
            swept_[span].slow.push_back(slow ? 1 : 0);
            swept_[span].most = std::max(swept_[span].most, sums[span]);
        }
    }
    for (std::size_t span = 0; span < kSpans; ++span) swept_[span].first.push_back(count[span]);
}

void Conduction::sweep(double now, std::span<const std::uint32_t> must, bool everything) {
    put_beyond_back();
    find_due(now, must, everything);
    find_beside(now);
    order(now);
    const std::size_t count = ordered_.size();
    if (rows_.size() < count * kModes) rows_.resize(count * kModes);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t k = ordered_[i];
        float* row = &rows_[i * kModes];
        std::copy_n(&state_.modes[k * kModes], kModes, row);
        const double since = std::max(now - state_.current[k], 0.0);
        fast_[k] = decay_row(row, factors(since).decay.data()) > kNoFast ? 1 : 0;
        state_.current[k] = now;
    }
    divide(now);
    for (std::size_t span = kSpans; span-- > 0;) {
        const HeatPatch& patch = swept_[span];
        if (!patch.slow.empty())
            conductor_.conduct(patch, 1.0, nodes_.dispersion / (diffusivity_ * patch.longest),
                               rows_);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t k = ordered_[i];
        const float* row = &rows_[i * kModes];
        std::copy_n(row, kModes, &state_.modes[k * kModes]);
        note_peak(k, sum_of_row(row));
    }
    for (const std::uint32_t k : touched_) {
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

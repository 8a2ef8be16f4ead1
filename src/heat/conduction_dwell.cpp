#include <algorithm>
#include <cmath>
#include <vector>

#include "heat/conduction.h"
#include "heat/heat_rows.h"

// A step that is so long, or a material that conducts so well, that the heat of its beginning is
// long smooth in its end: as many parts as elsewhere would be thousands.

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
// What came in is looked at again and again: alpha t over spacing^2 at first, then shares of the
// time since.
constexpr double kFirst = 0.5;
constexpr double kGrowing = 0.5;
constexpr double kLast = 1.2;   // longer than the others the last may be
constexpr double kGone = 18.0;  // rate times time: e to the minus that is nothing

/// From 0 to `duration`, ever farther apart.
std::vector<double> times(double duration, double first) {
    std::vector<double> found = {0.0};
    while (found.back() < duration) {
        const double longer = std::max(first, kGrowing * found.back());
        found.push_back(found.back() + kLast * longer < duration ? found.back() + longer
                                                                 : duration);
    }
    return found;
}

/// s: what is left of something that decays with `rate` 1/s, summed up from a time to another.
double stays(double rate, double from, double to) {
    if (rate == 0.0) return to - from;
    if (rate * from > kGone) return 0.0;
    return std::exp(-rate * from) * -std::expm1(-rate * (to - from)) / rate;
}

}  // namespace

// What was there goes on by itself. What comes in, evenly, is the mean over all times since of what
// comes of a pulse at once: by Simpson's rule between ever longer times. A pulse is conducted along
// the surface alone, and goes to coarser levels as it becomes smooth; into the depth the modes'
// decay is known for each time.
void Conduction::dwell(double duration, std::uint32_t motion) {
    state_.time += duration;
    catch_up(true);
    state_.motion = motion;
    std::vector<std::uint32_t> thin;
    for (const std::uint32_t k : powered_) {
        const std::uint32_t other = nodes_.opposite[k];
        if (other == ThermalNodes::kNone) continue;
        // Those that it is the other side of are near that.
        thin.push_back(other);
        for (std::uint32_t e = nodes_.first[other]; e < nodes_.first[other + 1]; ++e)
            thin.push_back(nodes_.neighbour[e]);
    }
    std::sort(thin.begin(), thin.end());
    thin.erase(std::unique(thin.begin(), thin.end()), thin.end());
    thin.erase(std::remove_if(
                   thin.begin(), thin.end(),
                   [this](std::uint32_t k) { return nodes_.opposite[k] == ThermalNodes::kNone; }),
               thin.end());
    find_heated(thin);
    account(duration);
    place_heat();
    state_.heated = state_.time;

    if (!pulse_) pulse_.reset(new Conduction(part_, kRings, true));
    pulse_->begin_pulse(*this, duration);
    const std::vector<double> ends =
        times(duration, kFirst * nodes_.spacing * nodes_.spacing / diffusivity_);
    const double faster = diffusivity_ / (nodes_.longer * nodes_.longer);
    double from = 0.0;  // s: what the pulse stands for, from there
    const auto add_until = [&](double to) {
        Row share;
        for (std::size_t j = 0; j < kModes; ++j)
            share[j] =
                static_cast<float>(stays(faster * DepthModes::rates()[j], from, to) / duration);
        add_pulse(share);
        from = to;
    };
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double sixth = (ends[i + 1] - ends[i]) / 6.0;
        add_until(ends[i] + sixth);
        pulse_->pulse_until(ends[i] + 3.0 * sixth);
        add_until(ends[i + 1] - sixth);
        pulse_->pulse_until(ends[i + 1]);
    }
    add_until(duration);
    pulse_->end_pulse();

    coarse_.move(state_.time, [this](const Vec3& point) { return way(point); });
    coarse_.read_all();
    std::vector<std::uint32_t> nodes;
    layer_.list(nodes);
    for (const std::uint32_t k : nodes) {
        state_.last[k] = std::max(state_.last[k], state_.time - way(nodes_.point[k]));
        changed_[k] = 1;
        note_now(k, static_cast<float>(rise(k)));
    }
    for (const CoarseHeat::Risen& one : coarse_.risen(state_.peak))
        if (!layer_.has(one.node)) note_now(one.node, one.rise);
}

// As if all came at once.
void Conduction::begin_pulse(const Conduction& from, double duration) {
    state_.time = state_.heated = zone_time_ = last_sweep_ = 0.0;
    state_.place = from.state_.place;
    state_.half = from.state_.half;
    coarse_.clear(0.0);
    const auto scale = static_cast<float>(duration / material_.capacity());
    for (const std::uint32_t k : from.heated_) {
        layer_.put(k, 0.0);
        const Row row = from.source(k);
        for (std::size_t j = 0; j < kModes; ++j) layer_.row(k)[j] = scale * row[j];
    }
}

void Conduction::pulse_until(double time) {
    zone_time_ = state_.time = time;
    sweep(true);
}

void Conduction::add_pulse(const Row& share) {
    std::vector<std::uint32_t> nodes;
    pulse_->layer_.list(nodes);
    for (const std::uint32_t k : nodes) {
        layer_.put(k, zone_time_);
        layer_.add(k, pulse_->layer_.row(k), share);
    }
    coarse_.add(pulse_->coarse_, share, zone_time_);
}

void Conduction::end_pulse() {
    std::vector<std::uint32_t> nodes;
    layer_.list(nodes);
    for (const std::uint32_t k : nodes) layer_.remove(k);
    coarse_.clear(0.0);
}

}  // namespace beltgrinding

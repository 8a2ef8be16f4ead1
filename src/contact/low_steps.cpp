// Steps of the surface that are lower than half a cell: two samples beside each other lie at other
// heights than their slopes tell. A mean over both would round the step off, and the pressure at
// its edge would be a tenth of what it is.

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/gap_map.h"

namespace beltgrinding {
namespace {

constexpr double kLowest = 0.1;      // cells: lower steps are averaged
constexpr std::size_t kLooked = 40;  // of the samples on either side of a step, about
constexpr float kBand = 0.5F;        // of the gaps' range: at a step there is as much between them

/// mm by which the stock steps from one sample to the other: either lies on another side of the
/// other's tangent plane. Round a ridge both lie below, in a groove above; where rays lean, at a
/// sharp edge between faces, no plane tells.
double stock_step(const HeightField& field, std::uint32_t a, std::uint32_t b) {
    if (field.leans(a) || field.leans(b)) return 0.0;
    const auto top = [&](std::uint32_t k) -> Vec3 {
        return field.point[k] +
               static_cast<double>(field.stock_height[k]) * field.ray(k).cast<double>();
    };
    const Vec3 way = top(b) - top(a);
    const double above_a = way.dot(field.normal[a].cast<double>());
    const double above_b = -way.dot(field.normal[b].cast<double>());
    return above_a * above_b < 0.0 ? std::min(std::abs(above_a), std::abs(above_b)) : 0.0;
}

}  // namespace

void GapMap::find_steps(const SampleBlocks& blocks) {
    if (run_) return;  // a belt bridges them
    const HeightField& field = blocks.field();
    // By what does not change while it is ground: a run that goes on from a checkpoint sees it too.
    const double lowest = kLowest * std::max(grid_.ds, grid_.dy);
    std::vector<std::uint8_t> may_step(field.size(), 0);
    for (std::size_t k = 0; k < field.size(); ++k)
        may_step[k] = (field.flags[k] & kOnBoundary) != 0 ? 1 : 0;
    for (const Triangle& triangle : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangle[corner], b = triangle[(corner + 1) % 3];
            if (std::abs(field.stock_height[a] - field.stock_height[b]) > lowest)
                may_step[a] = may_step[b] = 1;
        }
    }
    steps_.assign(blocks.count(), 0);
    for (std::size_t k = 0; k < blocks.samples().size(); ++k) {
        if (may_step[blocks.sample(k)] != 0)
            steps_[k / kBlockLanes] |= std::uint64_t{1} << (k % kBlockLanes);
    }
}

double GapMap::step_between(const HeightField& field, std::span<NearStep> samples) const {
    std::sort(samples.begin(), samples.end(),
              [](const NearStep& a, const NearStep& b) { return a.carried < b.carried; });
    std::size_t above = 0;  // the first beyond the widest band
    float band = 0.0F;
    for (std::size_t k = 1; k < samples.size(); ++k) {
        const float between = samples[k].carried - samples[k - 1].carried;
        if (between <= band) continue;
        band = between;
        above = k;
    }
    if (!(band >= kBand * (samples.back().carried - samples.front().carried))) return 0.0;
    // A curved surface has such bands as well, where samples are few: it rises from one sample to
    // the other by what lies between their slopes. And what the wheel has ground itself is a step
    // at its side face only, and no edge.
    double nearest = kNone;
    const NearStep *low = nullptr, *high = nullptr;
    const std::size_t by_below = 1 + above / kLooked;
    const std::size_t by_above = 1 + (samples.size() - above) / kLooked;
    for (std::size_t a = 0; a < above; a += by_below) {
        for (std::size_t b = above; b < samples.size(); b += by_above) {
            const double along = static_cast<double>(samples[b].s - samples[a].s);
            const double across = static_cast<double>(samples[b].y - samples[a].y);
            const double apart = along * along + across * across;
            if (apart >= nearest) continue;
            nearest = apart;
            low = &samples[a];
            high = &samples[b];
        }
    }
    if (low == nullptr) return 0.0;
    const double along = static_cast<double>(high->s - low->s);
    const double across = static_cast<double>(high->y - low->y);
    const double rise = static_cast<double>(high->own - low->own);
    const double by_low =
        static_cast<double>(low->slope_s) * along + static_cast<double>(low->slope_y) * across;
    const double by_high =
        static_cast<double>(high->slope_s) * along + static_cast<double>(high->slope_y) * across;
    const double step =
        std::max({std::min(by_low, by_high) - rise, rise - std::max(by_low, by_high), 0.0});
    return std::min(step, stock_step(field, low->sample, high->sample));
}

bool GapMap::find_low_steps(const SampleBlocks& blocks) {
    layer_ = whole_layer_;
    if (run_) return false;
    const auto cells = static_cast<std::size_t>(grid_.cells());
    const auto nx = static_cast<std::size_t>(grid_.nx);
    const std::size_t above = grid_.ny > 1 ? nx : 0;
    const auto lowest = static_cast<float>(kLowest * std::max(grid_.ds, grid_.dy));
    stepped_.clear();
    const auto mark = [&](std::size_t first) {
        for (const std::size_t cell : {first, first + 1, first + above, first + above + 1})
            if (matters_[cell] != 0 && high_[cell] - low_[cell] > lowest) stepped_[cell] = 1;
    };
    const auto steps = [&](std::size_t position) {
        return (steps_[position / kBlockLanes] >> (position % kBlockLanes) & 1U) != 0;
    };
    for (std::size_t k = 0; k < placed_count_; ++k) {
        const PlacedBlock& placed = placed_[k];
        std::uint64_t lanes = placed.regular & steps_[placed.block];
        if (lanes != 0) stepped_.resize(cells, 0);
        for (; lanes != 0; lanes &= lanes - 1)
            mark(static_cast<std::size_t>(placed.cell[std::countr_zero(lanes)]));
    }
    for (const Footprint& f : footprints_) {
        if (!f.on_grid || f.inside <= 0.0F || !steps(f.position)) continue;
        stepped_.resize(cells, 0);
        mark(static_cast<std::size_t>(f.cell));
    }
    if (std::find(stepped_.begin(), stepped_.end(), 1) == stepped_.end()) return false;
    near_steps_.clear();
    const auto note = [&](std::size_t position, std::size_t first, float gap, float u, float v,
                          float slope_s, float slope_y) {
        if ((stepped_[first] | stepped_[first + 1] | stepped_[first + above] |
             stepped_[first + above + 1]) == 0)
            return;
        const std::size_t line = first / nx;
        const auto column = static_cast<float>(first - line * nx), row = static_cast<float>(line);
        const std::uint32_t sample = blocks.sample(position);
        const float own = gap + u * slope_s + v * slope_y;
        const auto at = [&](std::size_t cell, float carried) {
            if (stepped_[cell] != 0)
                near_steps_.push_back({static_cast<std::uint32_t>(cell), carried, own, sample,
                                       column + u, row + v, slope_s, slope_y});
        };
        at(first, gap);
        at(first + 1, gap + slope_s);
        if (above == 0) return;
        at(first + above, gap + slope_y);
        at(first + above + 1, gap + slope_s + slope_y);
    };
    for (std::size_t k = 0; k < placed_count_; ++k) {
        const PlacedBlock& placed = placed_[k];
        for (std::uint64_t lanes = placed.regular; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            note(std::size_t{placed.block} * kBlockLanes + static_cast<std::size_t>(lane),
                 static_cast<std::size_t>(placed.cell[lane]), placed.gap[lane], placed.u[lane],
                 placed.v[lane], placed.slope_s[lane], placed.slope_y[lane]);
        }
    }
    for (const Footprint& f : footprints_)
        if (f.on_grid && f.inside > 0.0F)
            note(f.position, static_cast<std::size_t>(f.cell), static_cast<float>(f.gap), f.u, f.v,
                 f.slope_s, f.slope_y);
    std::stable_sort(near_steps_.begin(), near_steps_.end(),
                     [](const NearStep& a, const NearStep& b) { return a.cell < b.cell; });
    double least = 2.0 * whole_layer_;
    for (auto first = near_steps_.begin(); first != near_steps_.end();) {
        const auto last = std::find_if(first, near_steps_.end(), [&](const NearStep& sample) {
            return sample.cell != first->cell;
        });
        const double step = step_between(blocks.field(), {first, last});
        if (step >= static_cast<double>(lowest)) least = std::min(least, step);
        first = last;
    }
    layer_ = 0.5 * least;
    return layer_ < whole_layer_;
}

}  // namespace beltgrinding

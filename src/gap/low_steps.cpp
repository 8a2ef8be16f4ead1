#include "gap/low_steps.h"

#include <bit>
#include <cmath>
#include <limits>

namespace beltgrinding {
namespace {

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

double LowSteps::step_between(const HeightField& field, std::span<Near> samples) {
    std::sort(samples.begin(), samples.end(),
              [](const Near& a, const Near& b) { return a.carried < b.carried; });
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
    double nearest = std::numeric_limits<double>::infinity();
    const Near *low = nullptr, *high = nullptr;
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

bool LowSteps::find_cells(const PlacedSamples& placed, const ContactGrid& grid,
                          const EdgeCells& cells, std::span<const float> low,
                          std::span<const float> high) {
    const auto count = static_cast<std::size_t>(grid.cells());
    const auto above = static_cast<std::size_t>(row_step(grid));
    const auto lowest = static_cast<float>(least(grid));
    stepped_.clear();
    const auto mark = [&](std::size_t first) {
        for (const std::size_t cell : {first, first + 1, first + above, first + above + 1})
            if (cells.matters(cell) && high[cell] - low[cell] > lowest) stepped_[cell] = 1;
    };
    const auto steps = [&](std::size_t position) {
        return (placed.form().stepped(static_cast<std::uint32_t>(position / kBlockLanes)) >>
                    (position % kBlockLanes) &
                1U) != 0;
    };
    for (const PlacedBlock& block : placed.regular()) {
        std::uint64_t lanes = block.regular & placed.form().stepped(block.block);
        if (lanes != 0) stepped_.resize(count, 0);
        for (; lanes != 0; lanes &= lanes - 1)
            mark(static_cast<std::size_t>(block.cell[std::countr_zero(lanes)]));
    }
    for (const Footprint& f : placed.footprints()) {
        if (!f.on_grid || f.inside <= 0.0F || !steps(f.position)) continue;
        stepped_.resize(count, 0);
        mark(static_cast<std::size_t>(f.cell));
    }
    return std::find(stepped_.begin(), stepped_.end(), 1) != stepped_.end();
}

void LowSteps::find_samples(const PlacedSamples& placed, const SampleBlocks& blocks,
                            const ContactGrid& grid) {
    const auto nx = static_cast<std::size_t>(grid.nx);
    const auto above = static_cast<std::size_t>(row_step(grid));
    near_.clear();
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
                near_.push_back({static_cast<std::uint32_t>(cell), carried, own, sample, column + u,
                                 row + v, slope_s, slope_y});
        };
        at(first, gap);
        at(first + 1, gap + slope_s);
        if (above == 0) return;
        at(first + above, gap + slope_y);
        at(first + above + 1, gap + slope_s + slope_y);
    };
    for (const PlacedBlock& block : placed.regular()) {
        for (std::uint64_t lanes = block.regular; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            note(std::size_t{block.block} * kBlockLanes + static_cast<std::size_t>(lane),
                 static_cast<std::size_t>(block.cell[lane]), block.gap[lane], block.u[lane],
                 block.v[lane], block.slope_s[lane], block.slope_y[lane]);
        }
    }
    for (const Footprint& f : placed.footprints())
        if (f.on_grid && f.inside > 0.0F)
            note(f.position, static_cast<std::size_t>(f.cell), static_cast<float>(f.gap), f.u, f.v,
                 f.slope_s, f.slope_y);
}

double LowSteps::lowest(const PlacedSamples& placed, const SampleBlocks& blocks,
                        const ContactGrid& grid, const EdgeCells& cells, std::span<const float> low,
                        std::span<const float> high, double most) {
    if (!find_cells(placed, grid, cells, low, high)) return most;
    find_samples(placed, blocks, grid);
    const auto least_step = static_cast<float>(least(grid));
    std::stable_sort(near_.begin(), near_.end(),
                     [](const Near& a, const Near& b) { return a.cell < b.cell; });
    double found = most;
    for (auto first = near_.begin(); first != near_.end();) {
        const auto last = std::find_if(
            first, near_.end(), [&](const Near& sample) { return sample.cell != first->cell; });
        const double step = step_between(blocks.field(), {first, last});
        if (step >= static_cast<double>(least_step)) found = std::min(found, step);
        first = last;
    }
    return found;
}

}  // namespace beltgrinding

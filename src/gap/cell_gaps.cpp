#include "gap/cell_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/fit.h"

namespace beltgrinding {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kFull = 0.999;

double weight_of(const Footprint& f, float share) {
    return static_cast<double>(share) * f.inside * f.area * f.cosine;
}

}  // namespace

void CellGaps::clear(const ContactGrid& grid) {
    const Eigen::Index n = grid.cells();
    fit(gap_, n);
    fit(weight_, n);
    gap_.setZero();
    weight_.setZero();
    coverage_.clear(n);
}

void CellGaps::leave_out(Eigen::Index cell) {
    gap_[cell] = kNone;
    coverage_.share[cell] = 0.0;
}

void CellGaps::map(PlacedSamples& placed, const SampleBlocks& blocks, const ContactGrid& grid,
                   double pressable) {
    placed.begin_layers(grid);
    if (map_smooth(placed, blocks, grid, pressable)) return;
    gap_.setZero();
    weight_.setZero();
    find_range(placed, grid);
    edges_.mark(grid, nearest_, farthest_, layer_, pressable);
    if (edges_.any())
        placed.part(blocks, grid, [&](std::size_t cell) { return !edges_.whole(cell); });
    patches_.cover(placed, blocks, grid, edges_, layer_, nearest_, coverage_);
    average(placed, grid);
    coverage_.merge_slivers(grid);
    share(placed, grid);
    carry_to_middles(placed, grid);
}

void CellGaps::gather(const PlacedSamples& placed, const ContactGrid& grid) {
    const auto cells = static_cast<std::size_t>(grid.cells());
    low_.assign(cells, std::numeric_limits<float>::infinity());
    high_.assign(cells, -std::numeric_limits<float>::infinity());
    inhabited_.assign(cells, 0);
    const int above = row_step(grid);
    four_cells_.resize(cells);
    clear_cells(four_cells_.data(), cells);
    for (const PlacedBlock& block : placed.regular())
        gather_cells(block, above, four_cells_.data(), inhabited_.data());
    spread_cells(four_cells_.data(), cells, above,
                 {gap_.data(), weight_.data(), low_.data(), high_.data()});
    for (const Footprint& f : placed.footprints()) {
        if (!f.on_grid || f.inside <= 0.0f) continue;
        inhabited_[static_cast<std::size_t>(own_cell(grid, f))] = 1;
        for_cells(grid, f, [&](int cell, float share, double carried) {
            const double weight = weight_of(f, share);
            gap_[cell] += weight * carried;
            weight_[cell] += weight;
            const auto k = static_cast<std::size_t>(cell);
            low_[k] = std::min(low_[k], static_cast<float>(carried));
            high_[k] = std::max(high_[k], static_cast<float>(carried));
        });
    }
}

bool CellGaps::smooth(const ContactGrid& grid) const {
    const auto nx = static_cast<std::size_t>(grid.nx);
    const auto cells = static_cast<std::size_t>(grid.cells());
    const auto layer = static_cast<float>(layer_);
    for (std::size_t k = 0; k < cells; ++k) {
        if (high_[k] - low_[k] > layer) return false;
        if (!edges_.matters(k)) continue;
        if (inhabited_[k] == 0) return false;
        const auto steps = [&](std::size_t next) {
            return inhabited_[next] != 0 &&
                   std::max(high_[k], high_[next]) - std::min(low_[k], low_[next]) > layer;
        };
        if (k % nx + 1 < nx && steps(k + 1)) return false;
        if (k + nx < cells && steps(k + nx)) return false;
    }
    return true;
}

bool CellGaps::map_smooth(PlacedSamples& placed, const SampleBlocks& blocks,
                          const ContactGrid& grid, double pressable) {
    gather(placed, grid);
    edges_.find_pressable(grid, low_.data(), pressable);
    layer_ = whole_layer_;
    if (steps_)
        layer_ =
            0.5 * low_steps_.lowest(placed, blocks, grid, edges_, low_, high_, 2.0 * whole_layer_);
    if (layer_ < whole_layer_ || !smooth(grid)) return false;
    const auto cells = static_cast<std::size_t>(grid.cells());
    edges_.clear(cells);
    patches_.clear();
    for (Eigen::Index cell = 0; cell < grid.cells(); ++cell) {
        const bool some = weight_[cell] > 0.0;
        coverage_.share[cell] = some ? 1.0 : 0.0;
        gap_[cell] = some ? gap_[cell] / weight_[cell] : kNone;
    }
    share(placed, grid);
    return true;
}

void CellGaps::find_range(const PlacedSamples& placed, const ContactGrid& grid) {
    nearest_.assign(static_cast<std::size_t>(grid.cells()), kNone);
    farthest_.assign(nearest_.size(), -kNone);
    const int above = row_step(grid);
    for (const PlacedBlock& block : placed.regular())
        range_cells(block, above, nearest_.data(), farthest_.data());
    for (const Footprint& f : placed.footprints()) {
        if (f.inside <= 0.0f || !f.on_grid) continue;
        const bool right = f.u >= 0.5f, up = f.v >= 0.5f;
        const double carried = f.gap + (right ? f.slope_s : 0.0) + (up ? f.slope_y : 0.0);
        const auto own = static_cast<std::size_t>(own_cell(grid, f));
        nearest_[own] = std::min(nearest_[own], carried);
        farthest_[own] = std::max(farthest_[own], carried);
    }
}

void CellGaps::gather_again(const PlacedSamples& placed, const ContactGrid& grid) {
    const int above = row_step(grid);
    gathered_anew_.assign(limit_.size(), 0);
    for (std::size_t first = 0; first < limit_.size(); ++first) {
        FourCells& four = four_cells_[first];
        if (!(four.low[0] <= four.high[0])) continue;
        const std::size_t next = first + static_cast<std::size_t>(above);
        const std::size_t cells[4] = {first, first + 1, next, next + 1};
        for (std::size_t k = 0; k < 4; ++k)
            if (!edges_.whole(cells[k]) || four.high[k] > limit_[cells[k]])
                gathered_anew_[first] = 1;
        if (gathered_anew_[first] != 0) clear_cells(&four, 1);
    }
    for (const PlacedBlock& block : placed.regular())
        average_cells(block, above, gathered_anew_.data(), limit_.data(), four_cells_.data());
}

void CellGaps::fill_between(const ContactGrid& grid) {
    between_.assign(limit_.size(), 0.0);
    patches_.for_cells([&](int cell, double share, double carried) {
        if (weight_[cell] > 0.0 || carried - nearest_[static_cast<std::size_t>(cell)] > layer_)
            return;
        gap_[cell] += share * carried;
        between_[static_cast<std::size_t>(cell)] += share;
    });
    for (int cell = 0; cell < grid.cells(); ++cell)
        if (const double share = between_[static_cast<std::size_t>(cell)]; share > 0.0)
            weight_[cell] = share;
}

void CellGaps::average(const PlacedSamples& placed, const ContactGrid& grid) {
    limit_.resize(nearest_.size());
    for (std::size_t cell = 0; cell < nearest_.size(); ++cell)
        limit_[cell] = static_cast<float>(nearest_[cell] + layer_);
    gather_again(placed, grid);
    spread_cells(four_cells_.data(), limit_.size(), row_step(grid),
                 {gap_.data(), weight_.data(), nullptr, nullptr});
    for (const Footprint& f : placed.footprints()) {
        if (!f.on_grid) continue;
        for_cells(grid, f, [&](int cell, float share, double carried) {
            if (carried - nearest_[static_cast<std::size_t>(cell)] > layer_) return;
            const double weight = weight_of(f, share);
            gap_[cell] += weight * carried;
            weight_[cell] += weight;
        });
    }
    if (sparse_) fill_between(grid);
    for (int cell = 0; cell < grid.cells(); ++cell) {
        double& share = coverage_.share[cell];
        if (edges_.edge(static_cast<std::size_t>(cell)) && share > 0.0) {
            coverage_.along[cell] /= share;
            coverage_.across[cell] /= share;
            if (share > kFull) share = 1.0;
        }
        if (!(weight_[cell] > 0.0)) share = 0.0;
        gap_[cell] = share > 0.0 ? gap_[cell] / weight_[cell] : kNone;
    }
}

void CellGaps::share(PlacedSamples& placed, const ContactGrid& grid) const {
    for (Footprint& f : placed.footprints()) {
        const float w[4] = {(1.0f - f.u) * (1.0f - f.v), f.u * (1.0f - f.v), (1.0f - f.u) * f.v,
                            f.u * f.v};
        std::copy_n(w, 4, f.shares);
    }
    patches_.for_samples(placed.footprints(), [&](Footprint& f) {
        float sum = 0.0f;
        float* share = f.shares;
        for_cells(grid, f, [&](int cell, float weight, double carried) {
            const bool same = f.nearest && std::abs(carried - gap_[cell]) <= layer_;
            *share = same ? weight * static_cast<float>(coverage_.share[cell]) : 0.0f;
            sum += *share++;
        });
        for (float& one : f.shares) one = sum > 0.0f ? one / sum : 0.0f;
    });
}

void CellGaps::carry_to_middles(PlacedSamples& placed, const ContactGrid& grid) {
    // Of the cells near edges, those that are covered in part, or with a sliver.
    const auto parted = [&](int cell) {
        return !edges_.whole(static_cast<std::size_t>(cell)) && coverage_.share[cell] > 0.0 &&
               (coverage_.along[cell] != 0.0 || coverage_.across[cell] != 0.0);
    };
    for (int cell = 0; cell < grid.cells(); ++cell) {
        if (coverage_.share[cell] <= 0.0) gap_[cell] = kNone;
        if (!parted(cell)) continue;
        nearest_[static_cast<std::size_t>(cell)] = gap_[cell];
        gap_[cell] = weight_[cell] = 0.0;
    }
    patches_.for_samples(placed.footprints(), [&](const Footprint& f) {
        for_cells(grid, f, [&](int cell, float share, double carried) {
            if (!parted(cell)) return;
            if (std::abs(carried - nearest_[static_cast<std::size_t>(cell)]) > layer_) return;
            const double weight = weight_of(f, share);
            gap_[cell] += weight * (carried + f.slope_s * coverage_.along[cell] +
                                    f.slope_y * coverage_.across[cell]);
            weight_[cell] += weight;
        });
    });
    for (int cell = 0; cell < grid.cells(); ++cell) {
        if (!parted(cell)) continue;
        gap_[cell] = weight_[cell] > 0.0 ? gap_[cell] / weight_[cell]
                                         : nearest_[static_cast<std::size_t>(cell)];
    }
}

}  // namespace beltgrinding

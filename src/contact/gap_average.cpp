// The gap of the wheel's cells: means over the samples round them.

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/gap_map.h"

namespace beltgrinding {
namespace {

constexpr double kFull = 0.999;

}  // namespace

template <class Visit>
void GapMap::for_cells(const Footprint& f, Visit visit) const {
    const int above = f.cell + (grid_.ny > 1 ? grid_.nx : 0);
    visit(f.cell, (1.0f - f.u) * (1.0f - f.v), f.gap);
    visit(f.cell + 1, f.u * (1.0f - f.v), f.gap + f.slope_s);
    visit(above, (1.0f - f.u) * f.v, f.gap + f.slope_y);
    visit(above + 1, f.u * f.v, f.gap + f.slope_s + f.slope_y);
}

bool GapMap::map_smooth(const SampleBlocks& blocks, double pressable) {
    const auto cells = static_cast<std::size_t>(grid_.cells());
    low_.assign(cells, std::numeric_limits<float>::infinity());
    high_.assign(cells, -std::numeric_limits<float>::infinity());
    inhabited_.assign(cells, 0);
    const int above = grid_.ny > 1 ? grid_.nx : 0;
    four_cells_.resize(cells);
    clear_cells(four_cells_.data(), cells);
    for (std::size_t k = 0; k < placed_count_; ++k)
        gather_cells(placed_[k], above, four_cells_.data(), inhabited_.data());
    spread_cells(four_cells_.data(), cells, above,
                 {gap_.data(), weight_.data(), low_.data(), high_.data()});
    for (const Footprint& f : footprints_) {
        if (!f.on_grid || f.inside <= 0.0f) continue;
        inhabited_[static_cast<std::size_t>(own_cell(f))] = 1;
        for_cells(f, [&](int cell, float share, double carried) {
            const double weight = static_cast<double>(share) * f.inside * f.area * f.cosine;
            gap_[cell] += weight * carried;
            weight_[cell] += weight;
            const auto k = static_cast<std::size_t>(cell);
            low_[k] = std::min(low_[k], static_cast<float>(carried));
            high_[k] = std::max(high_[k], static_cast<float>(carried));
        });
    }
    find_pressable(low_.data(), pressable);
    if (find_low_steps(blocks)) return false;
    const auto nx = static_cast<std::size_t>(grid_.nx);
    const auto layer = static_cast<float>(layer_);
    for (std::size_t k = 0; k < cells; ++k) {
        if (high_[k] - low_[k] > layer) return false;
        if (matters_[k] == 0) continue;
        if (inhabited_[k] == 0) return false;
        const auto steps = [&](std::size_t next) {
            return inhabited_[next] != 0 &&
                   std::max(high_[k], high_[next]) - std::min(low_[k], low_[next]) > layer;
        };
        if (k % nx + 1 < nx && steps(k + 1)) return false;
        if (k + nx < cells && steps(k + nx)) return false;
    }
    kind_.assign(cells, kWhole);
    patches_.clear();
    for (std::size_t k = 0; k < cells; ++k) {
        const auto cell = static_cast<Eigen::Index>(k);
        const bool some = weight_[cell] > 0.0;
        coverage_.share[cell] = some ? 1.0 : 0.0;
        gap_[cell] = some ? gap_[cell] / weight_[cell] : kNone;
    }
    share_cells();
    return true;
}

void GapMap::average_gap() {
    limit_.resize(nearest_.size());
    for (std::size_t cell = 0; cell < nearest_.size(); ++cell)
        limit_[cell] = static_cast<float>(nearest_[cell] + layer_);
    const int above = grid_.ny > 1 ? grid_.nx : 0;
    // What was gathered holds where no sample is too deep, or placed by itself since.
    wider_.assign(limit_.size(), 0);
    for (std::size_t first = 0; first < limit_.size(); ++first) {
        FourCells& four = four_cells_[first];
        if (!(four.low[0] <= four.high[0])) continue;
        const std::size_t next = first + static_cast<std::size_t>(above);
        const std::size_t cells[4] = {first, first + 1, next, next + 1};
        for (std::size_t k = 0; k < 4; ++k)
            if (kind_[cells[k]] != kWhole || four.high[k] > limit_[cells[k]]) wider_[first] = 1;
        if (wider_[first] != 0) clear_cells(&four, 1);
    }
    for (std::size_t k = 0; k < placed_count_; ++k)
        average_cells(placed_[k], above, wider_.data(), limit_.data(), four_cells_.data());
    spread_cells(four_cells_.data(), limit_.size(), above,
                 {gap_.data(), weight_.data(), nullptr, nullptr});
    for (const Footprint& f : footprints_) {
        if (!f.on_grid) continue;
        for_cells(f, [&](int cell, float share, double carried) {
            if (carried - nearest_[static_cast<std::size_t>(cell)] > layer_) return;
            const double weight = static_cast<double>(share) * f.inside * f.area * f.cosine;
            gap_[cell] += weight * carried;
            weight_[cell] += weight;
        });
    }
    for (int cell = 0; cell < grid_.cells(); ++cell) {
        double& share = coverage_.share[cell];
        if (kind_[static_cast<std::size_t>(cell)] == kEdge && share > 0.0) {
            coverage_.along[cell] /= share;
            coverage_.across[cell] /= share;
            if (share > kFull) share = 1.0;
        }
        if (!(weight_[cell] > 0.0)) share = 0.0;
        gap_[cell] = share > 0.0 ? gap_[cell] / weight_[cell] : kNone;
    }
}

void GapMap::share_cells() {
    for (Footprint& f : footprints_) {
        const float w[4] = {(1.0f - f.u) * (1.0f - f.v), f.u * (1.0f - f.v), (1.0f - f.u) * f.v,
                            f.u * f.v};
        std::copy_n(w, 4, f.shares);
    }
    for (const EdgePatch& patch : patches_) {
        Footprint& f = footprints_[patch.footprint];
        float sum = 0.0f;
        float* share = f.shares;
        for_cells(f, [&](int cell, float weight, double carried) {
            const bool same = f.nearest && std::abs(carried - gap_[cell]) <= layer_;
            *share = same ? weight * static_cast<float>(coverage_.share[cell]) : 0.0f;
            sum += *share++;
        });
        for (float& one : f.shares) one = sum > 0.0f ? one / sum : 0.0f;
    }
}

void GapMap::carry_to_middles() {
    // Of the cells near edges, those that are covered in part, or with a sliver.
    const auto parted = [&](int cell) {
        return kind_[static_cast<std::size_t>(cell)] != kWhole && coverage_.share[cell] > 0.0 &&
               (coverage_.along[cell] != 0.0 || coverage_.across[cell] != 0.0);
    };
    for (int cell = 0; cell < grid_.cells(); ++cell) {
        if (coverage_.share[cell] <= 0.0) gap_[cell] = kNone;
        if (!parted(cell)) continue;
        nearest_[static_cast<std::size_t>(cell)] = gap_[cell];
        gap_[cell] = weight_[cell] = 0.0;
    }
    for (const EdgePatch& patch : patches_) {
        const Footprint& f = footprints_[patch.footprint];
        for_cells(f, [&](int cell, float share, double carried) {
            if (!parted(cell)) return;
            if (std::abs(carried - nearest_[static_cast<std::size_t>(cell)]) > layer_) return;
            const double weight = static_cast<double>(share) * f.inside * f.area * f.cosine;
            gap_[cell] += weight * (carried + f.slope_s * coverage_.along[cell] +
                                    f.slope_y * coverage_.across[cell]);
            weight_[cell] += weight;
        });
    }
    for (int cell = 0; cell < grid_.cells(); ++cell) {
        if (!parted(cell)) continue;
        gap_[cell] = weight_[cell] > 0.0 ? gap_[cell] / weight_[cell]
                                         : nearest_[static_cast<std::size_t>(cell)];
    }
}

}  // namespace beltgrinding

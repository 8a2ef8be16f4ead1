#include "gap/edge_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beltgrinding {
namespace {

constexpr double kTouch = 1e-6;  // of a cell: less of a patch is rounding

}  // namespace

void EdgePatches::clear() {
    patches_.clear();
    covered_.clear();
}

void EdgePatches::add_cells(const ContactGrid& grid, const Footprint& f) {
    EdgePatch& patch = patches_.back();
    const float left = patch.s - patch.half_s, right = patch.s + patch.half_s;
    const float low = patch.y - patch.half_y, high = patch.y + patch.half_y;
    const int i0 = f.cell % grid.nx, j0 = f.cell / grid.nx;
    const int first = std::max(0, static_cast<int>(std::floor(left + 0.5f)));
    const int last = std::min(grid.nx - 1, static_cast<int>(std::floor(right + 0.5f)));
    const int bottom = std::max(0, static_cast<int>(std::floor(low + 0.5f)));
    const int top = std::min(grid.ny - 1, static_cast<int>(std::floor(high + 0.5f)));
    for (int j = bottom; j <= top; ++j) {
        const float y0 = std::max(low - j, -0.5f), y1 = std::min(high - j, 0.5f);
        for (int i = first; i <= last; ++i) {
            const float s0 = std::max(left - i, -0.5f), s1 = std::min(right - i, 0.5f);
            const double share = static_cast<double>(s1 - s0) * (y1 - y0);
            if (share < kTouch) continue;
            covered_.push_back({j * grid.nx + i, share, 0.5 * (s0 + s1), 0.5 * (y0 + y1),
                                f.gap + f.slope_s * (i - i0) + f.slope_y * (j - j0)});
        }
    }
    patch.end = covered_.size();
}

void EdgePatches::cover(PlacedSamples& placed, const SampleBlocks& blocks, const ContactGrid& grid,
                        const EdgeCells& edges, double layer, std::vector<double>& nearest,
                        Coverage& coverage) {
    clear();
    for (std::size_t cell = 0; cell < nearest.size(); ++cell) {
        if (edges.edge(cell))
            nearest[cell] = std::numeric_limits<double>::infinity();
        else
            coverage.share[static_cast<Eigen::Index>(cell)] = 1.0;
    }
    const std::span<Footprint> footprints = placed.footprints();
    for (std::size_t k = 0; k < footprints.size(); ++k) {
        const Footprint& f = footprints[k];
        if (!f.on_grid || edges.whole(static_cast<std::size_t>(own_cell(grid, f)))) continue;
        Footprint physical = f;
        physical.slope_s /= static_cast<float>(grid.ds);
        physical.slope_y /= static_cast<float>(grid.dy);
        const Patch patch = placed.patch_of(physical, blocks);
        patches_.push_back({k, 0, static_cast<float>(patch.s / grid.ds + 0.5 * (grid.nx - 1)),
                            static_cast<float>(patch.y / grid.dy + 0.5 * (grid.ny - 1)),
                            static_cast<float>(patch.half_s / grid.ds),
                            static_cast<float>(patch.half_y / grid.dy)});
        add_cells(grid, f);
    }
    for (const PatchCell& part : covered_) {
        const auto c = static_cast<std::size_t>(part.cell);
        if (edges.edge(c)) nearest[c] = std::min(nearest[c], part.carried);
    }
    auto part = covered_.begin();
    for (const EdgePatch& patch : patches_) {
        double of_layer = 0.0, of_others = 0.0;
        for (; part != covered_.begin() + static_cast<std::ptrdiff_t>(patch.end); ++part) {
            const auto c = static_cast<std::size_t>(part->cell);
            const bool same = part->carried - nearest[c] <= layer;
            (same ? of_layer : of_others) += part->share;
            if (!same || !edges.edge(c)) continue;
            coverage.share[part->cell] += part->share;
            coverage.along[part->cell] += part->share * part->along;
            coverage.across[part->cell] += part->share * part->across;
        }
        footprints[patch.footprint].nearest = of_layer >= of_others;
    }
}

}  // namespace beltgrinding

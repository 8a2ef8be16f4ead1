// What of the wheel's cells the surface covers, at its edges and steps.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "contact/gap_map.h"

namespace beltgrinding {
namespace {

constexpr double kTouch = 1e-6;     // of a cell: less of a patch is rounding
constexpr double kGraded = 0.001;   // of the samples away from borders: fewer small ones are chance
constexpr double kDenser = 0.6;     // of the field's spacing: where curvature asks for more samples
constexpr double kStraight = 1e-6;  // less: a spike, which has no way along
constexpr int kEdgeMatters = 2;     // cells from what may bear pressure

}  // namespace

void GapMap::find_borders(const HeightField& field) {
    borders_.clear();
    find_forms(field);
    for (std::uint32_t k = 0; k < field.size(); ++k)
        if ((field.flags[k] & kOnBoundary) != 0) borders_.push_back({k, Vec3f::Zero(), 0.0f});
    if (borders_.empty()) return;
    std::vector<double> areas(borders_.size(), 0.0);
    const auto number = [&](std::uint32_t sample) {
        const auto by_sample = [](const BorderPatch& a, std::uint32_t k) { return a.sample < k; };
        return static_cast<std::size_t>(
            std::lower_bound(borders_.begin(), borders_.end(), sample, by_sample) -
            borders_.begin());
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ways;  // between samples on a border
    for (const Triangle& triangle : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangle[corner];
            if ((field.flags[a] & kOnBoundary) == 0) continue;
            // Of a triangle, what is nearest to a corner has its middle 7/36 of both sides away.
            const Vec3 one = field.point[triangle[(corner + 1) % 3]] - field.point[a];
            const Vec3 other = field.point[triangle[(corner + 2) % 3]] - field.point[a];
            const double area = one.cross(other).norm();
            const std::size_t k = number(a);
            borders_[k].middle += (7.0 / 36.0 * area * (one + other)).cast<float>();
            areas[k] += area;
            const std::uint32_t next = triangle[(corner + 1) % 3];
            if ((field.flags[next] & kOnBoundary) != 0) ways.emplace_back(a, next);
        }
    }
    // Along the border the middle has no business: there it is as the triangles happen to lie.
    std::sort(ways.begin(), ways.end());
    std::vector<Vec3> along(borders_.size(), Vec3::Zero());
    std::vector<int> neighbours(borders_.size(), 0);
    for (const auto& [from, to] : ways) {
        if (std::binary_search(ways.begin(), ways.end(), std::pair(to, from))) continue;
        const Vec3 way = field.point[to] - field.point[from];
        const double length = way.norm();
        if (!(length > 0.0)) continue;
        for (const std::uint32_t one : {from, to}) {
            const std::size_t k = number(one);
            along[k] += way / length;
            borders_[k].along += static_cast<float>(length);
            ++neighbours[k];
        }
    }
    for (std::size_t k = 0; k < borders_.size(); ++k) {
        const double apart = neighbours[k] > 0 ? borders_[k].along / neighbours[k] : 0.0;
        borders_[k].along = apart < kDenser * field.spacing ? static_cast<float>(apart) : 0.0f;
        if (areas[k] <= 0.0) continue;
        Vec3 middle = borders_[k].middle.cast<double>() / areas[k];
        const double square = along[k].squaredNorm();
        if (square > kStraight) middle -= along[k].dot(middle) / square * along[k];
        borders_[k].middle = middle.cast<float>();
    }
}

void GapMap::find_forms(const HeightField& field) {
    longer_.clear();
    std::vector<char> beside(field.size(), 0);
    for (const Triangle& t : field.triangles)
        if (((field.flags[t[0]] | field.flags[t[1]] | field.flags[t[2]]) & kOnBoundary) != 0)
            for (const std::uint32_t k : t) beside[k] = 1;
    const double small = kDenser * field.spacing * field.spacing;
    std::size_t denser = 0;
    for (std::size_t k = 0; k < field.size(); ++k)
        if (beside[k] == 0 && field.area[k] < small) ++denser;
    if (static_cast<double>(denser) < kGraded * static_cast<double>(field.size())) return;
    std::vector<Eigen::Matrix3f> ways(field.size(), Eigen::Matrix3f::Zero());
    for (const Triangle& t : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = t[corner], b = t[(corner + 1) % 3];
            const Vec3f way = (field.point[b] - field.point[a]).cast<float>();
            const Eigen::Matrix3f square = way * way.transpose();
            ways[a] += square;
            ways[b] += square;
        }
    }
    longer_.resize(field.size());
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    for (std::size_t k = 0; k < field.size(); ++k) {
        solver.computeDirect(ways[k]);
        const float most = solver.eigenvalues()[2], less = solver.eigenvalues()[1];
        longer_[k] = less > 0.0f ? Vec3f(std::sqrt(most / less) * solver.eigenvectors().col(2))
                                 : Vec3f::Zero();
    }
}

const GapMap::BorderPatch* GapMap::border_patch(std::uint32_t sample) const {
    const auto found =
        std::lower_bound(borders_.begin(), borders_.end(), sample,
                         [](const BorderPatch& a, std::uint32_t k) { return a.sample < k; });
    return found != borders_.end() && found->sample == sample ? &*found : nullptr;
}

GapMap::Patch GapMap::patch_of(const Footprint& f, const SampleBlocks& blocks) const {
    const double y = std::clamp<double>(f.y, -0.5 * wheel_.width, 0.5 * wheel_.width);
    // Lengths round the wheel are told at its radius.
    const double round = wheel_.radius / (f.own_gap + wheel_.radius - wheel_.drop(y));
    const double slope_s = f.slope_s * round, slope_y = f.slope_y - wheel_.drop_slope(y);
    const double side = std::sqrt(static_cast<double>(f.area));
    Patch patch{f.s, f.y, 0.5 * side, 0.5 * side};
    const auto& block = blocks.block(static_cast<std::uint32_t>(f.position / kBlockLanes));
    const bool on_border = (block.border >> (f.position % kBlockLanes) & 1U) != 0;
    if (const BorderPatch* border = on_border ? border_patch(f.sample) : nullptr) {
        const Vec3 middle = contact_from_work_.linear() * border->middle.cast<double>();
        const double angle = f.s / wheel_.radius;
        const double to_s = middle.x() * std::cos(angle) - middle.z() * std::sin(angle);
        const double to_y = middle.y(), square = to_s * to_s + to_y * to_y;
        if (square > 0.0) {
            // As long as the samples are apart along the border, narrower across it.
            const double narrow = border->along > 0.0f
                                      ? side / border->along
                                      : std::min(side / blocks.field().spacing, 1.0);
            const double aspect = std::pow(narrow, (to_y * to_y - to_s * to_s) / square);
            patch.half_s /= aspect;
            patch.half_y *= aspect;
        }
        patch.s += round * to_s;
        patch.y += to_y;
    } else if (!longer_.empty() && !longer_[f.sample].isZero()) {
        const Vec3 longer = contact_from_work_.linear() * longer_[f.sample].cast<double>();
        const double angle = f.s / wheel_.radius;
        const double to_s = longer.x() * std::cos(angle) - longer.z() * std::sin(angle);
        const double to_y = longer.y(), square = to_s * to_s + to_y * to_y;
        if (square > 0.0) {
            const double aspect =
                std::pow(longer.norm(), 0.5 * (to_y * to_y - to_s * to_s) / square);
            patch.half_s /= aspect;
            patch.half_y *= aspect;
        }
    }
    patch.half_s *= round / std::sqrt(1.0 + slope_s * slope_s);
    patch.half_y /= std::sqrt(1.0 + slope_y * slope_y);
    return patch;
}

int GapMap::own_cell(const Footprint& f) const {
    const int right = f.u >= 0.5f ? 1 : 0, up = f.v >= 0.5f ? grid_.nx : 0;
    return f.cell + right + up;
}

template <class Visit>
void GapMap::for_patch(const EdgePatch& patch, Visit visit) const {
    const Footprint& f = footprints_[patch.footprint];
    const float left = patch.s - patch.half_s, right = patch.s + patch.half_s;
    const float low = patch.y - patch.half_y, high = patch.y + patch.half_y;
    const int i0 = f.cell % grid_.nx, j0 = f.cell / grid_.nx;
    const int first = std::max(0, static_cast<int>(std::floor(left + 0.5f)));
    const int last = std::min(grid_.nx - 1, static_cast<int>(std::floor(right + 0.5f)));
    const int bottom = std::max(0, static_cast<int>(std::floor(low + 0.5f)));
    const int top = std::min(grid_.ny - 1, static_cast<int>(std::floor(high + 0.5f)));
    for (int j = bottom; j <= top; ++j) {
        const float y0 = std::max(low - j, -0.5f), y1 = std::min(high - j, 0.5f);
        for (int i = first; i <= last; ++i) {
            const float s0 = std::max(left - i, -0.5f), s1 = std::min(right - i, 0.5f);
            const double share = static_cast<double>(s1 - s0) * (y1 - y0);
            if (share < kTouch) continue;
            visit(PatchCell{j * grid_.nx + i, share, 0.5 * (s0 + s1), 0.5 * (y0 + y1),
                            f.gap + f.slope_s * (i - i0) + f.slope_y * (j - j0)});
        }
    }
}

template <class Nearest>
void GapMap::find_pressable(const Nearest* nearest, double pressable) {
    const int nx = grid_.nx, ny = grid_.ny;
    const auto cells = static_cast<std::size_t>(grid_.cells());
    pressable_.clear();
    matters_.assign(cells, 1);
    if (!(pressable < kNone)) return;
    pressable_.resize(cells);
    for (std::size_t k = 0; k < cells; ++k) pressable_[k] = nearest[k] <= pressable ? 1 : 0;
    // Along, then across.
    wider_.assign(cells, 0);
    for (int j = 0; j < ny; ++j) {
        const std::uint8_t* from = &pressable_[static_cast<std::size_t>(j * nx)];
        std::uint8_t* to = &wider_[static_cast<std::size_t>(j * nx)];
        for (int by = -kEdgeMatters; by <= kEdgeMatters; ++by)
            for (int i = std::max(0, -by); i < std::min(nx, nx - by); ++i) to[i] |= from[i + by];
    }
    std::fill(matters_.begin(), matters_.end(), std::uint8_t{0});
    for (int j = 0; j < ny; ++j) {
        std::uint8_t* to = &matters_[static_cast<std::size_t>(j * nx)];
        for (int b = std::max(0, j - kEdgeMatters); b <= std::min(ny - 1, j + kEdgeMatters); ++b) {
            const std::uint8_t* from = &wider_[static_cast<std::size_t>(b * nx)];
            for (int i = 0; i < nx; ++i) to[i] |= from[i];
        }
    }
}

template void GapMap::find_pressable(const float*, double);
template void GapMap::find_pressable(const double*, double);

void GapMap::mark_edges(double pressable) {
    const int nx = grid_.nx, ny = grid_.ny;
    kind_.assign(nearest_.size(), kWhole);
    find_pressable(nearest_.data(), pressable);
    // Marks the cells round those that `is` tells, up to `steps` away.
    const auto spread = [&](auto is, std::uint8_t kind, int steps) {
        wider_ = kind_;
        for (int cell = 0; cell < nx * ny; ++cell) {
            if (!is(cell)) continue;
            const int i = cell % nx, j = cell / nx;
            for (int b = std::max(0, j - steps); b <= std::min(ny - 1, j + steps); ++b)
                for (int a = std::max(0, i - steps); a <= std::min(nx - 1, i + steps); ++a)
                    wider_[static_cast<std::size_t>(b * nx + a)] =
                        std::max(wider_[static_cast<std::size_t>(b * nx + a)], kind);
        }
        kind_ = wider_;
    };
    bool any = false;
    spread(
        [&](int cell) {
            const auto k = static_cast<std::size_t>(cell);
            const double nearest = nearest_[k];
            // A step between this cell's layer and the next one's.
            const auto steps = [&](std::size_t next) {
                return nearest_[next] != kNone && std::abs(nearest_[next] - nearest) > layer_;
            };
            const bool edge = nearest == kNone || farthest_[k] - nearest > layer_ ||
                              (cell % nx + 1 < nx && steps(k + 1)) ||
                              (cell + nx < nx * ny && steps(k + static_cast<std::size_t>(nx)));
            if (!edge || matters_[k] == 0) return false;
            any = true;
            return true;
        },
        kEdge, 1);
    if (!any) return;
    spread([&](int cell) { return kind_[static_cast<std::size_t>(cell)] == kEdge; }, kNearEdge, 2);
}

void GapMap::part_edges(const SampleBlocks& blocks) {
    if (std::find(kind_.begin(), kind_.end(), kEdge) == kind_.end()) return;
    const auto nx = static_cast<std::size_t>(grid_.nx);
    for (std::size_t k = 0; k < placed_count_; ++k) {
        PlacedBlock& placed = placed_[k];
        for (std::uint64_t lanes = placed.regular; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            const std::size_t own = static_cast<std::size_t>(placed.cell[lane]) +
                                    (placed.u[lane] >= 0.5f ? 1 : 0) +
                                    (placed.v[lane] >= 0.5f ? nx : 0);
            if (kind_[own] == kWhole) continue;
            placed.regular &= ~(std::uint64_t{1} << lane);
            footprints_.push_back(footprint_at(blocks, placed, lane));
        }
    }
}

void GapMap::cover(const SampleBlocks& blocks) {
    patches_.clear();
    covered_.clear();
    for (std::size_t cell = 0; cell < kind_.size(); ++cell) {
        if (kind_[cell] == kEdge)
            nearest_[cell] = kNone;
        else
            coverage_.share[static_cast<Eigen::Index>(cell)] = 1.0;
    }
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        const Footprint& f = footprints_[k];
        if (!f.on_grid || kind_[static_cast<std::size_t>(own_cell(f))] == kWhole) continue;
        Footprint physical = f;
        physical.slope_s /= static_cast<float>(grid_.ds);
        physical.slope_y /= static_cast<float>(grid_.dy);
        const Patch patch = patch_of(physical, blocks);
        patches_.push_back({k, 0, static_cast<float>(patch.s / grid_.ds + 0.5 * (grid_.nx - 1)),
                            static_cast<float>(patch.y / grid_.dy + 0.5 * (grid_.ny - 1)),
                            static_cast<float>(patch.half_s / grid_.ds),
                            static_cast<float>(patch.half_y / grid_.dy)});
        for_patch(patches_.back(), [&](const PatchCell& part) {
            covered_.push_back(part);
            const auto c = static_cast<std::size_t>(part.cell);
            if (kind_[c] == kEdge) nearest_[c] = std::min(nearest_[c], part.carried);
        });
        patches_.back().end = covered_.size();
    }
    auto part = covered_.begin();
    for (const EdgePatch& patch : patches_) {
        double of_layer = 0.0, of_others = 0.0;
        for (; part != covered_.begin() + static_cast<std::ptrdiff_t>(patch.end); ++part) {
            const auto c = static_cast<std::size_t>(part->cell);
            const bool same = part->carried - nearest_[c] <= layer_;
            (same ? of_layer : of_others) += part->share;
            if (!same || kind_[c] != kEdge) continue;
            coverage_.share[part->cell] += part->share;
            coverage_.along[part->cell] += part->share * part->along;
            coverage_.across[part->cell] += part->share * part->across;
        }
        footprints_[patch.footprint].nearest = of_layer >= of_others;
    }
}

}  // namespace beltgrinding

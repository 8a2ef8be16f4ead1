// What the wheel takes from the samples.

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/gap_map.h"

namespace beltgrinding {
namespace {

// Samples stand for about as much area as the cells that they share; where a gouge's walls leave
// far less, no volume is squeezed out of what is left.
constexpr double kLargestScale = 1.5;
constexpr double kOnEnvelope = 1e-5;  // mm: a sample as near to the wheel's envelope lies on it
constexpr int kMaxSecants = 20;

}  // namespace

double GapMap::at(const Footprint& f, const Eigen::ArrayXd& values) const {
    const int above = f.cell + (grid_.ny > 1 ? grid_.nx : 0);
    return f.shares[0] * values[f.cell] + f.shares[1] * values[f.cell + 1] +
           f.shares[2] * values[above] + f.shares[3] * values[above + 1];
}

void GapMap::tabulate(const Eigen::ArrayXd& values, double factor) const {
    const auto cells = static_cast<std::size_t>(grid_.cells());
    const int above = grid_.ny > 1 ? grid_.nx : 0;
    table_.resize(cells);
    for (int cell = 0; cell + above + 1 < grid_.cells(); ++cell) {
        const double a = factor * values[cell], b = factor * values[cell + 1];
        const double c = factor * values[cell + above], d = factor * values[cell + above + 1];
        table_[static_cast<std::size_t>(cell)] = {static_cast<float>(a), static_cast<float>(b - a),
                                                  static_cast<float>(c - a),
                                                  static_cast<float>((a - b) + (d - c))};
    }
}

double GapMap::down_to_envelope(const SampleBlocks& blocks, const Footprint& f, double approach,
                                double wanted) const {
    const HeightField& field = blocks.field();
    // By the slopes at most, and by the curvature of the radius seen from z.
    const double overlap = approach * f.facing - f.own_gap;
    const double bent = approach * approach / wheel_.radius;
    const double way = field.leans(f.sample) ? wanted * field.rays[f.sample].norm() : wanted;
    if (overlap - bent >= (1.0 + steepest_flank_) * way) return wanted;
    const Vec3 ray = contact_from_work_.linear() * field.ray(f.sample).cast<double>();
    const Vec3 top = contact_from_work_ * blocks.top(f.position);
    const auto gap = [&](double lowering) {
        const Vec3 at = top - lowering * ray;
        const double y = std::clamp(at.y(), -0.5 * wheel_.width, 0.5 * wheel_.width);
        return std::hypot(at.x(), at.z() - approach + wheel_.radius) -
               (wheel_.radius - wheel_.drop(y));
    };
    double at_low = gap(0.0);
    if (at_low >= 0.0) return 0.0;
    double at_high = gap(wanted);
    if (at_high <= kOnEnvelope) return wanted;
    // Regula falsi. The radius is convex in the lowering, so that it comes from within.
    double low = 0.0, high = wanted;
    for (int k = 0; k < kMaxSecants && at_low < -kOnEnvelope; ++k) {
        const double between = low + (high - low) * at_low / (at_low - at_high);
        const double found = gap(between);
        (found <= 0.0 ? low : high) = between;
        (found <= 0.0 ? at_low : at_high) = found;
    }
    return low;
}

GapMap::Footprint GapMap::footprint_at(const SampleBlocks& blocks, const PlacedBlock& placed,
                                       int lane) const {
    Footprint f = footprint_of(blocks, placed, lane);
    const Eigen::Vector2d at = place_of(placed, static_cast<std::uint32_t>(lane));
    f.gap = placed.gap[lane];
    f.cell = placed.cell[lane];
    f.s = static_cast<float>(at.x());
    // Beyond the outermost cells' centres, weights do not tell how far.
    f.y = static_cast<float>((contact_from_work_ * blocks.top_in_block(f.position)).y());
    f.slope_s = placed.slope_s[lane];
    f.slope_y = placed.slope_y[lane];
    f.u = placed.u[lane];
    f.v = placed.v[lane];
    f.inside = f.taken = 1.0F;
    f.on_grid = f.nearest = true;
    return f;
}

GapMap::Footprint GapMap::footprint_of(const SampleBlocks& blocks, const PlacedBlock& placed,
                                       int lane) {
    Footprint f{};
    f.position = std::size_t{placed.block} * kBlockLanes + static_cast<std::size_t>(lane);
    f.sample = blocks.sample(f.position);
    f.own_gap = placed.own_gap[lane];
    f.facing = placed.facing[lane];
    f.area = blocks.block(placed.block).area[static_cast<std::size_t>(lane)];
    f.cosine = f.area > 0.0f ? placed.weight[lane] / f.area : 1.0f;
    return f;
}

double GapMap::remove(SampleBlocks& blocks, const Eigen::ArrayXd& rate,
                      const Eigen::ArrayXd& beside, double duration, double approach) {
    const double volume = volume_rate(rate, beside) * duration;
    if (!(volume > 0.0)) return 0.0;
    tabulate(rate, duration);
    lowering_.resize(placed_count_ * kBlockLanes);
    active_.assign(placed_count_, 0);
    has_taken_.assign(placed_count_, 0);
    const auto area_of = [&](std::size_t k) { return blocks.block(placed_[k].block).area.data(); };
    std::vector<double>& volumes = volumes_;  // mm3, by placed block
    volumes.assign(placed_count_, 0.0);
    double unscaled = 0.0;
    for (std::size_t k = 0; k < placed_count_; ++k) {
        float* lowering = &lowering_[k * kBlockLanes];
        if (!interpolate(placed_[k], table_.data(), 0.0f, lowering)) continue;
        active_[k] = 1;
        volumes[k] = volume_of(lowering, area_of(k));
        unscaled += volumes[k];
    }
    sum_rates(rate, beside, asked_);
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        asked_[k] *= duration;
        unscaled += asked_[k] * footprints_[k].area;
    }
    if (!(unscaled > 0.0)) return 0.0;
    const double scale = scale_ = std::min(volume / unscaled, kLargestScale);
    double kept = 0.0, free = 0.0;  // mm3, of the samples on the envelope, of the others
    bool held = false;
    limited_.clear();
    free_.assign(placed_count_, 0);
    const double bent = approach * approach / wheel_.radius;
    // Room enough for what the others keep back as well.
    const double room = (1.0 + steepest_flank_) * kLargestScale;
    for (std::size_t k = 0; k < placed_count_; ++k) {
        if (active_[k] == 0) continue;
        const PlacedBlock& placed = placed_[k];
        const float* lowering = &lowering_[k * kBlockLanes];
        const float* area = area_of(k);
        const Standing standing = stand_off(placed, lowering, static_cast<float>(approach),
                                            static_cast<float>(bent), static_cast<float>(room));
        free_[k] = standing.free;
        held = held || standing.onto != 0;
        double of_free = volumes[k];
        for (std::uint64_t lanes = standing.onto | standing.unsure; lanes != 0;
             lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            const double asked = lowering[lane];
            of_free -= asked * area[lane];
            if ((standing.onto >> lane & 1U) != 0) continue;
            const Footprint f = footprint_of(blocks, placed, lane);
            const double down = down_to_envelope(blocks, f, approach, kLargestScale * asked);
            limited_.emplace_back(k * kBlockLanes + static_cast<std::size_t>(lane), down);
            const bool holds = down < scale * asked;
            held = held || holds;
            (holds ? kept : free) += std::min(down, scale * asked) * area[lane];
        }
        free += scale * std::max(of_free, 0.0);
    }
    room_.assign(footprints_.size(), 0.0);
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        if (asked_[k] <= 0.0) continue;
        const Footprint& f = footprints_[k];
        room_[k] = down_to_envelope(blocks, f, approach, kLargestScale * asked_[k]);
        const double most = std::min(room_[k], scale * asked_[k]);
        const bool holds = most < scale * asked_[k];
        held = held || holds;
        (holds ? kept : free) += most * f.area;
    }
    const double wanted = scale * unscaled;
    double more = 1.0;
    if (held && free > 0.0) more = std::clamp((wanted - kept) / free, 1.0, kLargestScale / scale);
    if (held) {
        taken_.resize(placed_count_ * kBlockLanes);
        for (std::size_t k = 0; k < placed_count_; ++k) {
            if (active_[k] == 0) continue;
            has_taken_[k] = 1;
            for (std::size_t lane = 0; lane < kBlockLanes; ++lane)
                taken_[k * kBlockLanes + lane] =
                    (free_[k] >> lane & 1U) != 0 ? static_cast<float>(more) : 0.0f;
        }
    }
    double removed = lower_regular(blocks, more * scale);
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        if (asked_[k] <= 0.0) continue;
        const double lowering = std::min(room_[k], more * scale * asked_[k]);
        if (held) footprints_[k].taken = static_cast<float>(lowering / (scale * asked_[k]));
        if (lowering <= 0.0) continue;
        blocks.lower(footprints_[k].position, lowering);
        removed += lowering * footprints_[k].area;
    }
    return held ? removed : wanted;
}

double GapMap::lower_regular(SampleBlocks& blocks, double factor) {
    double removed = 0.0;
    for (std::size_t k = 0; k < placed_count_; ++k) {
        if (free_[k] == 0) continue;
        SampleBlocks::Block& block = blocks.block_to_lower(placed_[k].block);
        const Lowered lowered = lower_block(block.height.data(), &lowering_[k * kBlockLanes],
                                            block.area.data(), factor, free_[k]);
        blocks.lowered(placed_[k].block, free_[k], lowered.lowest, lowered.highest);
        removed += lowered.volume;
    }
    for (const auto& [index, room] : limited_) {
        const double asked = lowering_[index];
        const double lowering = std::min(room, factor * asked);
        if (has_taken_[index / kBlockLanes] != 0)
            taken_[index] = static_cast<float>(lowering / (scale_ * asked));
        if (lowering <= 0.0) continue;
        const std::uint32_t number = placed_[index / kBlockLanes].block;
        blocks.lower(std::size_t{number} * kBlockLanes + index % kBlockLanes, lowering);
        removed += lowering * blocks.block(number).area[index % kBlockLanes];
    }
    return removed;
}

double GapMap::cut(SampleBlocks& blocks) const {
    const HeightField& field = blocks.field();
    double volume = 0.0;
    const auto cut_one = [&](const Footprint& f) {
        double cosine = f.cosine;
        if (field.leans(f.sample)) {
            const Vec3 ray = contact_from_work_.linear() * field.rays[f.sample].cast<double>();
            const double angle = f.s / wheel_.radius;
            cosine = -(ray.x() * std::sin(angle) + ray.z() * std::cos(angle));
            cosine = std::max<double>(cosine, kSteepest);
        }
        const double lowering = down_to_envelope(blocks, f, 0.0, -f.own_gap / cosine);
        if (lowering <= 0.0) return;
        blocks.lower(f.position, lowering);
        volume += lowering * f.area;
    };
    for (std::size_t k = 0; k < placed_count_; ++k) {
        const PlacedBlock& placed = placed_[k];
        for (std::uint64_t lanes = placed.regular; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            if (!(placed.own_gap[lane] < 0.0f)) continue;
            cut_one(footprint_of(blocks, placed, lane));
        }
    }
    for (const Footprint& f : footprints_) {
        if (f.own_gap >= 0.0f || f.inside < 0.5) continue;  // its middle lies beside the wheel
        cut_one(f);
    }
    return volume;
}

void GapMap::sum_rates(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside,
                       std::vector<double>& sums) const {
    sums.assign(footprints_.size(), 0.0);
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        const Footprint& f = footprints_[k];
        if (f.nearest) sums[k] = f.inside * at(f, rate);
    }
    if (reach_.size() == 0 || beside.size() != reach_.size()) return;
    for (const BesidePatch& patch : beside_patches_) {
        if (patch.share > 0.0) sums[patch.footprint] += patch.share * beside_at(patch, beside);
    }
}

void GapMap::raise(const DisplacedPressure& pressure, std::span<float> largest) const {
    tabulate(pressure.pressure, 1.0);
    for (std::size_t k = 0; k < placed_count_; ++k) {
        const std::size_t first = std::size_t{placed_[k].block} * kBlockLanes;
        raise_to(placed_[k], table_.data(), &largest[first]);
    }
    const auto to = [&](const Footprint& f, double value) {
        largest[f.position] = std::max(largest[f.position], static_cast<float>(value));
    };
    for (const Footprint& f : footprints_) {
        if (f.nearest && f.inside > 0.0f) to(f, at(f, pressure.pressure));
    }
    for (const BesidePatch& patch : beside_patches_) {
        if (patch.share > 0.0) to(footprints_[patch.footprint], beside_at(patch, pressure.beside));
    }
}

Eigen::Vector2d GapMap::place_of(const PlacedBlock& placed, std::uint32_t lane) const {
    const int cell = placed.cell[lane];
    const int i = cell % grid_.nx, j = cell / grid_.nx;
    return {grid_.s(i) + static_cast<double>(placed.u[lane]) * grid_.ds,
            grid_.y(j) + static_cast<double>(placed.v[lane]) * grid_.dy};
}

std::optional<std::size_t> GapMap::sample_near(double s, double y) const {
    std::optional<std::size_t> found;
    double least = kNone;
    const auto look = [&](std::size_t position, double at_s, double at_y) {
        const double away = (at_s - s) * (at_s - s) + (at_y - y) * (at_y - y);
        if (away >= least) return;
        least = away;
        found = position;
    };
    for (std::size_t k = 0; k < placed_count_; ++k) {
        const PlacedBlock& placed = placed_[k];
        for (std::uint64_t lanes = placed.regular; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const Eigen::Vector2d at = place_of(placed, lane);
            look(std::size_t{placed.block} * kBlockLanes + lane, at.x(), at.y());
        }
    }
    for (const Footprint& f : footprints_)
        if (f.nearest) look(f.position, f.s, f.y);
    return found;
}

GapMap::MeanSlope GapMap::slope_near(const SampleBlocks& blocks, double s, double y,
                                     double reach) const {
    MeanSlope mean{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    int count = 0;
    const auto add = [&](const Eigen::Vector2d& place, double slope_s, double slope_y) {
        mean.place += place;
        mean.slope += Eigen::Vector2d(slope_s / grid_.ds, slope_y / grid_.dy);
        ++count;
    };
    const auto column = static_cast<float>(s / grid_.ds + 0.5 * (grid_.nx - 1));
    const auto row = static_cast<float>(y / grid_.dy + 0.5 * (grid_.ny - 1));
    for (std::size_t k = 0; k < placed_count_; ++k) {
        const PlacedBlock& placed = placed_[k];
        std::uint64_t lanes =
            lanes_near(placed, grid_.nx, column, row, static_cast<float>(grid_.ds),
                       static_cast<float>(grid_.dy), static_cast<float>(reach));
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            // Beyond the outermost cells' centres, weights do not tell how far.
            const std::size_t position = std::size_t{placed.block} * kBlockLanes + lane;
            const double across = (contact_from_work_ * blocks.top_in_block(position)).y();
            add({place_of(placed, lane).x(), across}, placed.slope_s[lane], placed.slope_y[lane]);
        }
    }
    for (const Footprint& f : footprints_)
        if (f.nearest && (f.s - s) * (f.s - s) + (f.y - y) * (f.y - y) <= reach * reach)
            add({f.s, f.y}, f.slope_s, f.slope_y);
    return {mean.place / count, mean.slope / count};
}

}  // namespace beltgrinding

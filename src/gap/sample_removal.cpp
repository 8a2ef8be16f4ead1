#include "gap/sample_removal.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace beltgrinding {
namespace {

// Samples stand for about as much area as the cells that they share; where a gouge's walls leave
// far less, no volume is squeezed out of what is left.
constexpr double kLargestScale = 1.5;

}  // namespace

double SampleRemoval::ask(const PlacedSamples& placed, const SampleBlocks& blocks,
                          const ContactGrid& grid, const Asked& asked) {
    const Bilinear* table = table_.fill(grid, asked.rate, asked.duration);
    const auto regular = placed.regular();
    lowering_.resize(regular.size() * kBlockLanes);
    active_.assign(regular.size(), 0);
    volumes_.assign(regular.size(), 0.0);
    double volume = 0.0;
    for (std::size_t k = 0; k < regular.size(); ++k) {
        float* lowering = &lowering_[k * kBlockLanes];
        if (!interpolate(regular[k], table, 0.0f, lowering)) continue;
        active_[k] = 1;
        volumes_[k] = volume_of(lowering, blocks.block(regular[k].block).area.data());
        volume += volumes_[k];
    }
    sum_rates(placed, grid, asked, asked_);
    const auto footprints = placed.footprints();
    for (std::size_t k = 0; k < footprints.size(); ++k) {
        asked_[k] *= asked.duration;
        volume += asked_[k] * footprints[k].area;
    }
    return volume;
}

void SampleRemoval::look_at_block(const PlacedSamples& placed, const SampleBlocks& blocks,
                                  std::size_t k, double approach, Held& held) {
    const PlacedBlock& block = placed.regular()[k];
    const WheelPose& pose = placed.pose();
    const double bent = approach * approach / pose.wheel().radius;
    // Room enough for what the others keep back as well.
    const double room = (1.0 + pose.steepest_flank()) * kLargestScale;
    const float* lowering = &lowering_[k * kBlockLanes];
    const float* area = blocks.block(block.block).area.data();
    const Standing standing = stand_off(block, lowering, static_cast<float>(approach),
                                        static_cast<float>(bent), static_cast<float>(room));
    free_[k] = standing.free;
    held.any = held.any || standing.onto != 0;
    double of_free = volumes_[k];
    for (std::uint64_t lanes = standing.onto | standing.unsure; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        const double asked = lowering[lane];
        of_free -= asked * area[lane];
        if ((standing.onto >> lane & 1U) != 0) continue;
        const Footprint f = PlacedSamples::in_block(blocks, block, lane);
        const double down = pose.down_to_envelope(blocks, f, approach, kLargestScale * asked);
        limited_.emplace_back(k * kBlockLanes + static_cast<std::size_t>(lane), down);
        const bool holds = down < scale_ * asked;
        held.any = held.any || holds;
        (holds ? held.kept : held.free) += std::min(down, scale_ * asked) * area[lane];
    }
    held.free += scale_ * std::max(of_free, 0.0);
}

void SampleRemoval::look_at_footprints(const PlacedSamples& placed, const SampleBlocks& blocks,
                                       double approach, Held& held) {
    const auto footprints = placed.footprints();
    room_.assign(footprints.size(), 0.0);
    for (std::size_t k = 0; k < footprints.size(); ++k) {
        if (asked_[k] <= 0.0) continue;
        const Footprint& f = footprints[k];
        room_[k] = placed.pose().down_to_envelope(blocks, f, approach, kLargestScale * asked_[k]);
        const double most = std::min(room_[k], scale_ * asked_[k]);
        const bool holds = most < scale_ * asked_[k];
        held.any = held.any || holds;
        (holds ? held.kept : held.free) += most * f.area;
    }
}

void SampleRemoval::note_taken(double more) {
    taken_.resize(active_.size() * kBlockLanes);
    for (std::size_t k = 0; k < active_.size(); ++k) {
        if (active_[k] == 0) continue;
        has_taken_[k] = 1;
        for (std::size_t lane = 0; lane < kBlockLanes; ++lane)
            taken_[k * kBlockLanes + lane] =
                (free_[k] >> lane & 1U) != 0 ? static_cast<float>(more) : 0.0f;
    }
}

double SampleRemoval::remove(PlacedSamples& placed, SampleBlocks& blocks, const ContactGrid& grid,
                             const Asked& asked, double volume, double approach) {
    const std::size_t count = placed.regular().size();
    start(count);
    const double unscaled = ask(placed, blocks, grid, asked);
    if (!(unscaled > 0.0)) return 0.0;
    scale_ = std::min(volume / unscaled, kLargestScale);
    Held held;
    limited_.clear();
    free_.assign(count, 0);
    for (std::size_t k = 0; k < count; ++k)
        if (active_[k] != 0) look_at_block(placed, blocks, k, approach, held);
    look_at_footprints(placed, blocks, approach, held);
    const double wanted = scale_ * unscaled;
    double more = 1.0;
    if (held.any && held.free > 0.0)
        more = std::clamp((wanted - held.kept) / held.free, 1.0, kLargestScale / scale_);
    if (held.any) note_taken(more);
    double removed = lower_regular(placed, blocks, more * scale_);
    lower_footprints(placed, blocks, more, held.any, removed);
    return held.any ? removed : wanted;
}

void SampleRemoval::lower_footprints(PlacedSamples& placed, SampleBlocks& blocks, double more,
                                     bool held, double& removed) {
    const auto footprints = placed.footprints();
    for (std::size_t k = 0; k < footprints.size(); ++k) {
        if (asked_[k] <= 0.0) continue;
        const double lowering = std::min(room_[k], more * scale_ * asked_[k]);
        if (held) footprints[k].taken = static_cast<float>(lowering / (scale_ * asked_[k]));
        if (lowering <= 0.0) continue;
        blocks.lower(footprints[k].position, lowering);
        removed += lowering * footprints[k].area;
    }
}

double SampleRemoval::lower_regular(const PlacedSamples& placed, SampleBlocks& blocks,
                                    double factor) {
    const auto regular = placed.regular();
    double removed = 0.0;
    for (std::size_t k = 0; k < regular.size(); ++k) {
        if (free_[k] == 0) continue;
        SampleBlocks::Block& block = blocks.block_to_lower(regular[k].block);
        const Lowered lowered = lower_block(block.height.data(), &lowering_[k * kBlockLanes],
                                            block.area.data(), factor, free_[k]);
        blocks.lowered(regular[k].block, free_[k], lowered.lowest, lowered.highest);
        removed += lowered.volume;
    }
    for (const auto& [index, room] : limited_) {
        const double asked = lowering_[index];
        const double lowering = std::min(room, factor * asked);
        if (has_taken_[index / kBlockLanes] != 0)
            taken_[index] = static_cast<float>(lowering / (scale_ * asked));
        if (lowering <= 0.0) continue;
        const std::uint32_t number = regular[index / kBlockLanes].block;
        blocks.lower(std::size_t{number} * kBlockLanes + index % kBlockLanes, lowering);
        removed += lowering * blocks.block(number).area[index % kBlockLanes];
    }
    return removed;
}

void SampleRemoval::sum_rates(const PlacedSamples& placed, const ContactGrid& grid,
                              const Asked& asked, std::vector<double>& sums) {
    const auto footprints = placed.footprints();
    sums.assign(footprints.size(), 0.0);
    for (std::size_t k = 0; k < footprints.size(); ++k) {
        const Footprint& f = footprints[k];
        if (f.nearest) sums[k] = f.inside * value_at(grid, f, asked.rate);
    }
    if (!placed.beside().has(asked.beside)) return;
    placed.beside().for_reached(
        grid, footprints, asked.beside,
        [&](std::size_t k, double share, double rate) { sums[k] += share * rate; });
}

double cut_to_envelope(const PlacedSamples& placed, SampleBlocks& blocks) {
    const WheelPose& pose = placed.pose();
    const HeightField& field = blocks.field();
    double volume = 0.0;
    const auto cut_one = [&](const Footprint& f) {
        double cosine = f.cosine;
        if (field.leans(f.sample)) {
            const Vec3 ray =
                pose.contact_from_work().linear() * field.rays[f.sample].cast<double>();
            const double angle = f.s / pose.wheel().radius;
            cosine = -(ray.x() * std::sin(angle) + ray.z() * std::cos(angle));
            cosine = std::max<double>(cosine, kSteepest);
        }
        const double lowering = pose.down_to_envelope(blocks, f, 0.0, -f.own_gap / cosine);
        if (lowering <= 0.0) return;
        blocks.lower(f.position, lowering);
        volume += lowering * f.area;
    };
    for (const PlacedBlock& block : placed.regular()) {
        for (std::uint64_t lanes = block.regular; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            if (!(block.own_gap[lane] < 0.0f)) continue;
            cut_one(PlacedSamples::in_block(blocks, block, lane));
        }
    }
    for (const Footprint& f : placed.footprints()) {
        if (f.own_gap >= 0.0f || f.inside < 0.5) continue;  // its middle lies beside the wheel
        cut_one(f);
    }
    return volume;
}

}  // namespace beltgrinding

#include "heightfield/sample_blocks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

// mm by which the reach is widened for which blocks are listed, so that it holds for as much of the
// wheel's way.
constexpr double kAhead = 4.0;
constexpr float kRounding = 1e-5F;  // mm, of bounds
constexpr std::size_t kBlocksAtOnce = 256;

}  // namespace

SampleBlocks::SampleBlocks(const HeightField& field, const RunContext& context)
    : field_(field), tree_(field, context) {
    blocks_.resize(tree_.leaves());
    bounds_.resize(tree_.leaves());
    changed_.assign(tree_.leaves(), 0);
    parallel_blocks(blocks_.size(), kBlocksAtOnce, context,
                    [&](std::size_t begin, std::size_t end) {
                        for (auto k = static_cast<std::uint32_t>(begin); k < end; ++k) {
                            Block& block = blocks_[k];
                            const auto samples = tree_.leaf(k);
                            Eigen::AlignedBox3d box;
                            for (const std::uint32_t s : samples) box.extend(field.point[s]);
                            block.origin = box.center();
                            block.height.fill(field.height[samples.front()]);
                            for (std::size_t lane = 0; lane < samples.size(); ++lane) {
                                const std::uint32_t s = samples[lane];
                                const Vec3f from = (field.point[s] - block.origin).cast<float>();
                                block.x[lane] = from.x();
                                block.y[lane] = from.y();
                                block.z[lane] = from.z();
                                block.height[lane] = field.height[s];
                                block.area[lane] = field.area[s];
                                const std::uint64_t bit = std::uint64_t{1} << lane;
                                if ((field.flags[s] & kOnBoundary) != 0) block.border |= bit;
                                if ((field.flags[s] & kMissed) != 0) continue;
                                block.nx[lane] = field.normal[s].x();
                                block.ny[lane] = field.normal[s].y();
                                block.nz[lane] = field.normal[s].z();
                                if (field.leans(s)) block.leaning |= bit;
                            }
                            bounds_[k] = bound_of(k);
                        }
                    });
}

SampleBlocks::Bound SampleBlocks::bound_of(std::uint32_t number) const {
    const auto samples = tree_.leaf(number);
    Bound bound{};
    bound.centre = blocks_[number].origin;
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t s : samples) sum += field_.ray(s).cast<double>();
    bound.normal = sum.squaredNorm() > 0.0 ? Vec3(sum.normalized()) : Vec3(Vec3::UnitZ());
    double radius = 0.0, thickness = 0.0, spread = 0.0;
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const std::uint32_t s : samples) {
        const Vec3 from = field_.point[s] - bound.centre;
        const double along = from.dot(bound.normal);
        thickness = std::max(thickness, std::abs(along));
        radius = std::max(radius, (from - along * bound.normal).norm());
        spread = std::max(spread, (field_.ray(s).cast<double>() - bound.normal).norm());
        lowest = std::min(lowest, field_.height[s]);
        highest = std::max(highest, field_.height[s]);
    }
    bound.radius = static_cast<float>(radius) + kRounding;
    bound.thickness = static_cast<float>(thickness) + kRounding;
    bound.spread = static_cast<float>(spread) + 1e-6F;
    bound.lowest = static_cast<float>(lowest) - kRounding;
    bound.highest = static_cast<float>(highest) + kRounding;
    bound.bottom = static_cast<float>(std::min(lowest, -field_.depth));
    return bound;
}

bool SampleBlocks::may_meet(std::uint32_t number, const WheelReach& reach) const {
    const Bound& b = bounds_[number];
    const double middle = 0.5 * (static_cast<double>(b.lowest) + b.highest);
    const double half = 0.5 * (static_cast<double>(b.highest) - b.lowest);
    const double farthest = std::max(std::abs(b.lowest), std::abs(b.highest));
    const double radius = b.radius + farthest * b.spread;
    const double thickness = b.thickness + half + farthest * b.spread;
    // How far tops lie from the centre along a unit direction, by its cosine to the normal.
    const auto extent = [&](double cosine) {
        return radius * std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) +
               thickness * std::abs(cosine);
    };
    const Vec3 from = b.centre + middle * b.normal - reach.centre;
    const double along_axis = from.dot(reach.axis);
    const double tilt = reach.axis.dot(b.normal);
    if (std::abs(along_axis) > reach.half_width + extent(tilt)) return false;
    const double down = (1.0 + b.spread) * (b.highest - b.bottom);
    const double facing = reach.direction.dot(b.normal);
    if (from.dot(reach.direction) + extent(facing) + down < reach.min_along) return false;
    const Vec3 across = from - along_axis * reach.axis;
    const double distance = across.norm();
    if (distance <= reach.radius) return true;
    return distance - extent(across.dot(b.normal) / distance) <= reach.radius;
}

SampleBlocks::Block& SampleBlocks::block_to_lower(std::uint32_t number) {
    Block& block = blocks_[number];
    if (changed_[number] == 0) {  // to be noted as the next change
        if (before_.size() == changes_.size()) before_.emplace_back();
        before_[changes_.size()] = block.height;
    }
    return block;
}

void SampleBlocks::lowered(std::uint32_t number, std::uint64_t lanes, double lowest,
                           double highest) {
    bounds_[number].lowest = static_cast<float>(lowest) - kRounding;
    bounds_[number].highest = static_cast<float>(highest) + kRounding;
    note(number, lanes);
}

void SampleBlocks::lower(std::size_t position, double depth) {
    const auto number = static_cast<std::uint32_t>(position / kLanes);
    const std::size_t lane = position % kLanes;
    double& height = block_to_lower(number).height[lane];
    height -= depth;
    Bound& bound = bounds_[number];
    bound.lowest = std::min(bound.lowest, static_cast<float>(height) - kRounding);
    note(number, std::uint64_t{1} << lane);
}

void SampleBlocks::note(std::uint32_t number, std::uint64_t lanes) {
    if (changed_[number] == 0 && lanes != 0)
        changes_.push_back({number, static_cast<std::uint32_t>(changes_.size()), 0});
    changed_[number] |= lanes;
    const Bound& bound = bounds_[number];
    if (!(bound.lowest < bound.bottom)) return;
    // Below what the tree knows: rare, and again only after as much as the segments are deep.
    deepen({number, bound.lowest - static_cast<float>(field_.depth)});
}

void SampleBlocks::deepen(const Deepened& to) {
    bounds_[to.block].bottom = to.bottom;
    deepened_.push_back(to);
    for (const std::uint32_t s : tree_.leaf(to.block)) {
        tree_.extend(to.block, field_.point[s] +
                                   static_cast<double>(to.bottom) * field_.ray(s).cast<double>());
    }
}

void SampleBlocks::restore(const Ground& ground) {
    blocks_[ground.block].height = ground.height;
    bounds_[ground.block].lowest = ground.lowest;
    bounds_[ground.block].highest = ground.highest;
}

std::span<const SampleBlocks::Change> SampleBlocks::changes() {
    std::sort(changes_.begin(), changes_.end(),
              [](const Change& a, const Change& b) { return a.block < b.block; });
    for (Change& change : changes_) change.lanes = changed_[change.block];
    return changes_;
}

void SampleBlocks::clear_changes() {
    for (const Change& change : changes_) changed_[change.block] = 0;
    changes_.clear();
}

std::vector<double> SampleBlocks::heights() const {
    std::vector<double> heights(field_.size());
    for (std::size_t k = 0; k < heights.size(); ++k) heights[sample(k)] = height(k);
    return heights;
}

std::size_t SampleBlocks::bytes() const {
    return tree_.bytes() + blocks_.capacity() * sizeof(Block) + bounds_.capacity() * sizeof(Bound) +
           changed_.capacity() * sizeof(std::uint64_t);
}

std::vector<std::uint32_t> BlockSet::take() {
    std::sort(all_.begin(), all_.end());
    for (const std::uint32_t block : all_) has_[block] = 0;
    return std::exchange(all_, {});
}

void NearBlocks::find(const SampleBlocks& blocks, const WheelReach& reach,
                      std::vector<std::uint32_t>& found) {
    // Listed for a much larger reach, such as when the surface was searched for, too many are near.
    const bool wide = listed_.radius > reach.radius + 2.0 * kAhead ||
                      listed_.half_width > reach.half_width + 2.0 * kAhead;
    if (!any_ || wide || !listed_.holds(reach)) {
        listed_ = reach.widened(kAhead);
        blocks.near(listed_, near_);
        any_ = true;
    }
    found.clear();
    for (const std::uint32_t block : near_)
        if (blocks.may_meet(block, reach)) found.push_back(block);
}

}  // namespace beltgrinding

#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "beltgrinding/height_field.h"
#include "heightfield/kdop_tree.h"

namespace beltgrinding {

/// A height field as a simulation works on it: samples in blocks of 64 neighbours, each a structure
/// of arrays (single precision, from an origin of the block's own, but for the heights), under a
/// k-DOP tree. The place of a sample here is its *position*: 64 times the block's number and its
/// *lane*. The field itself stays as it is until the heights are stored back.
class SampleBlocks {
  public:
    static constexpr std::uint32_t kLanes = SegmentTree::kLeafSize;

    struct alignas(64) Block {
        std::array<double, kLanes> height;  // mm
        std::array<float, kLanes> x, y, z;  // mm, of the design point, from `origin`
        /// Of the face; 0 where nothing is to be touched: the stock's rays missed, or no sample.
        std::array<float, kLanes> nx, ny, nz;
        std::array<float, kLanes> area;  // mm2
        std::uint64_t leaning = 0;       // lanes whose rays are not their normals
        std::uint64_t border = 0;        // lanes on a border of the surface
        Vec3 origin = Vec3::Zero();      // mm, work frame

        Vec3f normal(std::size_t lane) const { return {nx[lane], ny[lane], nz[lane]}; }
    };
    /// What is lowered in a block, one bit a lane.
    struct Change {
        std::uint32_t block;
        std::uint32_t kept;  // place of the heights before, see `before`
        std::uint64_t lanes;
    };

    /// `field` must outlive it and stay as it is.
    explicit SampleBlocks(const HeightField& field, const RunContext& context = {});

    const HeightField& field() const { return field_; }
    std::uint32_t count() const { return static_cast<std::uint32_t>(blocks_.size()); }
    const Block& block(std::uint32_t number) const { return blocks_[number]; }
    /// The same, whose heights may be lowered; then `lowered` must be told, of this block first.
    Block& block_to_lower(std::uint32_t number);
    /// Samples of all positions.
    std::span<const std::uint32_t> samples() const { return tree_.order(); }
    std::uint32_t sample(std::size_t position) const { return samples()[position]; }
    double height(std::size_t position) const {
        return blocks_[position / kLanes].height[position % kLanes];
    }
    /// Current top of a segment, mm, work frame.
    Vec3 top(std::size_t position) const {
        const std::uint32_t s = sample(position);
        return field_.point[s] + height(position) * field_.ray(s).cast<double>();
    }
    /// The same of the block alone, whose design point is rounded to 1e-7 of the block's size; of
    /// what is not to be touched the design point.
    Vec3 top_in_block(std::size_t position) const {
        const Block& from = blocks_[position / kLanes];
        const std::size_t lane = position % kLanes;
        const Vec3f offset(from.x[lane], from.y[lane], from.z[lane]);
        const bool leans = (from.leaning >> lane & 1U) != 0;
        const Vec3f ray = leans ? field_.rays[sample(position)] : from.normal(lane);
        return from.origin + offset.cast<double>() + from.height[lane] * ray.cast<double>();
    }

    /// Replaces `found` by all blocks that may have a segment in the reach, ascending.
    void near(const WheelReach& reach, std::vector<std::uint32_t>& found) const {
        tree_.query(reach, found);
    }
    /// False if no segment of the block has both its top within the reach's cylinder and a point on
    /// its side of `min_along`. Closer than the tree: a block is looked at as a disc.
    bool may_meet(std::uint32_t block, const WheelReach& reach) const;

    /// Heights of `lanes` were lowered; those of the whole block lie from `lowest` to `highest` mm.
    void lowered(std::uint32_t block, std::uint64_t lanes, double lowest, double highest);
    /// mm: no sample of the block is lower; up to 1e-5 mm below the lowest.
    double lowest(std::uint32_t block) const { return bounds_[block].lowest; }
    /// Lowers one by `depth` mm.
    void lower(std::size_t position, double depth);
    /// What was lowered since the last `clear_changes`, by ascending blocks.
    std::span<const Change> changes();
    void clear_changes();
    /// Heights of the block before its first change since the last `clear_changes`, mm.
    const std::array<double, kLanes>& before(const Change& change) const {
        return before_[change.kept];
    }

    /// What grinding has made of a block.
    struct Ground {
        std::uint32_t block;
        float lowest, highest;              // mm, as it is bounded
        std::array<double, kLanes> height;  // mm
    };
    Ground ground(std::uint32_t block) const {
        return {block, bounds_[block].lowest, bounds_[block].highest, blocks_[block].height};
    }
    /// Makes of a block what grinding made of it before; nothing is noted as a change.
    void restore(const Ground& ground);
    /// A block that was ground deeper than the tree had it: it has `bottom` mm since.
    struct Deepened {
        std::uint32_t block;
        float bottom;
    };
    /// All so far, in order.
    std::span<const Deepened> deepened() const { return deepened_; }
    /// Has the tree reach down there.
    void deepen(const Deepened& to);

    /// The current heights, by sample.
    std::vector<double> heights() const;
    /// Bytes beside those of the field.
    std::size_t bytes() const;

  private:
    /// The tops of a block lie round a disc: `centre` + h `normal`, h from `lowest` to `highest`.
    struct Bound {
        Vec3 centre, normal;      // mm; unit
        float radius, thickness;  // mm, of the design points: square to `normal` and along it
        float spread;             // largest difference of a ray from `normal`
        float lowest, highest;    // mm
        float bottom;             // mm: what the tree reaches down to at least
    };
    Bound bound_of(std::uint32_t block) const;
    /// Its bound has been lowered.
    void note(std::uint32_t block, std::uint64_t lanes);

    const HeightField& field_;
    SegmentTree tree_;
    std::vector<Block> blocks_;
    std::vector<Bound> bounds_;
    std::vector<std::uint64_t> changed_;  // by block
    std::vector<Change> changes_;
    std::vector<std::array<double, kLanes>> before_;  // mm, by change, in the order they came
    std::vector<Deepened> deepened_;
};

/// Calls visit(position) for all that was lowered, ascending.
template <class Visit>
void for_changed(std::span<const SampleBlocks::Change> changes, Visit visit) {
    for (const SampleBlocks::Change& change : changes) {
        const std::size_t first = std::size_t{change.block} * SampleBlocks::kLanes;
        for (std::uint64_t lanes = change.lanes; lanes != 0; lanes &= lanes - 1)
            visit(first + static_cast<std::size_t>(std::countr_zero(lanes)));
    }
}

/// Keeps the blocks near a wheel that moves on, so that the tree is asked every few mm only.
class NearBlocks {
  public:
    /// Replaces `found` by all blocks that `may_meet` the reach, ascending.
    void find(const SampleBlocks& blocks, const WheelReach& reach,
              std::vector<std::uint32_t>& found);
    std::size_t bytes() const { return near_.size() * sizeof(near_.front()); }

  private:
    WheelReach listed_;
    bool any_ = false;
    std::vector<std::uint32_t> near_;
};

/// Numbers of blocks, each once.
class BlockSet {
  public:
    explicit BlockSet(std::uint32_t blocks) : has_(blocks, 0) {}
    void add(std::span<const std::uint32_t> blocks) {
        for (const std::uint32_t block : blocks)
            if (std::exchange(has_[block], std::uint8_t{1}) == 0) all_.push_back(block);
    }
    /// Hands over all, ascending; there are none from then on.
    std::vector<std::uint32_t> take();

  private:
    std::vector<std::uint8_t> has_;
    std::vector<std::uint32_t> all_;
};

}  // namespace beltgrinding

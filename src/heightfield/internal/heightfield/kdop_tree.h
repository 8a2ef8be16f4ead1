#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"
#include "heightfield/wheel_reach.h"

namespace beltgrinding {

/// Number of slab directions times two; one of 6, 14, 18, 26, fixed when the library is built.
#ifndef BELTGRINDING_KDOP_K
#define BELTGRINDING_KDOP_K 18
#endif

/// Bounding-volume tree of k-DOPs over leaves of up to 64 neighbouring segments of the height field
/// (from `-depth` to `height`). Klosowski et al.: Efficient collision detection using bounding
/// volume hierarchies of k-DOPs (1998). Queries are const and may run on several threads.
///
/// It bounds the segments as they are when it is built. They only get shorter, so that it stays
/// right; what is ground deeper than `-depth` is told by `extend`.
template <int K>
class KDopTree {
    static_assert(K == 6 || K == 14 || K == 18 || K == 26);

  public:
    static constexpr std::uint32_t kLeafSize = 64;

    /// Builds over all samples of `field` in parallel; the same tree for any number of threads.
    explicit KDopTree(const HeightField& field, const RunContext& context = {});
    ~KDopTree();
    KDopTree(KDopTree&&) noexcept;
    KDopTree& operator=(KDopTree&&) noexcept;

    std::uint32_t leaves() const;
    /// Samples of a leaf, ascending; of the last one perhaps fewer than `kLeafSize`.
    std::span<const std::uint32_t> leaf(std::uint32_t number) const;
    /// All samples, leaf by leaf.
    std::span<const std::uint32_t> order() const;

    /// Replaces `found` by the numbers (ascending) of all leaves that may have a segment with a
    /// point inside `reach`. Never misses one.
    void query(const WheelReach& reach, std::vector<std::uint32_t>& found) const;

    /// A segment of the leaf reaches to `point` (mm, work frame) from now on.
    void extend(std::uint32_t leaf, const Vec3& point);

    std::size_t bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

using SegmentTree = KDopTree<BELTGRINDING_KDOP_K>;

}  // namespace beltgrinding

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// What the wheel can reach at a pose: a solid of revolution about an axis, in work coordinates.
/// All points within `radius` of the axis and within `half_width` of `centre` along it; optionally
/// only those on the side `(x - centre) . direction >= min_along`.
struct WheelReach {
    Vec3 centre = Vec3::Zero();      ///< wheel's centre, mm, work frame
    Vec3 axis = Vec3::UnitY();       ///< unit
    Vec3 direction = Vec3::UnitZ();  ///< unit, perpendicular to axis: from centre to the contact
    double radius = 0.0;             ///< mm
    double half_width = 0.0;         ///< mm
    double min_along = 0.0;          ///< mm; e.g. 0 keeps the half that faces the work
};

/// Number of slab directions times two; one of 6, 14, 18, 26, fixed when the library is built.
#ifndef BELTGRINDING_KDOP_K
#define BELTGRINDING_KDOP_K 18
#endif

/// Bounding-volume tree of k-DOPs over the height field's segments (from `-depth` to `height`).
/// Klosowski et al.: Efficient collision detection using bounding volume hierarchies of k-DOPs
/// (1998). A query is const and may run on several threads; refit needs the tree alone.
template <int K>
class KDopTree {
    static_assert(K == 6 || K == 14 || K == 18 || K == 26);

  public:
    /// Builds over all samples of `field` in parallel; the same tree for any number of threads.
    explicit KDopTree(const HeightField& field, const RunContext& context = {});
    ~KDopTree();
    KDopTree(KDopTree&&) noexcept;
    KDopTree& operator=(KDopTree&&) noexcept;

    /// Replaces `hits` by the indices (ascending) of all samples whose current segment has a point
    /// inside `reach`. Never misses one; no false hits beyond rounding.
    void query(const HeightField& field, const WheelReach& reach,
               std::vector<std::uint32_t>& hits) const;

    /// Shrinks the volumes after `field.height` of `changed` samples was lowered: their leaves and
    /// those leaves' ancestors only.
    void refit(const HeightField& field, std::span<const std::uint32_t> changed);

    std::size_t bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

using SegmentTree = KDopTree<BELTGRINDING_KDOP_K>;

}  // namespace beltgrinding

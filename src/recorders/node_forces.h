#pragma once

#include <cstddef>
#include <cstdint>

namespace beltgrinding {

/// Which samples of a block of 64 are those of a node: a bit each.
struct NodeShare {
    std::uint64_t samples;
    std::uint32_t node;
};

/// N: for each of `shares`, what a block's pressures (MPa) press with on its samples' areas (mm2;
/// less than 0 counts as none). The same bits on all processors (base/lanes.h).
void add_up_forces(const float* pressure, const float* area, const NodeShare* shares,
                   std::size_t count, float* forces);

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "heightfield/sample_blocks.h"

namespace beltgrinding::testing {

/// The numbers of all blocks.
inline std::vector<std::uint32_t> all_of(const SampleBlocks& blocks) {
    std::vector<std::uint32_t> numbers(blocks.count());
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

}  // namespace beltgrinding::testing

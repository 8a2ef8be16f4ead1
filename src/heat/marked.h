#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace beltgrinding {

/// Of no mark up to 127.
constexpr std::uint8_t kUnmarked = 255;

/// Calls visit(k) for all marks up to `most`, which is below 128, ascending: eight at a time, as
/// most of them are none.
template <class Visit>
void for_marked(const std::vector<std::uint8_t>& marks, std::uint8_t most, Visit visit) {
    constexpr std::uint64_t kOnes = 0x0101010101010101ULL, kHigh = 0x80 * kOnes;
    std::size_t k = 0;
    if constexpr (std::endian::native == std::endian::little) {
        for (; k + 8 <= marks.size(); k += 8) {
            std::uint64_t eight;
            std::memcpy(&eight, &marks[k], sizeof eight);
            // The high bit of each: most >= its seven low bits; and it has no high bit itself.
            std::uint64_t found = ((most | 0x80U) * kOnes - (eight & ~kHigh)) & ~eight & kHigh;
            for (; found != 0; found &= found - 1)
                visit(static_cast<std::uint32_t>(k) +
                      static_cast<std::uint32_t>(std::countr_zero(found)) / 8);
        }
    }
    for (; k < marks.size(); ++k)
        if (marks[k] <= most) visit(static_cast<std::uint32_t>(k));
}

}  // namespace beltgrinding

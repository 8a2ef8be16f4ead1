#pragma once

#include <algorithm>
#include <cstddef>

namespace beltgrinding {

constexpr int kWidest = 8;    ///< columns of a panel that are factorised at a time
constexpr int kTogether = 4;  ///< columns, or right-hand sides, that share what is loaded

/// A factor's panels, one behind the other.
struct Factor {
    const double *blocks, *inverse;
    int count, size, negative, reach;
    std::ptrdiff_t height;
    int begin = 0;  ///< panel from which on right-hand sides are not zero

    /// Rows of the columns before `end` of panel i that may not be 0.
    int rows(int i, int end) const {
        const int two = size * std::min(2, count - i);
        return i + 2 < count ? two + std::min(size, std::max(end + reach, negative)) : two;
    }
    /// As many, up to whole registers of `lanes` rows from `end` on where the vectors that are
    /// solved for reach as far.
    int rows(int i, int end, int lanes) const {
        const int least = rows(i, end), most = size * (count - i);
        const int whole = end + (least - end + lanes - 1) / lanes * lanes;
        return whole <= most ? whole : least;
    }
    /// Where the columns end that are looked at together with `first`.
    int end(int first) const {
        return first < negative ? std::min(first + kWidest, negative)
                                : std::min(first + kWidest, size);
    }
};

}  // namespace beltgrinding

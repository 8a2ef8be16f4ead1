#include "pair_motion.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {

double PairMotion::middle(double begin, double end) const {
    const double half = 0.5 * way(begin, end);
    double low = begin, high = end;
    // To the motion, then linearly within it.
    while (std::floor(low) + 1.0 < high) {
        const double next = std::floor(0.5 * (low + high));
        const double at = next > low ? next : std::floor(low) + 1.0;
        (way(begin, at) < half ? low : high) = at;
    }
    const double whole = way(low, high), done = way(begin, low);
    const double share = whole > 0.0 ? (half - done) / whole : 0.5;
    return low + std::clamp(share, 0.0, 1.0) * (high - low);
}

void add_stretches(std::vector<PairMotion::Stretch>& stretches, std::size_t begin, std::size_t end,
                   std::size_t block) {
    for (std::size_t at = begin; at < end || at == begin; at += block) {
        stretches.push_back(
            {static_cast<double>(at), static_cast<double>(std::min(at + block, end))});
    }
}

double sum_at(const std::vector<double>& sums, double place) {
    const std::size_t i = std::min(static_cast<std::size_t>(place), sums.size() - 2);
    return sums[i] + (place - static_cast<double>(i)) * (sums[i + 1] - sums[i]);
}

}  // namespace beltgrinding

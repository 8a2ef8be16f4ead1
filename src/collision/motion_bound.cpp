#include "motion_bound.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

// In a rounded corner the turn goes by two nested slerps, whose speed may exceed that of both
// motions; by less than this factor for turns below half a turn.
constexpr double kCornerTurn = 1.5;

/// The sum at a place, linear within a motion.
double at(const std::vector<double>& sums, double place) {
    const std::size_t i = std::min(static_cast<std::size_t>(place), sums.size() - 2);
    return sums[i] + (place - static_cast<double>(i)) * (sums[i + 1] - sums[i]);
}

}  // namespace

MotionBound::MotionBound(const ToolPath& path) {
    const auto& poses = path.poses();
    const std::size_t count = poses.size();
    std::vector<double> travel(count, 0.0), turn(count, 0.0);
    for (std::size_t i = 1; i < count; ++i) {
        const Frame &a = poses[i - 1].base_from_tcp, &b = poses[i].base_from_tcp;
        travel[i] = (b.translation() - a.translation()).norm();
        turn[i] = angle_between(a, b);
    }
    const std::vector<double> straight = turn;
    if (path.time_law().timing == TimeLaw::Timing::kTrapezoidal) {
        // Corners mix the turns of both motions, each over its own length.
        std::size_t before = 0;
        for (std::size_t i = 1; i < count; ++i) {
            if (travel[i] <= 0.0 && straight[i] <= 0.0) continue;
            if (before > 0 && travel[i] > 0.0 && travel[before] > 0.0) {
                turn[i] = std::max(turn[i], straight[before] * travel[i] / travel[before]);
                turn[before] = std::max(turn[before], straight[i] * travel[before] / travel[i]);
            }
            before = i;
        }
        for (double& angle : turn) angle *= kCornerTurn;
    }
    travel_.assign(1, 0.0);
    turn_.assign(1, 0.0);
    for (std::size_t i = 1; i < count; ++i) {
        travel_.push_back(travel_.back() + travel[i]);
        turn_.push_back(turn_.back() + turn[i]);
    }
}

double MotionBound::way(double begin, double end, double reach) const {
    return at(travel_, end) - at(travel_, begin) + reach * (at(turn_, end) - at(turn_, begin));
}

double MotionBound::middle(double begin, double end, double reach) const {
    const double half = 0.5 * way(begin, end, reach);
    double low = begin, high = end;
    // To the motion, then linearly within it.
    while (std::floor(low) + 1.0 < high) {
        const double next = std::floor(0.5 * (low + high));
        const double at = next > low ? next : std::floor(low) + 1.0;
        (way(begin, at, reach) < half ? low : high) = at;
    }
    const double whole = way(low, high, reach), done = way(begin, low, reach);
    const double share = whole > 0.0 ? (half - done) / whole : 0.5;
    return low + std::clamp(share, 0.0, 1.0) * (high - low);
}

Moment moment_at(double place, std::size_t motions) {
    const std::size_t i = std::min(static_cast<std::size_t>(place), motions - 1);
    return {i + 1, place - static_cast<double>(i)};
}

}  // namespace beltgrinding

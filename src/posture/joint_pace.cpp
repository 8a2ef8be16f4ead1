#include "joint_pace.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr int kRounds = 400;
constexpr double kClose = 1e-3;  // relative, of an acceleration that is kept

bool follows(const std::vector<PosturePose>& way, std::size_t n) {
    return n > 0 && n < way.size() && !way[n].link && way[n].reached && way[n - 1].reached;
}

/// Times its limit, the greatest acceleration of a joint between the motions to n and n + 1; a run
/// begins and ends at rest.
double accelerated(const PostureOptions& options, const std::vector<PosturePose>& way,
                   std::size_t n) {
    const bool before = follows(way, n), after = follows(way, n + 1);
    double time = 0.0, most = 0.0;
    Joints change = Joints::Zero();
    if (before) {
        change -= (way[n].q - way[n - 1].q) / way[n].duration;
        time += 0.5 * way[n].duration;
    }
    if (after) {
        change += (way[n + 1].q - way[n].q) / way[n + 1].duration;
        time += 0.5 * way[n + 1].duration;
    }
    for (int j = 0; j < 6 && time > 0.0; ++j) {
        if (options.acceleration[j] > 0.0)
            most = std::max(most, std::abs(change[j]) / time / options.acceleration[j]);
    }
    return most;
}

}  // namespace

void keep_pace(const PostureOptions& options, std::vector<PosturePose>& way) {
    for (std::size_t n = 1; n < way.size(); ++n) {
        if (!follows(way, n)) continue;
        const double least =
            (way[n].q - way[n - 1].q).cwiseAbs().cwiseQuotient(options.speed).maxCoeff();
        way[n].duration = std::max(way[n].duration, std::max(least, 1e-6));
    }
    if (options.acceleration.maxCoeff() <= 0.0) return;
    // Both motions beside a place take longer by the square root of what is too much, until none
    // is.
    for (int round = 0; round < kRounds; ++round) {
        bool kept = true;
        for (std::size_t n = 0; n < way.size(); ++n) {
            const double most = accelerated(options, way, n);
            if (most <= 1.0 + kClose) continue;
            kept = false;
            const double longer = std::sqrt(most);
            if (follows(way, n)) way[n].duration *= longer;
            if (follows(way, n + 1)) way[n + 1].duration *= longer;
        }
        if (kept) return;
    }
}

}  // namespace beltgrinding

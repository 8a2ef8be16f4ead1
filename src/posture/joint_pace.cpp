#include "joint_pace.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace beltgrinding {
namespace {

constexpr int kRounds = 400;
constexpr double kLeast = 1e-6;  // s, of a motion
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
    Coordinates change = Coordinates::Zero(options.speed.size());
    if (before) {
        change -= (way[n].q - way[n - 1].q) / way[n].duration;
        time += 0.5 * way[n].duration;
    }
    if (after) {
        change += (way[n + 1].q - way[n].q) / way[n + 1].duration;
        time += 0.5 * way[n + 1].duration;
    }
    for (Eigen::Index j = 0; j < change.size() && time > 0.0; ++j) {
        if (options.acceleration[j] > 0.0)
            most = std::max(most, std::abs(change[j]) / time / options.acceleration[j]);
    }
    return most;
}

/// rad/s, m/s, on the motion to n.
Coordinates speed(const std::vector<PosturePose>& way, std::size_t n) {
    return (way[n].q - way[n - 1].q) / way[n].duration;
}

/// Times its limit, the greatest jerk of a joint on the motion to n: by the change of the
/// accelerations at its ends, each from a motion to the next.
double jerked(const PostureOptions& options, const std::vector<PosturePose>& way, std::size_t n) {
    if (n < 2 || !follows(way, n - 1) || !follows(way, n) || !follows(way, n + 1)) return 0.0;
    const Coordinates begin =
        2.0 * (speed(way, n) - speed(way, n - 1)) / (way[n].duration + way[n - 1].duration);
    const Coordinates end =
        2.0 * (speed(way, n + 1) - speed(way, n)) / (way[n + 1].duration + way[n].duration);
    const Coordinates jerk = (end - begin) / way[n].duration;
    double most = 0.0;
    for (Eigen::Index j = 0; j < jerk.size(); ++j) {
        if (options.jerk[j] > 0.0) most = std::max(most, std::abs(jerk[j]) / options.jerk[j]);
    }
    return most;
}

/// How many times longer the motions about n must take.
double lacking(const PostureOptions& options, const std::vector<PosturePose>& way, std::size_t n) {
    double most =
        std::max(std::sqrt(accelerated(options, way, n)), std::cbrt(jerked(options, way, n)));
    if (follows(way, n))
        most = std::max(most, speed(way, n).cwiseAbs().cwiseQuotient(options.speed).maxCoeff());
    return most;
}

/// The greatest of up to `reach` values to both sides of each.
std::vector<double> greatest_about(const std::vector<double>& values, std::size_t reach) {
    std::vector<double> found(values.size());
    std::deque<std::size_t> falling;  // places of values, each less than the one before
    std::size_t next = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
        for (; next < std::min(n + reach + 1, values.size()); ++next) {
            while (!falling.empty() && values[falling.back()] <= values[next]) falling.pop_back();
            falling.push_back(next);
        }
        while (falling.front() + reach < n) falling.pop_front();
        found[n] = values[falling.front()];
    }
    return found;
}

/// Their mean; beyond the ends the last value goes on.
std::vector<double> mean_about(const std::vector<double>& values, std::size_t reach) {
    const std::size_t count = values.size();
    std::vector<double> sums{0.0};
    for (std::size_t k = 0; k < count + 2 * reach; ++k)
        sums.push_back(sums.back() + values[std::min(k < reach ? 0 : k - reach, count - 1)]);
    std::vector<double> found(count);
    for (std::size_t n = 0; n < count; ++n)
        found[n] = (sums[n + 2 * reach + 1] - sums[n]) / static_cast<double>(2 * reach + 1);
    return found;
}

/// Keeps a run, from the pose `begin` up to `end`, to all limits, jerk among them. A feed that
/// changes from motion to motion needs jerk itself: so motions take longer by a factor that changes
/// smoothly, over the number of motions that leaves the run the shortest, and at last all alike.
void smooth_pace(const PostureOptions& options, std::vector<PosturePose>& way, std::size_t begin,
                 std::size_t end) {
    std::vector<PosturePose> run(way.begin() + static_cast<std::ptrdiff_t>(begin),
                                 way.begin() + static_cast<std::ptrdiff_t>(end));
    const std::size_t count = run.size();
    std::vector<double> given(count, 0.0), wanted(count, 1.0), best;
    for (std::size_t n = 1; n < count; ++n) given[n] = run[n].duration;
    for (std::size_t n = 0; n < count; ++n) {
        const double longer = lacking(options, run, n);
        for (std::size_t k = n == 0 ? 0 : n - 1; k < std::min(n + 2, count); ++k)
            wanted[k] = std::max(wanted[k], longer);
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t reach = 1;; reach *= 2) {
        const std::vector<double> longer =
            mean_about(mean_about(greatest_about(wanted, 2 * reach), reach), reach);
        for (std::size_t n = 1; n < count; ++n) run[n].duration = given[n] * longer[n];
        double more = 1.0, sum = 0.0;
        for (std::size_t n = 0; n < count; ++n) more = std::max(more, lacking(options, run, n));
        for (std::size_t n = 1; n < count; ++n) sum += more * run[n].duration;
        if (sum < least) {
            least = sum;
            best.assign(count, 0.0);
            for (std::size_t n = 1; n < count; ++n) best[n] = more * run[n].duration;
        }
        if (reach > count) break;  // all alike
    }
    for (std::size_t n = 1; n < count; ++n) way[begin + n].duration = best[n];
}

}  // namespace

void keep_pace(const PostureOptions& options, std::vector<PosturePose>& way) {
    if (options.jerk.maxCoeff() > 0.0) {
        for (std::size_t begin = 0; begin < way.size();) {
            std::size_t end = begin + 1;
            for (; follows(way, end); ++end)
                way[end].duration = std::max(way[end].duration, kLeast);
            if (end > begin + 1) smooth_pace(options, way, begin, end);
            begin = end;
        }
        return;
    }
    for (std::size_t n = 1; n < way.size(); ++n) {
        if (!follows(way, n)) continue;
        const double least =
            (way[n].q - way[n - 1].q).cwiseAbs().cwiseQuotient(options.speed).maxCoeff();
        way[n].duration = std::max(way[n].duration, std::max(least, kLeast));
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

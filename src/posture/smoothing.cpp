#include "smoothing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "cost.h"
#include "ladder.h"
#include "robot/inverse_kinematics.h"

namespace beltgrinding {
namespace {

constexpr int kSweeps = 40;
constexpr int kHalvings = 6;
constexpr double kGain = 1e-6;  // of the cost there, for a step to be worth it
constexpr double kJump = 0.35;  // rad, more is another configuration

class Smoothing {
  public:
    Smoothing(const ArmScene& scene, const std::vector<PassPose>& poses,
              const PostureOptions& options, const std::vector<Free>& bounds,
              std::vector<PosturePose>& way)
        : scene_(scene),
          poses_(poses),
          options_(options),
          bounds_(bounds),
          cost_(scene.arm(), options),
          times_(times_at(poses)),
          way_(way) {}

    void run(const std::array<double, kFreedoms>& spacing, const RunContext& context) {
        std::array<double, kFreedoms> step = spacing;
        for (int halving = 0; halving < kHalvings; ++halving) {
            for (int sweep = 0; sweep < kSweeps; ++sweep) {
                context.throw_if_cancelled();
                bool better = false;
                for (std::size_t n = 0; n < way_.size(); ++n)
                    for (std::size_t k = 0; k < kFreedoms; ++k)
                        better = shift(n, k, step[k]) || better;
                if (!better) break;
            }
            for (double& one : step) one *= 0.5;
        }
    }

  private:
    bool follows(std::size_t n) const {
        return n > 0 && n < way_.size() && !way_[n].link && way_[n].reached && way_[n - 1].reached;
    }
    double duration(std::size_t n) const { return poses_[way_[n].pose].duration; }

    /// What changes with the joints of pose n: it, the motions beside it, the speeds' changes
    /// there.
    double around(std::size_t n) const {
        double sum = times_[way_[n].pose] * cost_.place(way_[n].q);
        for (const std::size_t m : {n, n + 1})
            if (follows(m)) sum += cost_.edge(way_[m - 1].q, way_[m].q, duration(m));
        for (std::size_t m = n == 0 ? 0 : n - 1; m <= n + 1; ++m) {
            if (follows(m) && follows(m + 1))
                sum += cost_.acceleration(way_[m - 1].q, way_[m].q, way_[m + 1].q, duration(m),
                                          duration(m + 1));
        }
        if (way_[n].link) sum += cost_.travel(before(n), way_[n].q);
        if (n + 1 == way_.size() || way_[n + 1].link) sum += cost_.travel(way_[n].q, after(n));
        return sum;
    }
    const Coordinates& before(std::size_t n) const {
        while (n-- > 0)
            if (way_[n].reached) return way_[n].q;
        return options_.home;
    }
    const Coordinates& after(std::size_t n) const {
        while (++n < way_.size())
            if (way_[n].reached) return way_[n].q;
        return options_.home;
    }

    bool allowed(std::size_t n, std::size_t k, double value) const {
        if (value > options_.free[k].most || value < options_.free[k].low()) return false;
        for (const std::size_t m : {n, n + 1}) {
            if (!follows(m)) continue;
            const double other = way_[m == n ? n - 1 : n + 1].free[k];
            if (std::abs(value - other) > bounds_[way_[m].pose][k]) return false;
        }
        return true;
    }

    /// Pose n with what is free there, in the configuration that it is in.
    std::optional<PosturePose> at(const PosturePose& now, const Free& free) const {
        PosturePose next = now;
        next.free = free;
        next.base_from_tcp =
            moved(scene_, poses_[now.pose].base_from_tcp, free, options_.wheel_radius);
        std::optional<double> least;
        const Joints near = now.q.head<6>();
        next.q = with_axes(scene_, near, free);
        for (const ArmSolution& one : inverse(
                 scene_.arm(), scene_.robot_from_flange(next.base_from_tcp, next.q), near, false)) {
            const double turned = (one.q - near).cwiseAbs().maxCoeff();
            if (turned > kJump || (least && turned >= *least)) continue;
            least = turned;
            next.q.head<6>() = one.q;
        }
        const bool inside = (next.q.array() >= scene_.lower().array()).all() &&
                            (next.q.array() <= scene_.upper().array()).all();
        return least && inside ? std::optional(next) : std::nullopt;
    }

    bool shift(std::size_t n, std::size_t k, double step) {
        if (!way_[n].reached || !options_.free[k].any()) return false;
        const double cost = around(n);
        for (const double side : {step, -step}) {
            Free free = way_[n].free;
            free[k] = std::clamp(free[k] + side, options_.free[k].low(), options_.free[k].most);
            if (free[k] == way_[n].free[k] || !allowed(n, k, free[k])) continue;
            const auto next = at(way_[n], free);
            if (!next) continue;
            const PosturePose kept = way_[n];
            way_[n] = *next;
            if (jumps(n) || around(n) > cost - kGain * cost) {
                way_[n] = kept;
            } else {
                return true;
            }
        }
        return false;
    }
    bool jumps(std::size_t n) const {
        for (const std::size_t m : {n, n + 1}) {
            if (follows(m) && (way_[m].q - way_[m - 1].q).cwiseAbs().maxCoeff() > options_.flip)
                return true;
        }
        return false;
    }

    const ArmScene& scene_;
    const std::vector<PassPose>& poses_;
    const PostureOptions& options_;
    const std::vector<Free>& bounds_;
    Cost cost_;
    std::vector<double> times_;
    std::vector<PosturePose>& way_;
};

/// The run of poses from one link to the next that `n` lies in.
std::pair<std::size_t, std::size_t> run_of(const std::vector<PosturePose>& way, std::size_t n) {
    std::size_t begin = n, end = n + 1;
    while (begin > 0 && !way[begin].link) --begin;
    while (end < way.size() && !way[end].link) ++end;
    return {begin, end};
}

}  // namespace

void smooth(const ArmScene& scene, const std::vector<PassPose>& poses,
            const PostureOptions& options, const std::vector<Free>& bounds,
            const std::array<double, kFreedoms>& spacing, std::vector<PosturePose>& way,
            const RunContext& context) {
    const bool nothing = std::all_of(options.free.begin(), options.free.end(),
                                     [](const FreeRange& one) { return !one.any(); });
    if (nothing) return;
    const std::vector<PosturePose> kept = way;
    Smoothing(scene, poses, options, bounds, way).run(spacing, context);
    std::vector<std::uint8_t> worse(way.size(), 0);
    parallel_blocks(way.size(), 1, context, [&](std::size_t n, std::size_t) {
        worse[n] = way[n].reached && scene.within(way[n].q, options.clearance).has_value() &&
                   !scene.within(kept[n].q, options.clearance);
    });
    // A single pose put back would leap: the whole run is.
    for (std::size_t n = 0; n < way.size(); ++n) {
        if (worse[n] == 0) continue;
        const auto [begin, end] = run_of(way, n);
        std::copy(kept.begin() + static_cast<std::ptrdiff_t>(begin),
                  kept.begin() + static_cast<std::ptrdiff_t>(end),
                  way.begin() + static_cast<std::ptrdiff_t>(begin));
        n = end - 1;
    }
}

}  // namespace beltgrinding

#include "configuration.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr double kJump = 0.15;    // rad; a joint that turns further between two checks is looked at
constexpr int kDepth = 12;        // halvings of the way between two checks: 1 mm to 0.2 um
constexpr double kCoarse = 20.0;  // mm and
constexpr double kCoarseTurn = 0.1;        // rad between the checks that choose a configuration
constexpr std::size_t kFarthest = 20'000;  // of those checks that a choice looks ahead
constexpr std::size_t kCandidates = 64;
constexpr double kMostParts = 1e7;

double turned(const Joints& a, const Joints& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

/// All ways to write the solution with whole turns within the limits; the one nearest to the middle
/// of each joint's range if a joint has none.
std::vector<ArmSolution> with_turns(const RobotArm& arm, const ArmSolution& solution) {
    std::vector<ArmSolution> all{solution};
    for (int i = 0; i < 6; ++i) {
        const double middle = 0.5 * (arm.lower()[i] + arm.upper()[i]);
        const double centred = nearest_turn(solution.q[i], middle);
        std::vector<double> values{centred};
        for (const double side : {2.0 * M_PI, -2.0 * M_PI}) {
            for (double q = centred + side; q >= arm.lower()[i] && q <= arm.upper()[i]; q += side)
                values.push_back(q);
        }
        const std::size_t count = all.size();
        for (std::size_t v = 0; v < values.size() && all.size() < kCandidates; ++v) {
            for (std::size_t k = 0; k < count; ++k) {
                if (v == 0) {
                    all[k].q[i] = values[v];
                } else {
                    all.push_back(all[k]);
                    all.back().q[i] = values[v];
                }
            }
        }
    }
    return all;
}

}  // namespace

double limit_margin(const RobotArm& arm, const Joints& q) {
    const Joints room = (q - arm.lower()).cwiseMin(arm.upper() - q);
    const double least = room.minCoeff();
    return least < 0.0 ? room.cwiseMin(0.0).sum() : least;
}

Follower::Follower(const ToolPath& path, const RobotArm& arm, const ReachOptions& options)
    : path_(path),
      arm_(arm),
      options_(options),
      robot_from_base_(options.base_from_robot.inverse()),
      tcp_from_flange_(options.flange_from_tcp.inverse()) {}

Frame Follower::target(std::size_t pose, double t) const {
    return robot_from_base_ * path_.base_from_tcp(pose, t) * tcp_from_flange_;
}

int Follower::parts(std::size_t pose, double max_travel, double max_angle) const {
    const Frame& a = path_.poses()[pose - 1].base_from_tcp;
    const Frame& b = path_.poses()[pose].base_from_tcp;
    const double wanted = std::max((b.translation() - a.translation()).norm() / max_travel,
                                   angle_between(a, b) / max_angle);
    return static_cast<int>(std::ceil(std::clamp(wanted, 1.0, kMostParts)));
}

std::optional<ArmSolution> Follower::nearest(const Frame& target, const ArmSolution& from) const {
    std::optional<ArmSolution> best;
    double least = 0.0;
    for (const ArmSolution& s : inverse(arm_, target, from.q, false)) {
        const double distance = (s.q - from.q).squaredNorm();
        if (!best || distance < least) {
            best = s;
            least = distance;
        }
    }
    return best;
}

std::optional<ArmSolution> Follower::refine(std::size_t pose, double begin, double end,
                                            const ArmSolution& from, int depth) const {
    std::optional<ArmSolution> next = nearest(target(pose, end), from);
    if (!next || depth == 0 || (next->branch == from.branch && turned(next->q, from.q) < kJump)) {
        return next;
    }
    const double middle = 0.5 * (begin + end);
    const std::optional<ArmSolution> half = refine(pose, begin, middle, from, depth - 1);
    return half ? refine(pose, middle, end, *half, depth - 1) : next;
}

std::optional<ArmSolution> Follower::follow(std::size_t pose, double begin, double end,
                                            const ArmSolution& from) const {
    return refine(pose, begin, end, from, kDepth);
}

/// Along the linear motions after `pose`, joints less those at the start; up to a pose out of reach
/// or a flip. Whole turns of the start do not change it.
std::vector<Joints> Follower::ahead(std::size_t pose, const ArmSolution& start) const {
    std::vector<Joints> found;
    ArmSolution at = start;
    const auto& poses = path_.poses();
    for (std::size_t i = pose + 1; i < poses.size() && !poses[i].rapid; ++i) {
        const int count = parts(i, kCoarse, kCoarseTurn);
        for (int k = 0; k < count && found.size() < kFarthest; ++k) {
            const auto next = nearest(target(i, (k + 1.0) / count), at);
            if (!next || turned(next->q, at.q) > options_.flip) return found;
            found.push_back(next->q - start.q);
            at = *next;
        }
    }
    return found;
}

Follower::Score Follower::score(const Joints& candidate, const std::vector<Joints>& ahead,
                                const std::optional<ArmSolution>& before) const {
    Score score;
    double margin = limit_margin(arm_, candidate);
    score.beyond = std::max(0.0, -margin);
    if (margin >= 0.0) {
        score.lasts = 1;
        for (const Joints& way : ahead) {
            const double here = limit_margin(arm_, candidate + way);
            if (here < 0.0) break;
            margin = std::min(margin, here);
            ++score.lasts;
        }
    }
    score.cost = before ? turned(candidate, before->q) : -margin;
    return score;
}

std::optional<ArmSolution> Follower::arrive(std::size_t pose,
                                            const std::optional<ArmSolution>& before,
                                            bool close) const {
    const Joints middle = 0.5 * (arm_.lower() + arm_.upper());
    const Joints reference = before ? before->q : middle;
    std::optional<ArmSolution> best;
    Score best_score;
    for (const ArmSolution& s : inverse(arm_, target(pose, 1.0), reference)) {
        const std::vector<Joints> way = close ? std::vector<Joints>() : ahead(pose, s);
        for (const ArmSolution& candidate : with_turns(arm_, s)) {
            const Score now = score(candidate.q, way, before);
            if (!best || now.better_than(best_score)) {
                best = candidate;
                best_score = now;
            }
        }
    }
    return best;
}

}  // namespace beltgrinding

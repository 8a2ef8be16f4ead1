#include <algorithm>
#include <cmath>
#include <optional>

#include "links/link.h"
#include "robot/inverse_kinematics.h"

namespace beltgrinding {
namespace {

constexpr double kJump = 0.5;  // rad between two parts

/// The solution nearest to `q`, if it lies near and within the limits.
std::optional<Joints> next_of(const RobotArm& arm, const Frame& target, const Joints& q) {
    std::optional<Joints> found;
    double least = kJump;
    for (const ArmSolution& one : inverse(arm, target, q, false)) {
        const double turned = (one.q - q).cwiseAbs().maxCoeff();
        if (turned >= least) continue;
        least = turned;
        found = one.q;
    }
    const bool inside = found && (found->array() >= arm.lower().array()).all() &&
                        (found->array() <= arm.upper().array()).all();
    return inside ? found : std::nullopt;
}

}  // namespace

Straight straight_way(const ArmScene& scene, const Joints& q, const Frame& base_from_tcp,
                      double step, double turn) {
    const Frame begin = scene.base_from_tcp(q);
    const double parts = std::max((base_from_tcp.translation() - begin.translation()).norm() / step,
                                  angle_between(begin, base_from_tcp) / turn);
    const int count = std::max(1, static_cast<int>(std::ceil(std::min(parts, 1e6))));
    Straight way;
    way.joints.push_back(q);
    for (int k = 1; k <= count; ++k) {
        const Frame at = interpolate(begin, base_from_tcp, static_cast<double>(k) / count);
        const auto next = next_of(scene.arm(), scene.robot_from_flange(at), way.joints.back());
        if (!next) {
            way.whole = false;
            return way;
        }
        way.joints.push_back(*next);
    }
    return way;
}

}  // namespace beltgrinding

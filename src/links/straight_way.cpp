#include <algorithm>
#include <cmath>
#include <optional>

#include "links/link.h"
#include "robot/inverse_kinematics.h"

namespace beltgrinding {
namespace {

constexpr double kJump = 0.5;  // rad between two parts

/// The solution nearest to `q`, if it lies near and within the limits; its axes are those of `q`.
std::optional<Coordinates> next_of(const ArmScene& scene, const Frame& base_from_tcp,
                                   const Coordinates& q) {
    std::optional<Coordinates> found;
    double least = kJump;
    const Joints near = q.head<6>();
    for (const ArmSolution& one :
         inverse(scene.arm(), scene.robot_from_flange(base_from_tcp, q), near, false)) {
        const double turned = (one.q - near).cwiseAbs().maxCoeff();
        if (turned >= least) continue;
        least = turned;
        found = q;
        found->head<6>() = one.q;
    }
    const bool inside = found && (found->array() >= scene.lower().array()).all() &&
                        (found->array() <= scene.upper().array()).all();
    return inside ? found : std::nullopt;
}

}  // namespace

Straight straight_way(const ArmScene& scene, const Coordinates& q, const Frame& base_from_tcp,
                      const Coordinates& end, double step, double turn) {
    const Frame begin = scene.base_from_tcp(q);
    double parts = std::max((base_from_tcp.translation() - begin.translation()).norm() / step,
                            angle_between(begin, base_from_tcp) / turn);
    const Eigen::Index count_of_axes = scene.size() - 6;
    const Coordinates shift = end.tail(count_of_axes) - q.tail(count_of_axes);
    for (Eigen::Index k = 0; k < count_of_axes; ++k) {
        const bool linear = scene.axes()[static_cast<std::size_t>(k)].linear;
        const double part = linear ? step / kMmOfMetre : turn;
        parts = std::max(parts, std::abs(shift[k]) / part);
    }
    const int count = std::max(1, static_cast<int>(std::ceil(std::min(parts, 1e6))));
    Straight way;
    way.joints.push_back(q);
    for (int k = 1; k <= count; ++k) {
        const double share = static_cast<double>(k) / count;
        Coordinates near = way.joints.back();
        near.tail(count_of_axes) = q.tail(count_of_axes) + share * shift;
        const auto next = next_of(scene, interpolate(begin, base_from_tcp, share), near);
        if (!next) {
            way.whole = false;
            return way;
        }
        way.joints.push_back(*next);
    }
    return way;
}

Straight straight_way(const ArmScene& scene, const Coordinates& q, const Frame& base_from_tcp,
                      double step, double turn) {
    return straight_way(scene, q, base_from_tcp, q, step, turn);
}

}  // namespace beltgrinding

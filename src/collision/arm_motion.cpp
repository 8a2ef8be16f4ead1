#include "arm_motion.h"

#include <algorithm>
#include <cmath>

#include "path_motion.h"

namespace beltgrinding {
namespace {

// Moments that are followed by themselves; they lie a step of the simulation apart.
constexpr std::size_t kBlock = 512;
constexpr std::size_t kFlange = 7;  // what it carries counts as the link behind the last

struct Between {
    std::size_t before, after;
    double share;
};

Between between(double place, std::size_t moments) {
    const std::size_t i = std::min(static_cast<std::size_t>(place), moments - 1);
    return {i, std::min(i + 1, moments - 1), place - static_cast<double>(i)};
}

/// mm along the arm at most from a point of axis `from` (joints from 0; 6: the flange) to one of
/// axis `to`, whatever the joints are.
double chain(const RobotArm& arm, std::size_t from, std::size_t to) {
    double length = 0.0;
    for (std::size_t k = from; k < to; ++k) {
        const Vec3 next =
            k == 5 ? Vec3(arm.home().translation()) : arm.point(static_cast<int>(k + 1));
        length += (next - arm.point(static_cast<int>(k))).norm();
    }
    return length;
}

}  // namespace

ArmTravel::ArmTravel(const ToolPath& path, const ArmInCell& arm) : path_(path), arm_(arm) {
    for (std::size_t j = 0; j < 6; ++j) turned_[j].assign(1, 0.0);
    for (std::size_t i = 1; i < arm.way.size(); ++i) {
        Joints turned = Joints::Zero();
        if (arm.way[i].joined) {
            turned = arm.arm.geometric(arm.way[i].q) - arm.arm.geometric(arm.way[i - 1].q);
        }
        for (std::size_t j = 0; j < 6; ++j) {
            turned_[j].push_back(turned_[j].back() +
                                 std::abs(turned[static_cast<Eigen::Index>(j)]));
        }
    }
}

double ArmTravel::turn(std::size_t joint, double begin, double end) const {
    if (moments() < 2) return 0.0;
    return sum_at(turned_[joint], end) - sum_at(turned_[joint], begin);
}

Joints ArmTravel::joints(double place) const {
    const auto [before, after, share] = between(place, moments());
    const Joints &a = arm_.way[before].q, &b = arm_.way[after].q;
    if (!arm_.way[after].joined) return share < 0.5 ? a : b;
    return a + share * (b - a);
}

std::array<double, 6> joint_levers(const RobotArm& arm, std::size_t from, std::size_t to,
                                   double reach) {
    // The points are moved by the joints between the two. Each moves them by its turn times their
    // distance from its axis at most.
    std::array<double, 6> levers{};
    for (std::size_t j = from; j < std::min(to, kFlange - 1); ++j)
        levers[j] = chain(arm, j, to - 1) + reach;
    return levers;
}

std::array<double, 6> joint_levers(const ArmInCell& arm, const CellFrames& cell,
                                   const CollisionBody& first, const CollisionMesh& first_mesh,
                                   const CollisionBody& second, const CollisionMesh& second_mesh) {
    const bool of_link = second.carrier == Carrier::kLink;
    const CollisionBody& held = of_link ? first : second;
    if (carried(held.carrier, cell.holding)) {
        const Frame flange_from_held = arm.flange_from_tcp * holder_from(held.carrier, cell);
        const CollisionMesh& mesh = of_link ? first_mesh : second_mesh;
        return joint_levers(arm.arm, of_link ? second.link : 0, kFlange,
                            mesh.reach(flange_from_held.inverse().translation()));
    }
    const double reach =
        second.link > 0 ? second_mesh.reach(arm.arm.point(static_cast<int>(second.link) - 1)) : 0.0;
    const std::size_t from = first.carrier == Carrier::kLink ? first.link : 0;
    return joint_levers(arm.arm, from, second.link, reach);
}

ArmMotion::ArmMotion(const ArmTravel& travel, const CollisionBody& first, std::size_t link,
                     const std::array<double, 6>& levers)
    : travel_(travel),
      carried_(carried(first.carrier, travel.path().frames().holding)),
      link_(link),
      holder_from_first_(holder_from(first.carrier, travel.path().frames())),
      levers_(levers) {
    if (first.carrier == Carrier::kLink) first_link_ = first.link;
}

std::vector<PairMotion::Stretch> ArmMotion::stretches() const {
    std::vector<Stretch> all;
    const auto& way = travel_.arm().way;
    for (std::size_t begin = 0; begin < way.size();) {
        std::size_t end = begin;
        while (end + 1 < way.size() && way[end + 1].joined) ++end;
        add_stretches(all, begin, end, kBlock);
        begin = end + 1;
    }
    return all;
}

double ArmMotion::way(double begin, double end) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < 6; ++j) {
        if (levers_[j] > 0.0) sum += levers_[j] * travel_.turn(j, begin, end);
    }
    return sum;
}

Frame ArmMotion::base_from_tcp(double place) const {
    const ArmInCell& arm = travel_.arm();
    return arm.base_from_robot * arm.arm.forward(travel_.joints(place)) * arm.flange_from_tcp;
}

Frame ArmMotion::base_from_first(double place) const {
    const ArmInCell& arm = travel_.arm();
    if (first_link_)
        return arm.base_from_robot * arm.arm.links(travel_.joints(place))[*first_link_];
    return carried_ ? Frame(base_from_tcp(place) * holder_from_first_) : holder_from_first_;
}

Frame ArmMotion::first_from_second(double place) const {
    const ArmInCell& arm = travel_.arm();
    return base_from_first(place).inverse() * arm.base_from_robot *
           arm.arm.links(travel_.joints(place))[link_];
}

Frame ArmMotion::work_from_first(double place) const {
    const CellFrames& cell = travel_.path().frames();
    const Frame base_from_work = cell.holding == Holding::kToolInHand
                                     ? cell.base_from_work
                                     : Frame(base_from_tcp(place) * cell.tcp_from_work);
    return base_from_work.inverse() * base_from_first(place);
}

double arm_time(const ArmInCell& arm, double place) {
    const auto& way = arm.way;
    const auto [before, after, share] = between(place, way.size());
    return way[before].time + share * (way[after].time - way[before].time);
}

std::uint32_t ArmMotion::pose(double place) const {
    const auto [before, after, share] = between(place, travel_.moments());
    return travel_.arm().way[share > 0.0 ? after : before].pose;
}

}  // namespace beltgrinding

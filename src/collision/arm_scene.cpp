#include "collision/arm_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arm_motion.h"
#include "collision/touching_links.h"
#include "path_motion.h"

namespace beltgrinding {

/// Where all bodies are at joint angles.
class ArmScene::Placed {
  public:
    Placed(const ArmScene& scene, const Joints& q)
        : scene_(scene),
          links_(scene.cell_.arm.links(q)),
          base_from_tcp_(scene.cell_.base_from_robot * links_[6] * scene.cell_.arm.home() *
                         scene.cell_.flange_from_tcp) {}

    Frame base_from(std::size_t body) const {
        const CollisionBody& one = scene_.bodies_[body];
        if (one.carrier == Carrier::kLink) return scene_.cell_.base_from_robot * links_[one.link];
        const Frame holder = holder_from(one.carrier, scene_.frames_);
        return carried(one.carrier, scene_.frames_.holding) ? Frame(base_from_tcp_ * holder)
                                                            : holder;
    }

  private:
    const ArmScene& scene_;
    std::array<Frame, 7> links_;
    Frame base_from_tcp_;
};

ArmScene::ArmScene(ArmInCell cell, const CellFrames& frames, std::vector<CollisionBody> bodies,
                   const RunContext& context)
    : cell_(std::move(cell)),
      frames_(frames),
      robot_from_base_(cell_.base_from_robot.inverse()),
      tcp_from_flange_(cell_.flange_from_tcp.inverse()),
      bodies_(std::move(bodies)),
      meshes_(prepared(bodies_, true, context)) {
    for (const auto& [a, b] : pairs_looked_at(&cell_.arm, frames_.holding, bodies_, meshes_)) {
        pairs_.push_back(
            {a, b, joint_levers(cell_, frames_, bodies_[a], meshes_[a], bodies_[b], meshes_[b]),
             bodies_[a].margin + bodies_[b].margin});
    }
}

Frame ArmScene::base_from_tcp(const Joints& q) const {
    return cell_.base_from_robot * cell_.arm.forward(q) * cell_.flange_from_tcp;
}

Frame ArmScene::robot_from_flange(const Frame& base_from_tcp) const {
    return robot_from_base_ * base_from_tcp * tcp_from_flange_;
}

double ArmScene::clearance_of(const Pair& pair, double asked) const {
    return beltgrinding::clearance_of(bodies_[pair.first], bodies_[pair.second], asked);
}

bool ArmScene::near(const Pair& pair, const Placed& placed, double distance) const {
    const Frame first_from_second =
        placed.base_from(pair.first).inverse() * placed.base_from(pair.second);
    return meshes_[pair.first].within(meshes_[pair.second], first_from_second,
                                      distance + pair.margin);
}

std::optional<ArmScene::Meeting> ArmScene::within(const Joints& q, double distance,
                                                  Pairs pairs) const {
    const Placed placed(*this, q);
    for (const Pair& pair : pairs_) {
        const bool of_arm = bodies_[pair.second].carrier == Carrier::kLink;
        if (pairs != Pairs::kAll && of_arm != (pairs == Pairs::kOfArm)) continue;
        if (near(pair, placed, clearance_of(pair, distance)))
            return Meeting{pair.first, pair.second, 0.0};
    }
    return std::nullopt;
}

std::optional<ArmScene::Meeting> ArmScene::inside(const Joints& q) const {
    const Placed placed(*this, q);
    for (const Pair& pair : pairs_) {
        const CollisionMesh &a = meshes_[pair.first], &b = meshes_[pair.second];
        const Frame first_from_second =
            placed.base_from(pair.first).inverse() * placed.base_from(pair.second);
        if (a.surrounds(b, first_from_second) || b.surrounds(a, first_from_second.inverse()))
            return Meeting{pair.first, pair.second, 0.0};
    }
    return std::nullopt;
}

std::optional<ArmScene::Meeting> ArmScene::on_way(const Joints& from, const Joints& to,
                                                  double clearance, double resolution) const {
    const Joints step = to - from;
    if (const auto met = within(from, clearance)) return met;
    if (const auto met = within(to, clearance)) return Meeting{met->first, met->second, 1.0};
    for (const Pair& pair : pairs_) {
        const double own = clearance_of(pair, clearance);
        const auto share = pair_on_way(pair, from, step, 0.0, 1.0, own, resolution);
        if (share) return Meeting{pair.first, pair.second, *share};
    }
    return std::nullopt;
}

std::optional<double> ArmScene::pair_on_way(const Pair& pair, const Joints& from,
                                            const Joints& step, double begin, double end,
                                            double clearance, double resolution) const {
    const double middle = 0.5 * (begin + end);
    const Joints turned = cell_.arm.geometric(step);
    double way = 0.0;
    for (int j = 0; j < 6; ++j)
        way += pair.levers[static_cast<std::size_t>(j)] * std::abs(turned[j]);
    const double half = 0.5 * way * (end - begin);
    const Placed placed(*this, from + middle * step);
    if (!near(pair, placed, clearance + half)) return std::nullopt;
    if (near(pair, placed, clearance)) return middle;
    if (half <= resolution) return std::nullopt;
    const auto first = pair_on_way(pair, from, step, begin, middle, clearance, resolution);
    return first ? first : pair_on_way(pair, from, step, middle, end, clearance, resolution);
}

}  // namespace beltgrinding

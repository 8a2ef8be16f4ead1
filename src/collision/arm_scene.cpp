#include "collision/arm_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arm_motion.h"
#include "collision/touching_links.h"
#include "path_motion.h"

namespace beltgrinding {

namespace {

/// What external axes carry a body with: the robot, the part, or nothing.
enum class Goes { kRobot, kPart, kNothing };

Goes goes_with(const CollisionBody& body, Holding holding) {
    if (body.carrier == Carrier::kLink || carried(body.carrier, holding)) return Goes::kRobot;
    const bool part = body.carrier == Carrier::kPart && holding == Holding::kToolInHand;
    return part ? Goes::kPart : Goes::kNothing;
}

}  // namespace

/// Where all bodies are at joint angles.
class ArmScene::Placed {
  public:
    Placed(const ArmScene& scene, const Coordinates& q)
        : scene_(scene),
          links_(scene.cell_.arm.links(q.head<6>())),
          base_from_robot_(scene.axes_.base_from_robot(q)),
          base_from_room_(scene.axes_.base_from_room(q)),
          base_from_tcp_(base_from_robot_ * links_[6] * scene.cell_.arm.home() *
                         scene.cell_.flange_from_tcp) {}

    Frame base_from(std::size_t body) const {
        const CollisionBody& one = scene_.bodies_[body];
        if (one.carrier == Carrier::kLink) return base_from_robot_ * links_[one.link];
        Frame holder = holder_from(one.carrier, scene_.frames_);
        switch (goes_with(one, scene_.frames_.holding)) {
            case Goes::kRobot:
                return base_from_tcp_ * holder;
            case Goes::kPart:
                return holder;
            default:
                return base_from_room_ * holder;
        }
    }

  private:
    const ArmScene& scene_;
    std::array<Frame, 7> links_;
    Frame base_from_robot_, base_from_room_, base_from_tcp_;
};

ArmScene::ArmScene(const ArmInCell& cell, const CellFrames& frames,
                   std::vector<CollisionBody> bodies, const RunContext& context)
    : ArmScene(cell, ExternalAxes({}, cell.base_from_robot), frames, std::move(bodies), context) {}

ArmScene::ArmScene(ArmInCell cell, ExternalAxes axes, const CellFrames& frames,
                   std::vector<CollisionBody> bodies, const RunContext& context)
    : cell_(std::move(cell)),
      frames_(frames),
      axes_(std::move(axes)),
      lower_(axes_.standing(cell_.arm.lower())),
      upper_(axes_.standing(cell_.arm.upper())),
      max_speed_(axes_.standing(cell_.arm.max_speed())),
      tcp_from_flange_(cell_.flange_from_tcp.inverse()),
      bodies_(std::move(bodies)),
      meshes_(prepared(bodies_, true, context)) {
    for (std::size_t k = 0; k < axes_.count(); ++k) {
        const auto row = 6 + static_cast<Eigen::Index>(k);
        lower_[row] = axes_[k].lower;
        upper_[row] = axes_[k].upper;
        max_speed_[row] = axes_[k].max_speed;
    }
    LookedAt looked_at = pairs_looked_at(&cell_, frames_, bodies_, meshes_);
    for (const auto& [a, b] : looked_at.pairs) add_pair(a, b);
    touching_ = std::move(looked_at.touching);
    add_pairs_of_axes();
}

void ArmScene::add_pair(std::size_t first, std::size_t second) {
    const CollisionBody &a = bodies_[first], &b = bodies_[second];
    Pair pair{first, second, {}, a.margin + b.margin};
    const Goes with = goes_with(a, frames_.holding), other = goes_with(b, frames_.holding);
    // Bodies of the room and of the part stand still for the joints; so do those of the foot.
    if (other == Goes::kRobot) {
        const std::array<double, 6> own =
            joint_levers(cell_, frames_, a, meshes_[first], b, meshes_[second]);
        std::copy(own.begin(), own.end(), pair.levers.begin());
    }
    if (axes_.count() > 0 && with != other) {
        const auto add = [&](const std::vector<double>& levers, bool of_part) {
            for (std::size_t k = 0; k < axes_.count(); ++k)
                if (axes_[k].carries_part == of_part) pair.levers[6 + k] += levers[k];
        };
        for (const std::size_t n : {first, second}) {
            const Goes one = n == first ? with : other;
            if (one == Goes::kPart) {
                const Frame work = holder_from(bodies_[n].carrier, frames_);
                const Vec3 at = work.translation();
                add(axes_.levers(true, at, meshes_[n].reach(Vec3::Zero())), true);
            } else if (one == Goes::kRobot) {
                // From the robot's base by axis 1 to the farthest point.
                const bool foot = bodies_[n].carrier == Carrier::kLink && bodies_[n].link == 0;
                const double reach = foot ? meshes_[n].reach(Vec3::Zero())
                                          : cell_.arm.point(0).norm() + pair.levers[0];
                add(axes_.levers(false, axes_.base_at_zero().translation(), reach), false);
            }
        }
    }
    pairs_.push_back(pair);
}

/// Those that only external axes move against each other. What touches with all axes at their
/// positions belongs together: a foot stands on its track.
void ArmScene::add_pairs_of_axes() {
    const Placed placed(*this, axes_.standing(Joints::Zero()));
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
        if (bodies_[a].carrier != Carrier::kBase) continue;
        for (std::size_t b = 0; b < bodies_.size(); ++b) {
            const bool foot = bodies_[b].carrier == Carrier::kLink && bodies_[b].link == 0;
            const bool part = goes_with(bodies_[b], frames_.holding) == Goes::kPart;
            if (!(part && axes_.moves_part()) && !(foot && axes_.moves_robot())) continue;
            const Pair pair{a, b, {}, bodies_[a].margin + bodies_[b].margin};
            if (foot && near(pair, placed, 0.0)) continue;
            add_pair(a, b);
        }
    }
}

Frame ArmScene::base_from_tcp(const Coordinates& q) const {
    return axes_.base_from_robot(q) * cell_.arm.forward(q.head<6>()) * cell_.flange_from_tcp;
}

Frame ArmScene::robot_from_flange(const Frame& base_from_tcp, const Coordinates& at) const {
    return axes_.base_from_robot(at).inverse() * base_from_tcp * tcp_from_flange_;
}

double ArmScene::clearance_of(const Pair& pair, double asked) const {
    return beltgrinding::clearance_of(bodies_[pair.first], bodies_[pair.second], frames_.holding,
                                      asked);
}

bool ArmScene::near(const Pair& pair, const Placed& placed, double distance) const {
    const Frame first_from_second =
        placed.base_from(pair.first).inverse() * placed.base_from(pair.second);
    return meshes_[pair.first].within(meshes_[pair.second], first_from_second,
                                      distance + pair.margin);
}

std::optional<ArmScene::Meeting> ArmScene::within(const Coordinates& q, double distance,
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

std::optional<ArmScene::Meeting> ArmScene::inside(const Coordinates& q) const {
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

std::optional<ArmScene::Meeting> ArmScene::on_way(const Coordinates& from, const Coordinates& to,
                                                  double clearance, double resolution) const {
    const Coordinates step = to - from;
    if (const auto met = within(from, clearance)) return met;
    if (const auto met = within(to, clearance)) return Meeting{met->first, met->second, 1.0};
    for (const Pair& pair : pairs_) {
        const double own = clearance_of(pair, clearance);
        const auto share = pair_on_way(pair, from, step, 0.0, 1.0, own, resolution);
        if (share) return Meeting{pair.first, pair.second, *share};
    }
    return std::nullopt;
}

std::optional<double> ArmScene::pair_on_way(const Pair& pair, const Coordinates& from,
                                            const Coordinates& step, double begin, double end,
                                            double clearance, double resolution) const {
    const double middle = 0.5 * (begin + end);
    Coordinates turned = step;
    turned.head<6>() = cell_.arm.geometric(step.head<6>());
    double way = 0.0;
    for (Eigen::Index j = 0; j < turned.size(); ++j)
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

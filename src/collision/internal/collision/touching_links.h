#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "collision/collision_check.h"
#include "collision/collision_mesh.h"

namespace beltgrinding {

/// Pairs of links, by the numbers of their bodies, that are not looked at as their bodies are too
/// rough to tell: they come within `kLinksApart` of each other, or one lies within the other, at
/// joint angles 0, which an arm can take where its limits allow them; or in more than a quarter of
/// all postures within the limits, sampled evenly. Real arms collide with themselves in fewer (by
/// the collision meshes of ROS-Industrial and Universal Robots below a fifth). Always the same.
std::vector<std::pair<std::size_t, std::size_t>> touching_links(
    const RobotArm& arm, const std::vector<CollisionBody>& bodies,
    const std::vector<CollisionMesh>& meshes);

/// The same of bodies whose meshes are not prepared yet. Throws InputError for a body without a
/// mesh, or a link beyond 6.
std::vector<std::pair<std::size_t, std::size_t>> touching_links(
    const RobotArm& arm, const std::vector<CollisionBody>& bodies);

/// The bodies' meshes, prepared. Throws InputError naming the body: no mesh; a link without an arm,
/// or beyond 6. Cancelled.
std::vector<CollisionMesh> prepared(const std::vector<CollisionBody>& bodies, bool has_arm,
                                    const RunContext& context = {});

using BodyPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// What is at the flange, with the bodies of link 5, by their numbers: pairs that come within
/// `kLinksApart`, or one within the other, at `arm.home`. They touch as they are built, as joint 6
/// alone moves them against each other.
BodyPairs touching_wrist(const ArmInCell& arm, const CellFrames& cell,
                         const std::vector<CollisionBody>& bodies,
                         const std::vector<CollisionMesh>& meshes);

struct LookedAt {
    BodyPairs pairs;     ///< by the numbers of the bodies
    BodyPairs touching;  ///< `touching_wrist`
};

/// Pairs that are looked at; the first stands still, or the second is a link. Of links none that
/// are neighbours; none that are next but one where a joint between cannot turn all the way round,
/// as its limits keep them apart, and so of elbow and flange about a spherical wrist; none of
/// `touching_links` and `touching_wrist`.
LookedAt pairs_looked_at(const ArmInCell* arm, const CellFrames& cell,
                         const std::vector<CollisionBody>& bodies,
                         const std::vector<CollisionMesh>& meshes);

/// The clearance that two bodies keep of the one that is asked for, mm.
double clearance_of(const CollisionBody& first, const CollisionBody& second, Holding holding,
                    double asked);

}  // namespace beltgrinding

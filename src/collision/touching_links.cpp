#include "collision/touching_links.h"

#include <algorithm>
#include <array>

#include "beltgrinding/error.h"
#include "path_motion.h"

namespace beltgrinding {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr std::size_t kWrist = 5;
constexpr std::size_t kPostures = 200;
constexpr std::size_t kMost = kPostures / 4;  // in which bodies that are not too rough may touch

/// The n-th number of van der Corput's sequence, in [0, 1). J. H. Halton, On the efficiency of
/// certain quasi-random sequences of points (1960).
double radical_inverse(std::size_t n, std::size_t base) {
    double value = 0.0, digit = 1.0;
    for (; n > 0; n /= base) {
        digit /= static_cast<double>(base);
        value += digit * static_cast<double>(n % base);
    }
    return value;
}

std::vector<Joints> postures(const RobotArm& arm) {
    constexpr std::array<std::size_t, 6> kPrimes = {2, 3, 5, 7, 11, 13};
    std::vector<Joints> all(kPostures);
    for (std::size_t n = 0; n < kPostures; ++n) {
        for (int j = 0; j < 6; ++j) {
            const double share = radical_inverse(n + 1, kPrimes[static_cast<std::size_t>(j)]);
            all[n][j] = arm.lower()[j] + share * (arm.upper()[j] - arm.lower()[j]);
        }
    }
    return all;
}

bool touch(const CollisionMesh& first, const CollisionMesh& second, const Frame& first_from_second,
           double margin = 0.0) {
    return first.within(second, first_from_second, kLinksApart + margin) ||
           first.surrounds(second, first_from_second) ||
           second.surrounds(first, first_from_second.inverse());
}

bool both_links(const CollisionBody& first, const CollisionBody& second) {
    return first.carrier == Carrier::kLink && second.carrier == Carrier::kLink;
}

/// Of what the robot carries and the link before the flange, which joint 6 moves against it.
bool at_wrist(const CollisionBody& first, const CollisionBody& second, Holding holding) {
    return carried(first.carrier, holding) && second.carrier == Carrier::kLink &&
           second.link == kWrist;
}

bool among(const Pairs& pairs, std::size_t first, std::size_t second) {
    return std::find(pairs.begin(), pairs.end(), std::pair(first, second)) != pairs.end();
}

/// Whether limits keep two links apart: they are next but one to each other, and a joint between
/// cannot go all the way round; or they are elbow and flange about a spherical wrist, whose joint 5
/// cannot.
bool kept_apart(const RobotArm& arm, std::size_t first, std::size_t second) {
    constexpr double kWholeTurn = 2.0 * M_PI - 1e-6;
    const Joints range = arm.upper() - arm.lower();
    if (first == 3 && second == 6 && arm.structure() == RobotArm::Structure::kSphericalWrist)
        return range[4] < kWholeTurn;
    return first + 2 == second &&
           range.segment<2>(static_cast<Eigen::Index>(first)).minCoeff() < kWholeTurn;
}

bool looked_at(const RobotArm& arm, const CollisionBody& first, const CollisionBody& second) {
    return !both_links(first, second) || !kept_apart(arm, first.link, second.link);
}

}  // namespace

Pairs touching_links(const RobotArm& arm, const std::vector<CollisionBody>& bodies,
                     const std::vector<CollisionMesh>& meshes) {
    const bool zero_allowed =
        (arm.lower().array() <= 0.0).all() && (arm.upper().array() >= 0.0).all();
    std::vector<std::array<Frame, 7>> placed;
    for (const Joints& q : postures(arm)) placed.push_back(arm.links(q));
    Pairs found;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            if (!both_links(bodies[a], bodies[b])) continue;
            const std::size_t i = bodies[a].link, j = bodies[b].link;
            if (i + 1 >= j || kept_apart(arm, i, j)) continue;
            // At joint angles 0 all links' frames are the robot's base.
            std::size_t count =
                zero_allowed && touch(meshes[a], meshes[b], Frame::Identity()) ? kPostures : 0;
            for (std::size_t n = 0; n < kPostures && count <= kMost; ++n)
                count += touch(meshes[a], meshes[b], placed[n][i].inverse() * placed[n][j]);
            if (count > kMost) found.emplace_back(a, b);
        }
    }
    return found;
}

Pairs touching_links(const RobotArm& arm, const std::vector<CollisionBody>& bodies) {
    return touching_links(arm, bodies, prepared(bodies, true));
}

std::vector<CollisionMesh> prepared(const std::vector<CollisionBody>& bodies, bool has_arm,
                                    const RunContext& context) {
    std::vector<CollisionMesh> meshes;
    for (const CollisionBody& body : bodies) {
        if (body.carrier == Carrier::kLink && (!has_arm || body.link > 6)) {
            throw InputError("collision.link",
                             "{body}: a link of the robot needs an arm, and a number from 0 to 6",
                             {{"body", body.name}});
        }
        try {
            meshes.emplace_back(body.mesh, context);
        } catch (const InputError& error) {
            throw error.within({"collision.body", "{body}: ", {{"body", body.name}}});
        }
    }
    return meshes;
}

BodyPairs touching_wrist(const ArmInCell& arm, const CellFrames& cell,
                         const std::vector<CollisionBody>& bodies,
                         const std::vector<CollisionMesh>& meshes) {
    const Frame wrist_from_tcp =
        arm.arm.links(arm.home)[kWrist].inverse() * arm.arm.forward(arm.home) * arm.flange_from_tcp;
    BodyPairs found;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        const Frame wrist_from_body = wrist_from_tcp * holder_from(bodies[a].carrier, cell);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            if (at_wrist(bodies[a], bodies[b], cell.holding) &&
                touch(meshes[a], meshes[b], wrist_from_body.inverse(),
                      bodies[a].margin + bodies[b].margin))
                found.emplace_back(a, b);
        }
    }
    return found;
}

LookedAt pairs_looked_at(const ArmInCell* arm, const CellFrames& cell,
                         const std::vector<CollisionBody>& bodies,
                         const std::vector<CollisionMesh>& meshes) {
    LookedAt found;
    Pairs rough;
    if (arm != nullptr) {
        rough = touching_links(arm->arm, bodies, meshes);
        found.touching = touching_wrist(*arm, cell, bodies, meshes);
    }
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            if (meets(bodies[a], bodies[b], cell.holding) &&
                (arm == nullptr || looked_at(arm->arm, bodies[a], bodies[b])) &&
                !among(rough, a, b) && !among(found.touching, a, b))
                found.pairs.emplace_back(a, b);
        }
    }
    return found;
}

double clearance_of(const CollisionBody& first, const CollisionBody& second, Holding holding,
                    double asked) {
    const bool rough = both_links(first, second) || at_wrist(first, second, holding);
    return rough ? std::min(asked, kLinksApart) : asked;
}

}  // namespace beltgrinding

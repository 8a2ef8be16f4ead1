#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "beltgrinding/run_context.h"
#include "collision/collision_check.h"
#include "collision/collision_mesh.h"
#include "pair_motion.h"

namespace beltgrinding {

/// Follows one pair of bodies along its motion. Keeps references to the meshes.
class CollisionPair {
  public:
    struct Look {
        double place;
        NearestPoints nearest;
        double distance;  ///< mm, margins counted
        double low;       ///< the true one is no smaller
    };
    using Looks = std::vector<Look>;

    /// `margin`: mm by which the two are thicker than their meshes.
    CollisionPair(std::unique_ptr<const PairMotion> motion, const CollisionMesh& first,
                  const CollisionMesh& second, double margin, const CollisionOptions& options);

    const PairMotion& motion() const { return *motion_; }
    double clearance() const { return options_.clearance; }

    /// Looks at the stretch between two places, so closely that nothing is missed, in order;
    /// without the one at its begin. `done(length)` is called with the stretches that are settled.
    /// Safe from many threads.
    Looks follow(const PairMotion::Stretch& stretch, const RunContext& context,
                 const std::function<void(double)>& done) const;

    /// Takes the looks of each of the motion's stretches.
    void finish(const std::vector<Looks>& followed);

    const Looks& looks() const { return looks_; }
    /// The nearest points of a look in the work frame, on the first body and on the second.
    std::pair<Vec3, Vec3> points(const Look& look) const;

  private:
    bool settled(const Look& begin, const Look& end, double way, double least) const;
    Look look(double place, const NearestPoints& known, bool exact = false) const;
    const NearestPoints& nearer(const Look& a, const Look& b, double place) const;
    void polish();
    void mark_inside();
    bool is_inside(double place) const;

    std::unique_ptr<const PairMotion> motion_;
    const CollisionMesh &first_, &second_;
    CollisionOptions options_;
    double margin_;
    Looks looks_;
};

}  // namespace beltgrinding

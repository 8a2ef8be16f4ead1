#pragma once

#include <functional>
#include <vector>

#include "beltgrinding/run_context.h"
#include "collision/collision_check.h"
#include "collision_mesh.h"
#include "motion_bound.h"

namespace beltgrinding {

/// Follows one pair of bodies along the path: one stands still, the other is carried by the robot.
/// Keeps references to all that it is made of.
class CollisionPair {
  public:
    struct Look {
        double place;
        NearestPoints nearest;
        double distance;  ///< mm, margins counted
        double low;       ///< the true one is no smaller
    };
    using Looks = std::vector<Look>;

    CollisionPair(const ToolPath& path, const MotionBound& bound, const CollisionBody& first,
                  const CollisionMesh& standing, const CollisionBody& second,
                  const CollisionMesh& moving, const CollisionOptions& options);

    /// Looks at the stretch between two places, so closely that nothing is missed, in order;
    /// without the one at its begin. `done(length)` is called with the stretches that are settled.
    /// Safe from many threads.
    Looks follow(double begin, double end, const RunContext& context,
                 const std::function<void(double)>& done) const;

    /// Takes the looks of the whole path, in order.
    void finish(const std::vector<Looks>& blocks);

    const Looks& looks() const { return looks_; }
    Frame base_from_first() const { return first_from_base_.inverse(); }
    Frame base_from_second(double place) const { return base_from_tcp(place) * tcp_from_second_; }
    Frame base_from_tcp(double place) const;

  private:
    bool settled(const Look& begin, const Look& end, double way, double least) const;
    Frame first_from_second(double place) const;
    Look look(double place, const NearestPoints& known, bool exact = false) const;
    const NearestPoints& nearer(const Look& a, const Look& b, double place) const;
    void polish();
    void mark_inside();
    bool is_inside(double place) const;

    const ToolPath& path_;
    const MotionBound& bound_;
    const CollisionMesh &standing_, &moving_;
    const CollisionOptions& options_;
    double margin_;
    Frame first_from_base_, tcp_from_second_;
    double reach_;
    Looks looks_;
};

}  // namespace beltgrinding

#pragma once

#include <limits>
#include <memory>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// The nearest points of two meshes, each in its own mesh's coordinates.
struct NearestPoints {
    double distance = std::numeric_limits<double>::infinity();  ///< mm; 0: the surfaces cross
    Vec3 here = Vec3::Zero();
    Vec3 there = Vec3::Zero();
};

/// A triangle mesh in a form in which its distance to another is found fast. Lengths in mm. Cheap
/// to copy; const calls may run on several threads.
class CollisionMesh {
  public:
    /// Throws InputError for a mesh without triangles, with vertices that are not finite or with
    /// indices out of range.
    explicit CollisionMesh(const TriangleMesh& mesh, const RunContext& context = {});

    /// Distance of the surfaces, too large by at most the share `error` of itself. Of `known` the
    /// points are those of another placement: the nearer they still are, the faster.
    NearestPoints nearest(const CollisionMesh& other, const Frame& this_from_other,
                          const NearestPoints& known = {}, double error = 0.0) const;

    /// Whether the surfaces come within `distance` mm of each other.
    bool within(const CollisionMesh& other, const Frame& this_from_other, double distance) const;

    /// mm from `point` to the vertex that is farthest from it.
    double reach(const Vec3& point) const;

    /// Whether the surface is closed and the point lies inside of it, by the winding number
    /// (Jacobson, Kavan, Sorkine-Hornung: Robust inside-outside segmentation using generalized
    /// winding numbers, 2013).
    bool contains(const Vec3& point) const;
    /// Whether the surface is closed and all of the other mesh lies inside of it, if the surfaces
    /// do not cross.
    bool surrounds(const CollisionMesh& other, const Frame& this_from_other) const;
    Vec3 some_vertex() const;

  private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

}  // namespace beltgrinding

#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Where a ray meets a triangle.
struct TriangleHit {
    std::uint32_t triangle;  ///< its index
    float distance;          ///< along the ray, in lengths of its direction
    Vec3f weights;           ///< barycentric weights of its corners
};

/// Finds the triangles that a ray meets, by a box around each run of consecutive triangles: they
/// lie in grid order, so that a run is a short strip. Made for meshes that move all the time; the
/// boxes of a million samples are renewed faster than a tree is refitted.
class TrianglePicker {
  public:
    /// Boxes anew. Indices must lie within `vertices`.
    void update(const std::vector<Vec3f>& vertices, const std::vector<Triangle>& triangles);
    /// All triangles, seen from either side, that the ray `origin + t direction`, t >= 0, meets.
    std::vector<TriangleHit> pick(const std::vector<Vec3f>& vertices,
                                  const std::vector<Triangle>& triangles, const Vec3f& origin,
                                  const Vec3f& direction) const;

  private:
    std::vector<Eigen::AlignedBox3f> boxes_;
};

}  // namespace beltgrinding

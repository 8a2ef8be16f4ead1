#pragma once

// Private to this room: what samples get from the triangles about them.

#include <array>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/height_field.h"

namespace beltgrinding {

/// Shares of a triangle's area that lie nearest to each corner; for an obtuse one half goes to the
/// obtuse corner. Meyer et al.: Discrete differential-geometry operators (2003), section 3.3.
std::array<double, 3> voronoi_shares(const Vec3& a, const Vec3& b, const Vec3& c);

/// Gives each sample flagged kDegenerate, whose `normal` is zero, the mean of its neighbours'
/// normals; where they have none either, that of its triangles.
void fill_singular_normals(const std::vector<Vec3>& point, const std::vector<std::uint8_t>& flags,
                           const std::vector<Triangle>& triangles, std::vector<Vec3f>& normal);

}  // namespace beltgrinding

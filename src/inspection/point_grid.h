#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Finds points within a fixed distance of a place: points sorted by cubes of that size. Takes 12
/// bytes a point.
class PointGrid {
  public:
    /// Holds the numbers `which` of `points`, both of which must outlive it; `radius` in mm.
    PointGrid(std::span<const Vec3> points, std::vector<std::uint32_t> which, double radius);

    /// Calls visit(number) for the points within the radius of `p`, in a fixed order.
    template <class Visit>
    void near(const Vec3& p, Visit&& visit) const {
        const Cube centre = cube_of(p);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    for (const std::uint32_t i : cell(centre + Cube(x, y, z)))
                        if ((points_[i] - p).squaredNorm() <= radius_ * radius_) visit(i);
    }

    /// Whether any point lies within the radius of `p`.
    bool any_near(const Vec3& p) const;

  private:
    using Cube = Eigen::Matrix<std::int64_t, 3, 1>;
    Cube cube_of(const Vec3& p) const { return (p / radius_).array().floor().cast<std::int64_t>(); }
    static std::uint64_t key(const Cube& cube);
    std::span<const std::uint32_t> cell(const Cube& cube) const;

    std::span<const Vec3> points_;
    std::vector<std::uint32_t> which_;  // by key
    std::vector<std::uint64_t> keys_;   // of which_
    double radius_;
};

}  // namespace beltgrinding

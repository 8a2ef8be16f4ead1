#include "point_grid.h"

#include <algorithm>
#include <utility>

namespace beltgrinding {

namespace {

constexpr double kLeastRadius = 1e-6;  // mm: a part's cubes can then still be counted

}  // namespace

// Cubes far apart may share a key; the distance sorts their points out.
std::uint64_t PointGrid::key(const Cube& cube) {
    constexpr std::uint64_t kBits = (std::uint64_t{1} << 21U) - 1;
    const auto part = [](std::int64_t c) { return static_cast<std::uint64_t>(c) & kBits; };
    return part(cube.x()) << 42U | part(cube.y()) << 21U | part(cube.z());
}

PointGrid::PointGrid(std::span<const Vec3> points, std::vector<std::uint32_t> which, double radius)
    : points_(points), radius_(std::max(radius, kLeastRadius)) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(which.size());
    for (const std::uint32_t i : which) order.emplace_back(key(cube_of(points[i])), i);
    std::sort(order.begin(), order.end());
    which_ = std::move(which);
    keys_.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) std::tie(keys_[k], which_[k]) = order[k];
}

bool PointGrid::any_near(const Vec3& p) const {
    const Cube centre = cube_of(p);
    for (const int x : {0, -1, 1})  // the most likely cube first
        for (const int y : {0, -1, 1})
            for (const int z : {0, -1, 1})
                for (const std::uint32_t i : cell(centre + Cube(x, y, z)))
                    if ((points_[i] - p).squaredNorm() <= radius_ * radius_) return true;
    return false;
}

std::span<const std::uint32_t> PointGrid::cell(const Cube& cube) const {
    const auto [begin, end] = std::equal_range(keys_.begin(), keys_.end(), key(cube));
    return {which_.data() + (begin - keys_.begin()), static_cast<std::size_t>(end - begin)};
}

}  // namespace beltgrinding

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Points by the cubes that they lie in.
class PointHash {
  public:
    using Cube = std::array<std::int32_t, 3>;

    /// `side`: mm, of a cube.
    explicit PointHash(double side) : side_(side) {}

    Cube cube(const Vec3& point) const {
        Cube c;
        for (int k = 0; k < 3; ++k)
            c[static_cast<std::size_t>(k)] =
                static_cast<std::int32_t>(std::floor(point[k] / side_));
        return c;
    }
    void add(std::uint32_t number, const Vec3& point) { cubes_[cube(point)].push_back(number); }
    /// Replaces `found` by all in the cube and in those up to `rings` away.
    void near(const Cube& cube, int rings, std::vector<std::uint32_t>& found) const {
        found.clear();
        for (int i = -rings; i <= rings; ++i)
            for (int j = -rings; j <= rings; ++j)
                for (int k = -rings; k <= rings; ++k) {
                    const auto at = cubes_.find({cube[0] + i, cube[1] + j, cube[2] + k});
                    if (at != cubes_.end())
                        found.insert(found.end(), at->second.begin(), at->second.end());
                }
    }

  private:
    struct Hash {
        std::size_t operator()(const Cube& c) const {
            std::size_t h = 0;
            for (const std::int32_t k : c)
                h = (h ^ static_cast<std::uint32_t>(k)) * 0x9E3779B97F4A7C15ULL, h ^= h >> 32;
            return h;
        }
    };
    double side_;
    std::unordered_map<Cube, std::vector<std::uint32_t>, Hash> cubes_;
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "beltgrinding/height_field.h"

namespace beltgrinding::testing {

/// Adds a rectangle as a face of its own: corner, its two sides, so that first x second is the
/// outer normal, sampled `n` times a side, with its border marked.
inline void add_rectangle(HeightField& field, const Vec3& corner, const Vec3& first,
                          const Vec3& second, std::uint32_t n) {
    const auto base = static_cast<std::uint32_t>(field.size());
    const std::uint32_t face = base == 0 ? 0 : field.face.back() + 1;
    const Vec3 normal = first.cross(second).normalized();
    const double area = first.cross(second).norm() / (n * n);
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const bool border = i == 0 || j == 0 || i == n || j == n;
            const double share = (i % n == 0 ? 0.5 : 1.0) * (j % n == 0 ? 0.5 : 1.0);
            field.point.emplace_back(corner + double(i) / n * first + double(j) / n * second);
            field.normal.emplace_back(normal.cast<float>());
            field.area.push_back(static_cast<float>(share * area));
            field.stock_height.push_back(0.0F);
            field.height.push_back(0.0);
            field.face.push_back(face);
            field.flags.push_back(border ? std::uint8_t{kOnBoundary} : std::uint8_t{0});
            if (i == n || j == n) continue;
            const std::uint32_t a = base + j * (n + 1) + i, b = a + n + 1;
            field.triangles.push_back({a, a + 1, b + 1});
            field.triangles.push_back({a, b + 1, b});
        }
    }
    field.spacing = first.norm() / n;
}

/// The three faces of a cube of `size` mm that meet in its corner at the origin, the cube in the
/// octant of negative coordinates.
inline HeightField cube_corner(double size, std::uint32_t n) {
    HeightField field;
    const Vec3 x(size, 0, 0), y(0, size, 0), z(0, 0, size);
    add_rectangle(field, -x - y, x, y, n);
    add_rectangle(field, -y - z, y, z, n);
    add_rectangle(field, -z - x, z, x, n);
    return field;
}

}  // namespace beltgrinding::testing

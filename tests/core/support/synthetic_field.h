#pragma once

#include <cmath>
#include <functional>

#include "beltgrinding/height_field.h"

namespace beltgrinding::testing {

/// A field over a map of the rectangle [0, length_u] x [0, length_v] (already metric in u and v)
/// with outward normals, trapezoidal areas, boundary flags and triangles, and the given allowance.
inline HeightField mapped_field(double length_u, double length_v, double spacing, double allowance,
                                const std::function<Vec3(double, double)>& point,
                                const std::function<Vec3(double, double)>& normal) {
    const int nu = static_cast<int>(std::lround(length_u / spacing)) + 1;
    const int nv = static_cast<int>(std::lround(length_v / spacing)) + 1;
    const double du = length_u / (nu - 1), dv = length_v / (nv - 1);
    HeightField field;
    field.spacing = spacing;
    field.resize(static_cast<std::size_t>(nu) * static_cast<std::size_t>(nv));
    for (int j = 0; j < nv; ++j) {
        for (int i = 0; i < nu; ++i) {
            const auto s = static_cast<std::size_t>(j * nu + i);
            const bool edge_u = i == 0 || i == nu - 1, edge_v = j == 0 || j == nv - 1;
            field.point[s] = point(i * du, j * dv);
            field.normal[s] = normal(i * du, j * dv).cast<float>();
            field.area[s] =
                static_cast<float>(du * dv * (edge_u ? 0.5 : 1.0) * (edge_v ? 0.5 : 1.0));
            field.flags[s] = edge_u || edge_v ? kOnBoundary : 0;
            field.height[s] = allowance;
            field.stock_height[s] = static_cast<float>(allowance);
            if (i + 1 < nu && j + 1 < nv) {
                const auto a = static_cast<std::uint32_t>(s);
                const auto w = static_cast<std::uint32_t>(nu);
                field.triangles.push_back({a, a + 1, a + w + 1});
                field.triangles.push_back({a, a + w + 1, a + w});
            }
        }
    }
    return field;
}

/// A plate in the x-y plane from the origin, normal +z.
inline HeightField plate(double length_x, double length_y, double spacing, double allowance = 0.0) {
    return mapped_field(
        length_x, length_y, spacing, allowance, [](double u, double v) { return Vec3(u, v, 0.0); },
        [](double, double) { return Vec3(0, 0, 1); });
}

/// A strip of a cylinder about the y axis: `arc` mm long around the top (+z), `length` mm along y.
inline HeightField cylinder(double radius, double arc, double length, double spacing,
                            double allowance = 0.0) {
    const auto normal = [=](double u, double) {
        const double angle = (u - 0.5 * arc) / radius;
        return Vec3(std::sin(angle), 0.0, std::cos(angle));
    };
    return mapped_field(
        arc, length, spacing, allowance,
        [=](double u, double v) { return Vec3(radius * normal(u, v) + Vec3(0, v, -radius)); },
        normal);
}

}  // namespace beltgrinding::testing

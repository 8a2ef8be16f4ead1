#include "sight_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace beltgrinding {
namespace {

struct Mesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
};

/// The meshes must outlive them.
SightLines lines_of(const std::vector<Mesh>& meshes) {
    std::vector<SightLines::Mesh> given;
    Box extents;
    for (const Mesh& mesh : meshes) {
        given.push_back({mesh.vertices, mesh.triangles});
        for (const Vec3& v : mesh.vertices) extents.extend(v);
    }
    return SightLines(given, extents);
}

/// Vertices on a lattice of eighths: for lines along the axes all that is computed is exact, so
/// that lines through edges and corners are as certain as others.
Mesh on_lattice(std::uint32_t count, int flat_axis, std::mt19937& random) {
    std::uniform_int_distribution<int> middle(-80, 80), size(-20, 20);
    Mesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 at = Vec3(middle(random), middle(random), middle(random));
        for (std::uint32_t k = 0; k < 3; ++k) {
            Vec3 corner = at + Vec3(size(random), size(random), size(random));
            if (i % 3 == 0) corner = (corner / 8.0).array().round() * 8.0;  // on lines
            if (flat_axis >= 0) corner[flat_axis] = 0.0;
            mesh.vertices.push_back(corner / 8.0);
        }
        if (i % 7 == 0) mesh.vertices.back() = mesh.vertices[3 * std::size_t{i}];
        if (i % 9 == 0)
            mesh.vertices.back() =
                2.0 * mesh.vertices[3 * std::size_t{i}] - mesh.vertices[3 * std::size_t{i} + 1];
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// Looks at every triangle: it is drawn across the axis, and the line is a point there.
bool hidden_by_any(const std::vector<Mesh>& meshes, const Vec3& point, int axis, double sign,
                   double near) {
    const int across = (axis + 1) % 3, up = (axis + 2) % 3;
    for (const Mesh& mesh : meshes) {
        for (const Triangle& t : mesh.triangles) {
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            const auto turn = [&](const Vec3& p, const Vec3& q) {
                return (q[across] - p[across]) * (point[up] - p[up]) -
                       (q[up] - p[up]) * (point[across] - p[across]);
            };
            const Vec3 weights(turn(b, c), turn(c, a), turn(a, b));
            const double whole = weights.sum();
            if (whole == 0.0 || (weights / whole).minCoeff() < 0.0) continue;
            // (there - point) sign >= near, times the whole
            const double there = weights.dot(Vec3(a[axis], b[axis], c[axis]));
            const double far = sign * (there - whole * point[axis]);
            if (whole > 0.0 ? far >= near * whole : far <= near * whole) return true;
        }
    }
    return false;
}

struct Count {
    std::size_t hidden = 0, free = 0;
};

Count compare(const std::vector<Mesh>& meshes, const std::vector<Vec3>& points) {
    const SightLines lines = lines_of(meshes);
    Count count;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            const SightLines::Way way(sign * Vec3::Unit(axis));
            for (const Vec3& point : points) {
                for (const double near : {0.0, 0.25, 3.0}) {
                    const bool expected = hidden_by_any(meshes, point, axis, sign, near);
                    EXPECT_EQ(lines.hidden(point, way, near), expected)
                        << point.transpose() << ", axis " << axis << ", " << sign << ", " << near;
                    ++(expected ? count.hidden : count.free);
                }
            }
        }
    }
    return count;
}

std::vector<Vec3> lattice_points(std::size_t count, std::mt19937& random) {
    std::uniform_int_distribution<int> place(-100, 100);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 p(place(random), place(random), place(random));
        if (i % 2 == 0) p = (p / 8.0).array().round() * 8.0;  // on edges and corners
        points.emplace_back(p / 8.0);
    }
    return points;
}

TEST(SightLines, AreHiddenByWhatEveryTriangleByItselfWouldHide) {
    std::mt19937 random(11);
    // One triangle; a leaf's and a node's worth, and one more; many levels.
    for (const std::uint32_t size : {1U, 8U, 9U, 64U, 65U, 600U}) {
        const std::vector<Mesh> meshes{
            {}, on_lattice(size, -1, random), {{{90, 0, 0}}, {}}, on_lattice(size / 2, -1, random)};
        const Count count = compare(meshes, lattice_points(300, random));
        EXPECT_GE(count.hidden, size / 2);
        EXPECT_GT(count.free, 1000U);
    }
}

TEST(SightLines, AreHiddenByFlatParts) {
    std::mt19937 random(12);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Vec3> points = lattice_points(60, random);
        for (std::size_t i = 0; i < points.size(); i += 3) points[i][axis] = 0.0;
        const Count count = compare({on_lattice(100, axis, random)}, points);
        EXPECT_GT(count.hidden, 20U);
        EXPECT_GT(count.free, 20U);
    }
    // All in one place, as many as there are.
    Mesh pile{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {}};
    pile.triangles.assign(300, {0, 1, 2});
    const Count count =
        compare({pile}, {{0.5, 0.5, -1}, {1, 1, -1}, {0, 0, -4}, {2, 0, 4}, {1.5, 1, 1}});
    EXPECT_EQ(count.hidden, 10U);  // the first two 1 mm away, the next two 4 mm
}

TEST(SightLines, AreFreeWhereNothingHasAnArea) {
    const std::vector<Mesh> nothing{{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 4, 0}},
                                     {{0, 1, 2}, {0, 0, 0}, {1, 1, 3}, {3, 1, 3}}}};
    const SightLines lines = lines_of(nothing);
    for (const Vec3& way : {Vec3(1, 1, 1), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, 1, 0)})
        EXPECT_FALSE(lines.hidden({0, 0, 0}, SightLines::Way(way.normalized()), 0.0));
}

/// A closed ball of triangles around the origin.
Mesh ball(double radius, std::uint32_t around) {
    Mesh mesh{{{0, 0, radius}, {0, 0, -radius}}, {}};
    const std::uint32_t rings = around / 2;
    const auto at = [&](std::uint32_t ring, std::uint32_t k) {
        return 2 + (ring - 1) * around + k % around;
    };
    for (std::uint32_t ring = 1; ring < rings; ++ring) {
        const double polar = std::numbers::pi * ring / rings;
        for (std::uint32_t k = 0; k < around; ++k) {
            const double turn = 2.0 * std::numbers::pi * k / around;
            mesh.vertices.push_back(radius * Vec3(std::sin(polar) * std::cos(turn),
                                                  std::sin(polar) * std::sin(turn),
                                                  std::cos(polar)));
        }
    }
    for (std::uint32_t k = 0; k < around; ++k) {
        mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
        mesh.triangles.push_back({1, at(rings - 1, k + 1), at(rings - 1, k)});
        for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
            mesh.triangles.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
            mesh.triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
        }
    }
    return mesh;
}

TEST(SightLines, FindNoGapInAClosedShell) {
    const std::vector<Mesh> shells{ball(7.3, 30)};
    const Mesh& shell = shells.front();
    const SightLines lines = lines_of(shells);
    std::mt19937 random(13);
    std::uniform_real_distribution<double> place(-3.0, 3.0), share(0.0, 1.0);
    std::size_t free = 0;
    for (int k = 0; k < 20; ++k) {
        const Vec3 point(place(random), place(random), place(random));
        for (const Triangle& t : shell.triangles) {
            for (std::size_t i = 0; i < 3; ++i) {  // through a corner, and through an edge
                const Vec3 &a = shell.vertices[t[i]], &b = shell.vertices[t[(i + 1) % 3]];
                for (const Vec3& to : {a, Vec3(a + share(random) * (b - a))}) {
                    const SightLines::Way way((to - point).normalized());
                    free += lines.hidden(point, way, 1e-3) ? 0 : 1;
                }
            }
        }
    }
    EXPECT_EQ(free, 0U);
}

TEST(SightLines, KeepTheirPrecisionFromFarAway) {
    const std::vector<Mesh> shells{ball(5.0, 24)};
    const SightLines lines = lines_of(shells);
    std::mt19937 random(14);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    std::size_t compared = 0;
    for (int k = 0; k < 4000; ++k) {
        const Vec3 way = Vec3(part(random), part(random), part(random)).normalized();
        const Vec3 side = way.unitOrthogonal();
        // 24 facets around a ball of 5 mm: what passes at 4.9 mm meets it, at 5.001 mm does not.
        const bool beside = k % 2 == 0;
        const Vec3 through = (beside ? 5.001 : 4.85) * side;
        for (const double away : {20.0, 1e4, 1e7}) {
            ++compared;
            EXPECT_EQ(lines.hidden(through - away * way, SightLines::Way(way), 1.0), !beside)
                << away;
            EXPECT_FALSE(lines.hidden(through + away * way, SightLines::Way(way), 1.0)) << away;
            EXPECT_FALSE(lines.hidden(through - away * way, SightLines::Way(way), away + 6.0));
        }
    }
    EXPECT_EQ(compared, 12000U);
}

}  // namespace
}  // namespace beltgrinding

// Rays at sharp edges: one field over both faces.
#include "heightfield/edge_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/sheets.h"

namespace beltgrinding {
namespace {

using testing::add_rectangle;

/// Two faces of 10 mm whose normals differ by `turn` rad, the edge along y, the bisector up.
HeightField roof(double turn, std::uint32_t n = 20) {
    const double c = std::cos(0.5 * turn), s = std::sin(0.5 * turn);
    HeightField field;
    const Vec3 y(0, 10, 0), left(-10 * c, 0, -10 * s), right(10 * c, 0, -10 * s);
    add_rectangle(field, Vec3(0, 10, 0) - y + left, -left, y, n);
    add_rectangle(field, Vec3::Zero(), right, y, n);
    return field;
}

TEST(EdgeRays, OnAnEdgeAreTheBisectorWithAPartOfOneAlongTheNormal) {
    for (const double degrees : {40.0, 90.0, 120.0, 150.0}) {
        const double turn = degrees * std::numbers::pi / 180.0;
        HeightField field = roof(turn);
        lean_at_edges(field);
        ASSERT_EQ(field.rays.size(), field.size());
        double on_edge = 0.0;
        const double reach = std::max(2.0 * field.spacing, 0.5 * turn * field.depth);
        for (std::size_t i = 0; i < field.size(); ++i) {
            const double distance = std::hypot(field.point[i].x(), field.point[i].z());
            const Vec3f &ray = field.rays[i], &normal = field.normal[i];
            EXPECT_NEAR(ray.dot(normal), 1.0, 1e-5);
            EXPECT_NEAR(ray.y(), 0.0, 1e-6);
            const double lean = std::acos(std::min(1.0, 1.0 / double(ray.norm())));
            const double wanted = 0.5 * turn * std::max(0.0, 1.0 - distance / reach);
            EXPECT_NEAR(lean, wanted, 1e-3) << degrees << " " << distance;
            if (distance > 0.0) continue;
            EXPECT_NEAR((ray.normalized() - Vec3f::UnitZ()).norm(), 0.0, 1e-5);
            on_edge = lean;
        }
        EXPECT_NEAR(on_edge, 0.5 * turn, 1e-5);
    }
}

TEST(EdgeRays, DoNotCrossDownToTheDepth) {
    HeightField field = roof(0.5 * std::numbers::pi, 100);
    lean_at_edges(field);
    // Of the right face's samples along x, the nearer one to the edge stays the nearer one.
    for (std::uint32_t i = 101 * 101; i < 101 * 101 + 100; ++i) {
        const Vec3 a = field.point[i] - 0.99 * field.ray(i).cast<double>().normalized();
        const Vec3 b = field.point[i + 1] - 0.99 * field.ray(i + 1).cast<double>().normalized();
        const Vec3 along = field.point[i + 1] - field.point[i];
        EXPECT_GT((b - a).dot(along), 0.0) << i;
    }
}

TEST(EdgeRays, AreTheNormalsWhereNothingIsSharpAndConvex) {
    for (const double degrees : {0.0, 20.0, 175.0, -90.0}) {
        HeightField field = roof(degrees * std::numbers::pi / 180.0);
        lean_at_edges(field);
        EXPECT_TRUE(field.rays.empty()) << degrees;
        EXPECT_EQ(field.ray(3), field.normal[3]);
        EXPECT_FALSE(field.leans(3));
    }
}

TEST(EdgeRays, OfACornerAreTheSameOnAllItsFaces) {
    HeightField field = testing::cube_corner(10.0, 20);
    lean_at_edges(field);
    int corners = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if ((field.point[i] - field.point[j]).norm() > 1e-9) continue;
            EXPECT_NEAR((field.rays[i] - field.rays[j]).norm(), 0.0, 1e-5);
        }
        if (field.point[i].norm() > 1e-9) continue;
        ++corners;
        EXPECT_NEAR((field.rays[i] - Vec3f(1, 1, 1)).norm(), 0.0, 1e-5);
    }
    EXPECT_EQ(corners, 3);
}

TEST(EdgeRays, KnowTheirEdgesDistance) {
    HeightField field = roof(2.0);
    EXPECT_TRUE(edge_distances(field).empty());
    lean_at_edges(field);
    const std::vector<float> found = edge_distances(field);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const double distance = std::hypot(field.point[i].x(), field.point[i].z());
        if (field.leans(i)) {
            EXPECT_NEAR(found[i], distance, 1e-5);
        } else {
            EXPECT_GT(found[i], 0.9);
        }
    }
}

TEST(EdgeRays, SegmentsAndFilesHaveThem) {
    HeightField field = roof(2.0);
    lean_at_edges(field);
    field.height[20] = -0.1;  // on the edge
    EXPECT_NEAR(field.top(20).x(), 0.0, 1e-6);
    EXPECT_NEAR(field.top(20).z(), -0.1 / std::cos(1.0), 1e-6);
    EXPECT_NEAR(field.bottom(20).z(), -1.0 / std::cos(1.0), 1e-6);
    const HeightField read = read_hdf5_image(hdf5_image(field, ""), "a");
    EXPECT_EQ(read.rays, field.rays);
}

}  // namespace
}  // namespace beltgrinding

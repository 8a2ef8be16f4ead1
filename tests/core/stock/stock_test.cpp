#include "beltgrinding/stock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beltgrinding/error.h"
#include "heightfield/edge_rays.h"
#include "support/sheets.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// An axis-parallel box, outward.
TriangleMesh box(const Vec3f& low, const Vec3f& high) {
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) {
        mesh.vertices.push_back({(k & 1) != 0 ? high.x() : low.x(),
                                 (k & 2) != 0 ? high.y() : low.y(),
                                 (k & 4) != 0 ? high.z() : low.z()});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

HeightField plate_at(double z) {
    HeightField field = testing::plate(20.0, 10.0, 0.5);
    for (Vec3& p : field.point) p += Vec3(5.0, 5.0, z);
    return field;
}

std::string error_of(HeightField field, const TriangleMesh& mesh) {
    try {
        apply_mesh(field, mesh, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Stock, AllowanceIsEverywhere) {
    HeightField field = testing::plate(10.0, 10.0, 1.0);
    const StockReport report = apply_allowance(field, 0.4);
    EXPECT_NEAR(report.volume, 40.0, 1e-5);
    for (const double h : field.height) EXPECT_EQ(h, 0.4);
    EXPECT_EQ(apply_allowance(field, -0.1).defective, field.size());
    EXPECT_THROW(apply_allowance(field, std::nan("")), InputError);
}

TEST(Stock, MoreOfItIsAddedWhereItIsKnown) {
    HeightField field = testing::plate(10.0, 10.0, 1.0);
    apply_allowance(field, 0.4);
    field.flags[3] |= kMissed;
    std::vector<double> more(field.size(), 0.25);
    more[0] = -0.5;
    const StockReport report = add_stock(field, more);
    EXPECT_EQ(report.missed, 1u);
    EXPECT_EQ(report.defective, 1u);
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_EQ(report.warnings[0].code, "stock.below_design");
    EXPECT_NEAR(field.height[0], -0.1, 1e-12);
    EXPECT_NE(field.flags[0] & kDefective, 0);
    EXPECT_EQ(field.height[3], 0.4);
    EXPECT_NEAR(field.height[1], 0.65, 1e-12);
    EXPECT_NEAR(field.stock_height[1], 0.65, 1e-6);
    more[0] = 0.5;
    EXPECT_EQ(add_stock(field, more).defective, 0u);
    EXPECT_EQ(field.flags[0] & kDefective, 0);
    more[0] = std::nan("");
    EXPECT_THROW(add_stock(field, more), InputError);
    more.pop_back();
    EXPECT_THROW(add_stock(field, more), InputError);
}

TEST(Stock, SealedSolidGivesExactHeights) {
    HeightField field = plate_at(9.4);
    const StockReport report = apply_mesh(field, box({0, 0, 0}, {30, 20, 10}), {});
    EXPECT_EQ(report.missed, 0u);
    EXPECT_EQ(report.defective, 0u);
    for (const double h : field.height) EXPECT_NEAR(h, 0.6, 1e-5);
    EXPECT_NEAR(report.volume, 0.6 * 200.0, 1e-2);
}

TEST(Stock, WhatARunLeftIsTheNextStock) {
    HeightField left = testing::plate(20.0, 10.0, 0.5);
    for (std::size_t i = 0; i < left.size(); ++i)
        left.height[i] = 0.1 + 0.02 * left.point[i].x() - 0.01 * left.point[i].y();
    left.flags[0] |= kMissed | kDefective;
    FinishTrace& finish = left.finish;
    finish.settled.assign(left.size(), 1.5F);
    finish.unknown.assign(left.size(), 0.0F);
    finish.lay.assign(left.size(), Vec3f::UnitX());
    finish.crossing.assign(left.size(), std::nanf(""));
    finish.passes.assign(left.size(), 3);
    finish.motion.assign(left.size(), 7);
    finish.outside.assign(left.size(), FinishTrace::kInside);

    HeightField same = testing::plate(20.0, 10.0, 0.5);
    const StockReport report = apply_left(same, left, true);
    EXPECT_EQ(report.missed, 1u);
    EXPECT_NE(same.flags[0] & kMissed, 0);
    for (std::size_t i = 1; i < same.size(); ++i) {
        ASSERT_NEAR(same.height[i], left.height[i], 1e-12) << i;
        ASSERT_FLOAT_EQ(same.finish.roughness(i), 1.5F);
        ASSERT_EQ(same.finish.passes[i], 3u);
        ASSERT_EQ(same.finish.motion[i], FinishTrace::kNever);  // another run's
    }
    EXPECT_NO_THROW(same.validate());

    HeightField finer = testing::plate(20.0, 10.0, 0.37);
    apply_left(finer, left);
    EXPECT_TRUE(finer.finish.empty());
    for (std::size_t i = 0; i < finer.size(); ++i) {
        const Vec3& p = finer.point[i];
        const bool by_the_missed = (p - left.point[0]).norm() < 1.0;
        const bool outside = std::abs(p.x() - 10.0) > 9.7 || std::abs(p.y() - 5.0) > 4.7;
        if (by_the_missed || outside) continue;
        ASSERT_NEAR(finer.height[i], 0.1 + 0.02 * p.x() - 0.01 * p.y(), 1e-9) << p.transpose();
    }

    HeightField elsewhere = plate_at(0.0);
    for (Vec3& p : elsewhere.point) p += Vec3(5.0, 5.0, 0.0);
    EXPECT_THROW(apply_left(elsewhere, left), InputError);
    HeightField other = testing::plate(20.0, 10.0, 0.5);
    for (std::uint32_t& face : other.face) face = 1;
    EXPECT_THROW(apply_left(other, left), InputError);
}

TEST(Stock, StockBelowTheDesignIsDefective) {
    HeightField field = plate_at(10.3);
    const StockReport report = apply_mesh(field, box({0, 0, 0}, {30, 20, 10}), {});
    EXPECT_EQ(report.defective, field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_NEAR(field.height[i], -0.3, 1e-5);
        EXPECT_TRUE(field.flags[i] & kDefective);
    }
}

// A box that lies above the design with a gap below it is no stock of this surface.
TEST(Stock, MaterialBeyondAGapDoesNotCount) {
    HeightField field = plate_at(-2.0);
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    EXPECT_NE(error_of(field, mesh).find("no ray meets"), std::string::npos);
    const TriangleMesh below = box({0, 0, -10}, {30, 20, -2.5});
    for (Triangle t : below.triangles) {
        for (auto& v : t) v += 8;
        mesh.triangles.push_back(t);
    }
    mesh.vertices.insert(mesh.vertices.end(), below.vertices.begin(), below.vertices.end());
    apply_mesh(field, mesh, {});
    for (const double h : field.height) EXPECT_NEAR(h, -0.5, 1e-5);
}

TEST(Stock, AScanWithAHoleAndDoubledSurfaceIsSound) {
    TriangleMesh scan;  // an open sheet at z = 10 over x < 15, scanned twice, 0.02 mm apart
    for (const float z : {10.0F, 10.02F}) {
        const auto base = static_cast<std::uint32_t>(scan.vertices.size());
        scan.vertices.insert(scan.vertices.end(), {{0, 0, z}, {15, 0, z}, {15, 20, z}, {0, 20, z}});
        scan.triangles.push_back({base, base + 1, base + 2});
        scan.triangles.push_back({base, base + 2, base + 3});
    }
    HeightField field = plate_at(9.5);
    const StockReport report = apply_mesh(field, scan, {});
    std::size_t missed = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field.point[i].x() > 15.01) {
            EXPECT_TRUE(field.flags[i] & kMissed);
            EXPECT_EQ(field.height[i], 0.0);
            ++missed;
        } else if (field.point[i].x() < 14.99) {
            EXPECT_NEAR(field.height[i], 0.52, 1e-5);
        }
    }
    EXPECT_GE(report.missed, missed);
    EXPECT_FALSE(report.warnings.empty());
}

// The wall of a step under the sample: nearly along the ray, above or below the design.
TEST(Stock, AGrazedWallIsNoSurfaceIfToldSo) {
    for (const bool above : {true, false}) {
        HeightField field = plate_at(above ? 9.5F : 10.5F);
        const auto x = static_cast<float>(field.point[field.size() / 2].x());
        TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
        const float low = above ? 9.5F : 10.0F;
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {{x - 0.01F, 0, low},
                                                   {x - 0.01F, 20, low},
                                                   {x + 0.01F, 20, low + 0.5F},
                                                   {x + 0.01F, 0, low + 0.5F}});
        for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}}) {
            mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
            mesh.triangles.push_back({base + t[0], base + t[2], base + t[1]});
        }
        const double height = above ? 0.5 : -0.5;
        StockOptions options;
        options.least_cosine = 0.1;
        apply_mesh(field, mesh, options);
        for (const double h : field.height) EXPECT_NEAR(h, height, 1e-5);
        apply_mesh(field, mesh, {});
        EXPECT_GT(std::abs(field.height[field.size() / 2] - height), 0.1);
    }
    HeightField field = plate_at(9.5);
    StockOptions options;
    options.least_cosine = 1.0;
    EXPECT_THROW(apply_mesh(field, box({0, 0, 0}, {30, 20, 10}), options), InputError);
}

TEST(Stock, SearchDistancesLimitTheRays) {
    HeightField field = plate_at(2.0);
    StockOptions options;
    options.search_above = 5.0;
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    EXPECT_THROW(apply_mesh(field, mesh, options), InputError);
    options.search_above = 9.0;
    EXPECT_EQ(apply_mesh(field, mesh, options).missed, 0u);
}

TEST(Stock, FarFromTheOriginNothingIsLost) {
    HeightField field = plate_at(9.4);
    const Vec3 shift(123456.0, -65432.0, 0.0);
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    for (Vec3& p : field.point) p += shift;
    for (Vec3f& v : mesh.vertices) v += shift.cast<float>();
    apply_mesh(field, mesh, {});
    for (const double h : field.height) EXPECT_NEAR(h, 0.6, 1e-5);
}

TEST(Stock, SaysWhichUnitWouldFit) {
    TriangleMesh metres = box({0, 0, 0}, {30, 20, 10});
    for (Vec3f& v : metres.vertices) v *= 0.001F;
    EXPECT_NE(error_of(plate_at(9.4), metres).find("metres"), std::string::npos);
    EXPECT_NE(error_of(plate_at(9.4), box({500, 0, 0}, {530, 20, 10})).find("apart"),
              std::string::npos);
}

TEST(Stock, RefusesBrokenMeshes) {
    const HeightField field = plate_at(9.0);
    EXPECT_NE(error_of(field, {}).find("no triangle"), std::string::npos);
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    mesh.vertices[3].x() = std::nanf("");
    EXPECT_NE(error_of(field, mesh).find("vertex 3"), std::string::npos);
    mesh = box({0, 0, 0}, {30, 20, 10});
    mesh.triangles[2][1] = 99;
    EXPECT_NE(error_of(field, mesh).find("triangle 2"), std::string::npos);
}

/// Three faces of a cube that meet in the origin, the cube where all coordinates are negative.
HeightField corner_with_rays() {
    HeightField field = testing::cube_corner(10.0, 40);
    lean_at_edges(field);
    return field;
}

TEST(Allowance, IsALayerOfOneThicknessRoundSharpEdgesToo) {
    HeightField field = corner_with_rays();
    for (const double thickness : {0.05, 0.3}) {
        apply_allowance(field, thickness);
        std::size_t round = 0;
        for (std::size_t i = 0; i < field.size(); ++i) {
            const Vec3 top = field.top(i), beyond = top.cwiseMax(0.0);
            const int sides =
                int(beyond.x() > 1e-9) + int(beyond.y() > 1e-9) + int(beyond.z() > 1e-9);
            round += sides > 1 ? 1 : 0;
            // Where three faces meet the layer is known to 15 %.
            const double close = field.point[i].maxCoeff() - field.point[i].minCoeff() < 2.0;
            EXPECT_NEAR(beyond.norm(), thickness, close ? 0.15 * thickness : 1e-5) << i;
        }
        EXPECT_GT(round, 100U);
    }
    apply_allowance(field, -0.1);
    for (std::size_t i = 0; i < field.size(); ++i) EXPECT_DOUBLE_EQ(field.height[i], -0.1);
}

TEST(MeshStock, IsMetAlongRaysThatLean) {
    HeightField field = corner_with_rays();
    const double layer = 0.4;
    apply_mesh(field, box(Vec3f(-12, -12, -12), Vec3f(0.4F, 0.4F, 0.4F)), {});
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_EQ(field.flags[i] & kMissed, 0);
        EXPECT_NEAR(field.top(i).maxCoeff(), layer, 1e-4) << i;  // on the box
        EXPECT_NEAR(field.height[i], layer, 1e-4) << i;  // square to its face, wherever it leans
    }
}

}  // namespace
}  // namespace beltgrinding

#include "beltgrinding/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "beltgrinding/deviation.h"
#include "beltgrinding/error.h"
#include "inspection/zones.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr Tolerance kBand{-0.05, 0.1};

/// Two fields in one, the second's face numbered 1.
HeightField joined(HeightField field, const HeightField& other) {
    const auto base = static_cast<std::uint32_t>(field.size());
    for (std::size_t i = 0; i < other.size(); ++i) {
        field.point.push_back(other.point[i]);
        field.normal.push_back(other.normal[i]);
        field.area.push_back(other.area[i]);
        field.stock_height.push_back(other.stock_height[i]);
        field.height.push_back(other.height[i]);
        field.face.push_back(1);
        field.flags.push_back(other.flags[i]);
    }
    for (const Triangle& t : other.triangles) {
        field.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    }
    return field;
}

/// A bump on a plate: h = peak (1 - (r / radius)^2) within the radius around (x, y).
void bump(HeightField& field, double x, double y, double radius, double peak) {
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3& p = field.point[i];
        const double q = (std::pow(p.x() - x, 2) + std::pow(p.y() - y, 2)) / (radius * radius);
        if (q < 1.0) field.height[i] += peak * (1.0 - q);
    }
}

// 0.3 mm of stock is a little more in single precision.
TEST(Verdict, WhereNothingIsGroundNothingIsRemoved) {
    const HeightField field = testing::plate(60.0, 40.0, 0.2, 0.3);
    const Verdict verdict = judge(field, {}, kBand);
    EXPECT_EQ(verdict.whole.removed_volume, 0.0);
    EXPECT_EQ(deviation_statistics(field, kBand).removed_volume, 0.0);
    EXPECT_NEAR(verdict.whole.stock_volume, 60.0 * 40.0 * 0.3, 1e-2);
}

TEST(Verdict, AMotionThatGroundAllOfAClusterHasAllOfIt) {
    HeightField field = testing::plate(60.0, 40.0, 0.2, 0.3);
    field.trace.reset(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        field.area[i] *= 1.0F + 0.1F * static_cast<float>(std::sin(static_cast<double>(i)));
        field.trace.first[i] = field.trace.last[i] = field.trace.dominant[i] = 3;
    }
    const Verdict verdict = judge(field, {}, kBand);
    ASSERT_EQ(verdict.clusters.size(), 1u);
    EXPECT_EQ(verdict.clusters[0].motions.at(0).share, 1.0);
}

TEST(Verdict, ABumpAndAGougeAreTheClustersThatTheyAre) {
    HeightField field = testing::plate(60.0, 40.0, 0.2);
    bump(field, 20.0, 20.0, 8.0, 0.3);
    bump(field, 45.0, 15.0, 5.0, -0.2);
    const Verdict verdict = judge(field, {}, kBand);
    EXPECT_FALSE(verdict.whole.passed());
    ASSERT_EQ(verdict.clusters.size(), 2u);
    // h > u within r = R sqrt(1 - u / peak): area and volume beyond in closed form.
    const double above = M_PI * 64.0 * (1.0 - 0.1 / 0.3), below = M_PI * 25.0 * (1.0 - 0.05 / 0.2);
    const Cluster& high = verdict.clusters[0];
    const Cluster& low = verdict.clusters[1];
    EXPECT_TRUE(high.above);
    EXPECT_FALSE(low.above);
    EXPECT_NEAR(high.area, above, 0.01 * above);
    EXPECT_NEAR(low.area, below, 0.01 * below);
    EXPECT_NEAR(high.volume, 0.5 * 0.2 * above, 0.01 * above * 0.1);
    EXPECT_NEAR(low.volume, 0.5 * 0.15 * below, 0.01 * below * 0.1);
    EXPECT_NEAR((high.centroid - Vec3(20, 20, 0)).norm(), 0.0, 0.05);
    EXPECT_NEAR(high.extent, 2.0 * 8.0 * std::sqrt(2.0 / 3.0), 0.4);
    EXPECT_NEAR(high.width, high.extent, 0.4);
    EXPECT_NEAR(low.worst.value, -0.2, 1e-3);
    EXPECT_NEAR(low.worst.beyond, 0.15, 1e-3);
    EXPECT_EQ(low.worst.limit, -0.05);
    EXPECT_NEAR((field.point[high.worst.sample] - Vec3(20, 20, 0)).norm(), 0.0, 0.2);
    EXPECT_NEAR(verdict.whole.above_area, above, 0.01 * above);
    EXPECT_NEAR(verdict.whole.below_area, below, 0.01 * below);
    EXPECT_NEAR(verdict.whole.excess_volume, 0.5 * 0.3 * M_PI * 64.0, 0.2);
    EXPECT_NEAR(verdict.whole.gouge_volume, 0.5 * 0.2 * M_PI * 25.0, 0.1);
    ASSERT_TRUE(verdict.whole.worst);
    EXPECT_NEAR(verdict.whole.worst->beyond, 0.2, 1e-3);  // the bump, not the gouge
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_EQ(verdict.cluster[i] != Verdict::kNone,
                  field.height[i] > 0.1 || field.height[i] < -0.05);
    }
}

TEST(Verdict, ExcessAndGougeSideBySideStayApart) {
    HeightField field = testing::plate(20.0, 10.0, 0.5);
    for (std::size_t i = 0; i < field.size(); ++i) {
        field.height[i] = field.point[i].x() < 10.1 ? 0.2 : -0.2;
    }
    const Verdict verdict = judge(field, {}, kBand);
    ASSERT_EQ(verdict.clusters.size(), 2u);
    EXPECT_NE(verdict.clusters[0].above, verdict.clusters[1].above);
    EXPECT_NEAR(verdict.clusters[0].area + verdict.clusters[1].area, 200.0, 1e-3);
}

TEST(Verdict, AClusterGoesOverTheBorderBetweenFacesAndNotOverAGap) {
    for (const double gap : {0.0, 2.0}) {
        // The other face has another spacing of its samples along the common edge.
        HeightField other = testing::plate(10.0, 10.0, 0.47, 0.2);
        for (Vec3& p : other.point) p.x() += 10.0 + gap;
        const HeightField field = joined(testing::plate(10.0, 10.0, 0.5, 0.2), other);
        const Verdict verdict = judge(field, {}, kBand);
        ASSERT_EQ(verdict.clusters.size(), gap == 0.0 ? 1u : 2u);
        if (gap == 0.0) {
            EXPECT_EQ(verdict.clusters[0].faces, (std::vector<std::uint32_t>{0, 1}));
            EXPECT_NEAR(verdict.clusters[0].area, 200.0, 1e-3);
        }
        ASSERT_EQ(verdict.faces.size(), 2u);
        EXPECT_NEAR(verdict.faces[1].above_area, 100.0, 1e-3);
    }
}

TEST(Verdict, LaterZonesOverrideEarlierOnes) {
    HeightField other = testing::plate(10.0, 10.0, 0.5, 0.2);
    for (Vec3& p : other.point) p.x() += 10.0;
    const HeightField field = joined(testing::plate(10.0, 10.0, 0.5, 0.2), other);
    const ToleranceZone all{{0.0, 0.15}, {}, 0.0, {}}, second{{0.0, 0.3}, {1}, 0.0, {}};
    const Verdict first = judge(field, {all, second}, kBand);
    EXPECT_FALSE(first.faces[0].passed());
    EXPECT_TRUE(first.faces[1].passed());
    EXPECT_FALSE(first.zones[0].passed());
    EXPECT_TRUE(first.zones[1].passed());
    EXPECT_EQ(first.zones[2].samples, 0u);
    EXPECT_FALSE(first.zones[2].passed());
    ASSERT_TRUE(first.zones[1].worst);
    EXPECT_NEAR(first.zones[1].worst->beyond, -0.1, 1e-9);
    const Verdict turned = judge(field, {second, all}, kBand);
    EXPECT_FALSE(turned.faces[1].passed());
    EXPECT_THROW(judge(field, {{{0.2, 0.1}, {}, 0.0, {}}}, kBand), InputError);
    EXPECT_THROW(judge(field, {{{0.0, 0.1}, {}, -1.0, {}}}, kBand), InputError);
    EXPECT_THROW(judge(field, {}, {0.0, NAN}), InputError);
}

TEST(Verdict, WhatWasMissedIsCountedAndNeverJudged) {
    HeightField field = testing::plate(10.0, 10.0, 0.5, 0.02);
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field.point[i].x() < 4.9) {
            field.flags[i] |= kMissed;
            field.height[i] = 0.0;
        }
        if (field.point[i].x() > 9.1) field.flags[i] |= kDefective;
    }
    Verdict verdict = judge(field, {}, {0.01, 0.05});
    EXPECT_TRUE(verdict.whole.passed());
    EXPECT_TRUE(verdict.clusters.empty());
    EXPECT_EQ(verdict.whole.missed, 210u);
    EXPECT_EQ(verdict.whole.defective, 42u);
    EXPECT_NEAR(verdict.whole.missed_area, 47.5, 1e-3);
    EXPECT_NEAR(verdict.whole.mean, 0.02, 1e-9);
    for (std::uint8_t& flags : field.flags) flags |= kMissed;
    verdict = judge(field, {}, {0.01, 0.05});
    EXPECT_FALSE(verdict.whole.worst);
    EXPECT_FALSE(verdict.whole.passed());
}

TEST(Verdict, AGougesMotionsAndWhatTheWheelNeverTouched) {
    HeightField field = testing::plate(40.0, 20.0, 0.5, 0.2);
    field.trace.reset(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        const double x = field.point[i].x();
        if (x < 20.1) {  // ground too deep by motion 3 on a quarter, by motion 8 on the rest
            const std::uint32_t motion = x < 5.1 ? 3 : 8;
            field.trace.first[i] = 1;
            field.trace.dominant[i] = motion;
            field.trace.last[i] = 9;
            field.trace.dominant_depth[i] = motion == 3 ? 0.3F : 0.25F;
            field.trace.peak_pressure[i] = 0.1F;
            field.height[i] = -0.2;
        } else if (x < 30.1) {
            field.trace.peak_pressure[i] = 0.1F;  // touched without effect
        }
    }
    const Verdict verdict = judge(field, {}, kBand);
    ASSERT_EQ(verdict.clusters.size(), 2u);
    const Cluster& low = verdict.clusters[verdict.clusters[0].above ? 1 : 0];
    const Cluster& high = verdict.clusters[verdict.clusters[0].above ? 0 : 1];
    ASSERT_EQ(low.motions.size(), 2u);
    EXPECT_EQ(low.motions[0].motion, 8u);
    EXPECT_NEAR(low.motions[0].share, 0.75, 0.02);
    EXPECT_NEAR(low.motions[0].depth, 0.25, 1e-6);
    EXPECT_EQ(low.motions[1].motion, 3u);
    EXPECT_EQ(low.untouched_area, 0.0);
    EXPECT_TRUE(high.motions.empty());
    EXPECT_NEAR(high.untouched_area, 195.0, 6.0);
    EXPECT_NEAR(verdict.whole.untouched_area, high.untouched_area, 1e-6);
}

TEST(Zones, TheCurvatureOfACylinderASphereAndASaddle) {
    for (const double radius : {2.0, 10.0}) {
        const HeightField field = testing::cylinder(radius, 0.8 * radius * M_PI, 10.0, 0.2);
        for (const float k : convex_curvature(field)) EXPECT_NEAR(k, 1.0 / radius, 0.02 / radius);
        HeightField concave = field;
        for (Vec3f& n : concave.normal) n = -n;
        std::vector<Triangle> turned = concave.triangles.unpacked();
        for (Triangle& t : turned) std::swap(t[1], t[2]);
        concave.triangles = PackedTriangles(turned);
        for (const float k : convex_curvature(concave)) EXPECT_NEAR(k, 0.0, 0.02 / radius);
    }
    // A torus: outside convex in both directions, inside the larger radius is concave.
    const double ring = 20.0, tube = 3.0;
    const auto normal = [=](double u, double v) {
        const double a = u / ring, b = v / tube;
        return Vec3(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
    };
    const HeightField torus = testing::mapped_field(
        ring, 2.0 * M_PI * tube, 0.2, 0.0,
        [=](double u, double v) {
            return Vec3(ring * Vec3(std::cos(u / ring), std::sin(u / ring), 0.0) +
                        tube * normal(u, v));
        },
        normal);
    for (const float k : convex_curvature(torus)) EXPECT_NEAR(k, 1.0 / tube, 0.03 / tube);
}

/// A box's top and one side that meet in an edge along y; `convex` or as in a groove.
HeightField corner(bool convex) {
    HeightField side = testing::mapped_field(
        10.0, 20.0, 0.47, 0.0,
        [=](double u, double v) { return Vec3(convex ? Vec3(10, v, -u) : Vec3(10, 20 - v, u)); },
        [=](double, double) { return Vec3(convex ? 1 : -1, 0, 0); });
    return joined(testing::plate(10.0, 20.0, 0.5), side);
}

TEST(Zones, AnEdgeZoneHoldsRoundAndSharpConvexEdges) {
    HeightField field = corner(true);
    const std::vector<std::uint32_t> zone = zone_of_samples(field, {{kBand, {0}, 2.1, {}}});
    for (std::size_t i = 0; i < field.size(); ++i) {
        const bool near = field.face[i] == 0 && field.point[i].x() > 7.8;
        EXPECT_EQ(zone[i] == 0, near) << field.point[i].transpose();
    }
    for (const double radius : {1e-300, 1e300}) {  // absurd, but no harm
        const std::vector<std::uint32_t> all = zone_of_samples(field, {{kBand, {}, radius, {}}});
        const auto inside = std::count(all.begin(), all.end(), 0U);
        if (radius > 1.0) {
            EXPECT_EQ(static_cast<std::size_t>(inside), field.size());
        } else {
            EXPECT_LT(inside, 100);  // the border itself
        }
    }
    for (const std::uint32_t z : zone_of_samples(corner(false), {{kBand, {}, 2.1, {}}})) {
        EXPECT_EQ(z, 1u);
    }
    // One face all around an aerofoil of a sort: circles of 3 and 1 mm, 20 mm apart, and tangents.
    const double apart = 20.0, slope = std::asin(2.0 / apart), flat = apart * std::cos(slope);
    const double small = M_PI - 2.0 * slope, large = 3.0 * (M_PI + 2.0 * slope);
    // Angle of the normal from y, clockwise, and the point, after the way u along the outline.
    const auto normal = [=](double u, double) {
        double angle = slope;
        if (u > flat) angle += std::min(u - flat, small);
        if (u > 2 * flat + small) angle += (u - 2 * flat - small) / 3.0;
        return Vec3(std::sin(angle), std::cos(angle), 0.0);
    };
    const auto point = [=](double u, double v) {
        const Vec3 n = normal(u, v), along(n.y(), -n.x(), 0.0), far(apart, 0.0, 0.0);
        Vec3 p = 3.0 * n;
        if (u < flat) {
            p += u * along;
        } else if (u < flat + small) {
            p = far + n;
        } else if (u < 2 * flat + small) {
            p = far + n + (u - flat - small) * along;
        }
        return Vec3(p - Vec3(0, 0, v));
    };
    const HeightField wrap =
        testing::mapped_field(2 * flat + small + large, 10.0, 0.25, 0.0, point, normal);
    double area = 0.0;
    const std::vector<std::uint32_t> tip = zone_of_samples(wrap, {{kBand, {}, 2.0, {}}});
    for (std::size_t i = 0; i < wrap.size(); ++i) {
        if (tip[i] != 0) continue;
        area += wrap.area[i];
        EXPECT_GT(wrap.point[i].x(), apart - 0.6);
    }
    EXPECT_NEAR(area, 10.0 * small, 6.0);
    area = 0.0;
    const std::vector<std::uint32_t> both = zone_of_samples(wrap, {{kBand, {}, 4.0, {}}});
    for (std::size_t i = 0; i < wrap.size(); ++i) area += both[i] == 0 ? wrap.area[i] : 0.0;
    EXPECT_NEAR(area, 10.0 * (small + large), 12.0);
}

}  // namespace
}  // namespace beltgrinding

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "beltgrinding/error.h"
#include "inspection/section.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// Values and NaN alike.
bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same(a[i], b[i])) << a[i] << " " << b[i];
}

void expect_same(const Section& a, const Section& b) {
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.normal, b.normal);
    ASSERT_EQ(a.pieces.size(), b.pieces.size());
    for (std::size_t k = 0; k < a.pieces.size(); ++k) {
        const SectionPiece &p = a.pieces[k], &q = b.pieces[k];
        EXPECT_EQ(p.closed, q.closed);
        EXPECT_EQ(p.point, q.point);
        EXPECT_EQ(p.normal, q.normal);
        EXPECT_EQ(p.face, q.face);
        expect_same(p.arc_length, q.arc_length);
        expect_same(p.height, q.height);
        expect_same(p.stock_height, q.stock_height);
    }
}

/// Hills, far from the origin, its samples and triangles in no order.
HeightField hills(const Vec3& away, std::mt19937& random) {
    const auto height = [](double u, double v) { return 0.8 * std::sin(u) * std::cos(0.7 * v); };
    HeightField field = testing::mapped_field(
        12.0, 9.0, 0.5, 0.1,
        [&](double u, double v) -> Vec3 { return away + Vec3(u, v, height(u, v)); },
        [](double, double) { return Vec3(0, 0, 1); });
    std::vector<std::uint32_t> place(field.size());
    for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
    std::shuffle(place.begin(), place.end(), random);
    const std::vector<Vec3> points = field.point;
    for (std::uint32_t i = 0; i < place.size(); ++i) {
        field.point[place[i]] = points[i];
        field.height[i] = 0.01 * i;
    }
    std::vector<Triangle> triangles = field.triangles.unpacked();
    for (Triangle& t : triangles) {
        for (std::uint32_t& corner : t) corner = place[corner];
    }
    std::shuffle(triangles.begin(), triangles.end(), random);
    field.triangles = PackedTriangles(triangles);
    return field;
}

/// Planes that lie anyhow, through samples, along borders, beside borders, and next to the field.
std::vector<std::array<Vec3, 2>> planes_of(const HeightField& field, std::mt19937& random) {
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    std::uniform_int_distribution<std::size_t> sample(0, field.size() - 1);
    std::vector<std::array<Vec3, 2>> planes;
    for (int k = 0; k < 60; ++k) {
        const Vec3 way(part(random), part(random), 0.3 * part(random));
        planes.push_back({field.point[sample(random)], way});
        planes.push_back({field.point[sample(random)] + Vec3(part(random), part(random), 0), way});
    }
    Box box;
    for (const Vec3& p : field.point) box.extend(p);
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0, 0, 1)}) {
        for (const double beside : {-1e-3, -3e-7, -1.5e-7, -5e-8, 0.0, 5e-8, 1.5e-7, 3e-7, 1e-3}) {
            planes.push_back({box.min() + beside * axis, axis});
            planes.push_back({box.max() + beside * axis, axis});
        }
    }
    return planes;
}

TEST(SectionIndex, CutsAsTheWholeFieldIsCut) {
    std::mt19937 random(3);
    for (const Vec3& away : {Vec3(0, 0, 0), Vec3(3e4, -2e3, 700)}) {
        const HeightField field = hills(away, random);
        const SectionIndex index(field);
        std::size_t cut = 0, missed = 0;
        for (const auto& plane : planes_of(field, random)) {
            Section whole;
            try {
                whole = section_by_plane(field, plane[0], plane[1]);
            } catch (const InputError& error) {
                ++missed;
                try {
                    index.section_by_plane(plane[0], plane[1]);
                    ADD_FAILURE() << "the index finds a section where there is none";
                } catch (const InputError& other) {
                    EXPECT_STREQ(other.what(), error.what());
                }
                continue;
            }
            ++cut;
            expect_same(index.section_by_plane(plane[0], plane[1]), whole);
        }
        EXPECT_GT(cut, 100U);
        EXPECT_GT(missed, 5U);
    }
}

TEST(SectionIndex, FindsTheSamplesNearAPlane) {
    std::mt19937 random(4);
    const HeightField field = hills({10, 20, -30}, random);
    const SectionIndex index(field);
    std::size_t sum = 0;
    for (const auto& plane : planes_of(field, random)) {
        const Vec3 normal = plane[1].normalized();
        for (const double reach : {0.01, 0.5, 2.0, 100.0}) {
            std::vector<std::uint32_t> expected;
            for (std::uint32_t i = 0; i < field.size(); ++i) {
                const double distance = std::abs(normal.dot(field.point[i] - plane[0]));
                if (distance <= reach) expected.push_back(i);
            }
            EXPECT_EQ(index.near_plane(plane[0], normal, reach), expected);
            sum += expected.size();
        }
    }
    EXPECT_GT(sum, 1000U);
}

TEST(SectionIndex, OfNothingFindsNothing) {
    const HeightField empty;
    const SectionIndex index(empty);
    EXPECT_TRUE(index.near_plane({0, 0, 0}, {0, 0, 1}, 10.0).empty());
    EXPECT_THROW(index.section_by_plane({0, 0, 0}, {0, 0, 1}), InputError);
    HeightField points = testing::plate(2.0, 2.0, 1.0);  // samples that no triangle joins
    points.triangles = {};
    const SectionIndex loose(points);
    EXPECT_EQ(loose.near_plane({0, 0, 0}, {0, 0, 1}, 0.1).size(), points.size());
    EXPECT_THROW(loose.section_by_plane({0, 0, 0}, {1, 0, 0}), InputError);
}

}  // namespace
}  // namespace beltgrinding

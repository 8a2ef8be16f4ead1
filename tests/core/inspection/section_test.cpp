#include "inspection/section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "beltgrinding/error.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// A whole pipe about the z axis, open at both ends: `count` samples around.
HeightField pipe(double radius, double length, std::uint32_t count, std::uint32_t rows) {
    HeightField field;
    field.spacing = 1.0;
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / count;
            const Vec3 n(std::cos(angle), std::sin(angle), 0.0);
            field.point.push_back(radius * n + Vec3(0, 0, length * j / (rows - 1)));
            field.normal.push_back(n.cast<float>());
            if (j + 1 == rows) continue;
            const std::uint32_t a = j * count + i, b = j * count + (i + 1) % count;
            field.triangles.push_back({a, b, b + count});
            field.triangles.push_back({a, b + count, a + count});
        }
    }
    field.resize(field.point.size());
    return field;
}

/// Two plates at x = 0..10 and 12..22, as faces 0 and 1.
HeightField two_plates() {
    HeightField field = testing::plate(10.0, 10.0, 1.0, 0.3);
    const HeightField other = field;
    const auto n = static_cast<std::uint32_t>(field.size());
    field.resize(2 * n);
    for (std::uint32_t i = 0; i < n; ++i) {
        field.point[n + i] = other.point[i] + Vec3(12, 0, 0);
        field.normal[n + i] = other.normal[i];
        field.stock_height[n + i] = 0.5F;
        field.height[n + i] = 0.2;
        field.face[n + i] = 1;
    }
    for (const Triangle& t : other.triangles)
        field.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    return field;
}

TEST(Section, OfAPlateIsExact) {
    HeightField field = testing::plate(20.0, 10.0, 0.7, 0.5);
    field.height_sd.assign(field.size(), 0.0F);
    for (std::size_t i = 0; i < field.size(); ++i) {  // linear: interpolation changes nothing
        field.height[i] = 0.01 * field.point[i].x() + 0.02 * field.point[i].y();
        field.height_sd[i] = static_cast<float>(0.001 * field.point[i].x());
    }
    const Section section = section_by_plane(field, {0, 5.123, 0}, {0, -3, 0});
    ASSERT_EQ(section.pieces.size(), 1u);
    EXPECT_NEAR(section.normal.norm(), 1.0, 1e-15);
    const SectionPiece& piece = section.pieces[0];
    EXPECT_FALSE(piece.closed);
    EXPECT_NEAR(piece.point.front().x(), 20.0, 1e-12);  // along (-y) x z = -x
    EXPECT_NEAR(piece.point.back().x(), 0.0, 1e-12);
    EXPECT_NEAR(piece.arc_length.back(), 20.0, 1e-9);
    for (std::size_t i = 0; i < piece.point.size(); ++i) {
        const Vec3& p = piece.point[i];
        EXPECT_NEAR(p.y(), 5.123, 1e-12);
        EXPECT_NEAR(p.z(), 0.0, 1e-12);
        EXPECT_NEAR(piece.arc_length[i], 20.0 - p.x(), 1e-9);
        EXPECT_NEAR(piece.height[i], 0.01 * p.x() + 0.02 * p.y(), 1e-9);
        EXPECT_NEAR(piece.height_sd[i], 0.001 * p.x(), 1e-6);
        EXPECT_NEAR(piece.stock_height[i], 0.5, 1e-7);
        EXPECT_NEAR((piece.normal[i] - Vec3::UnitZ()).norm(), 0.0, 1e-7);
        if (i > 0) {
            EXPECT_GT(piece.arc_length[i], piece.arc_length[i - 1]);
        }
    }
}

TEST(Section, ThroughSamplesAndAlongTheBorderIsOneCleanLine) {
    const HeightField field = testing::plate(20.0, 10.0, 0.5, 0.5);
    for (const double y : {0.0, 5.0, 10.0}) {
        for (const double sign : {1.0, -1.0}) {
            const Section section = section_by_plane(field, {3, y, 1}, {0, sign, 0});
            ASSERT_EQ(section.pieces.size(), 1u) << y;
            EXPECT_EQ(section.pieces[0].point.size(), 41u) << y;
            EXPECT_NEAR(section.pieces[0].arc_length.back(), 20.0, 1e-9) << y;
        }
    }
}

TEST(Section, OfACylinderHasItsRadius) {
    const double radius = 30.0, spacing = 0.5;
    const HeightField field = testing::cylinder(radius, 40.0, 10.0, spacing, 0.2);
    const Section section = section_by_plane(field, {0, 4.2, 0}, Vec3::UnitY());
    ASSERT_EQ(section.pieces.size(), 1u);
    const SectionPiece& piece = section.pieces[0];
    const double sagitta = spacing * spacing / (8 * radius);
    for (std::size_t i = 0; i < piece.point.size(); ++i) {
        const Vec3 from_axis = piece.point[i] - Vec3(0, piece.point[i].y(), -radius);
        EXPECT_LE(from_axis.norm(), radius + 1e-9);
        EXPECT_GE(from_axis.norm(), radius - 1.1 * sagitta);
        EXPECT_GT(piece.normal[i].dot(from_axis.normalized()), 1.0 - 1e-9);
    }
    EXPECT_NEAR(piece.arc_length.back(), 40.0, 40.0 * sagitta / radius);
}

TEST(Section, RoundAPipeIsClosedAndRunsCounterClockwise) {
    const HeightField field = pipe(10.0, 20.0, 90, 11);
    const Section section = section_by_plane(field, {0, 0, 7.7}, Vec3::UnitZ());
    ASSERT_EQ(section.pieces.size(), 1u);
    const SectionPiece& piece = section.pieces[0];
    EXPECT_TRUE(piece.closed);
    EXPECT_LT((piece.point.front() - piece.point.back()).norm(), 1e-9);
    EXPECT_NEAR(piece.arc_length.back(), 2 * 90 * 10.0 * std::sin(std::numbers::pi / 90), 1e-2);
    for (std::size_t i = 1; i < piece.point.size(); ++i)
        EXPECT_GT(piece.point[i - 1].cross(piece.point[i]).z(), 0.0);
    // Lengthways it has two sides.
    EXPECT_EQ(section_by_plane(field, {0, 0.1, 0}, Vec3::UnitY()).pieces.size(), 2u);
}

TEST(Section, PiecesAreKeptApartInTheirOrderWithTheGapBetween) {
    const HeightField field = two_plates();
    const Section section = section_by_plane(field, {0, 5.5, 0}, {0, 1, 0});
    ASSERT_EQ(section.pieces.size(), 2u);
    EXPECT_EQ(section.pieces[0].face, 0u);
    EXPECT_EQ(section.pieces[1].face, 1u);
    EXPECT_NEAR(section.pieces[0].arc_length.back(), 10.0, 1e-9);
    EXPECT_NEAR(section.pieces[1].arc_length.front(), 12.0, 1e-9);
    EXPECT_NEAR(section.pieces[1].arc_length.back(), 22.0, 1e-9);
    EXPECT_NEAR(section.pieces[1].height[3], 0.2, 1e-12);
    EXPECT_NEAR(section.pieces[1].stock_height[3], 0.5, 1e-7);
    const Section back = section_by_plane(field, {0, 5.5, 0}, {0, -1, 0});
    EXPECT_EQ(back.pieces[0].face, 1u);
}

TEST(Section, AHolePartsTheLine) {
    HeightField field = testing::plate(20.0, 20.0, 1.0, 0.1);
    std::vector<Triangle> triangles = field.triangles.unpacked();
    std::erase_if(triangles, [&](const Triangle& t) {
        const Vec3 middle = (field.point[t[0]] + field.point[t[1]] + field.point[t[2]]) / 3.0;
        return (middle - Vec3(10, 10, 0)).norm() < 4.0;
    });
    field.triangles = PackedTriangles(triangles);
    const Section section = section_by_plane(field, {0, 10.2, 0}, {0, 1, 0});
    ASSERT_EQ(section.pieces.size(), 2u);
    EXPECT_NEAR(section.pieces[1].arc_length.back(), 20.0, 1e-9);
    EXPECT_GT(section.pieces[1].arc_length.front(), section.pieces[0].arc_length.back() + 6.0);
}

TEST(Section, MissedSamplesHaveNoHeight) {
    HeightField field = testing::plate(10.0, 10.0, 1.0, 0.1);
    for (std::size_t i = 0; i < field.size(); ++i)
        if (std::abs(field.point[i].x() - 5.0) < 0.1) field.flags[i] |= kMissed;
    const SectionPiece piece = section_by_plane(field, {0, 5.0, 0}, {0, 1, 0}).pieces.at(0);
    for (std::size_t i = 0; i < piece.point.size(); ++i) {
        const bool missed = std::abs(piece.point[i].x() - 5.0) < 0.9;
        EXPECT_EQ(std::isnan(piece.height[i]), missed) << piece.point[i].x();
        EXPECT_EQ(std::isnan(piece.stock_height[i]), missed);
    }
}

TEST(Section, ThatCannotBeIsRefused) {
    const HeightField field = testing::plate(10.0, 10.0, 1.0, 0.1);
    EXPECT_THROW(section_by_plane(field, {0, 0, 0}, {0, 0, 0}), InputError);
    EXPECT_THROW(section_by_plane(field, {0, std::nan(""), 0}, {0, 1, 0}), InputError);
    try {
        section_by_plane(field, {0, 15, 0}, {0, 1, 0});
        FAIL() << "the plane misses the plate";
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("from -15 to -5 mm"), std::string::npos) << text;
    }
    HeightField bare = field;
    bare.triangles = {};
    EXPECT_THROW(section_by_plane(bare, {0, 5, 0}, {0, 1, 0}), InputError);
    EXPECT_THROW(section_between(field, {1, 1, 0}, {1, 1, 0}), InputError);
    EXPECT_THROW(section_between(field, {1, 1, 0}, {1, 1, 3}), InputError);
    EXPECT_THROW(section_between(HeightField{}, {1, 1, 0}, {1, 2, 3}), InputError);
}

TEST(SectionBetween, OnAPlateIsTheStraightLine) {
    const HeightField field = testing::plate(20.0, 10.0, 0.7, 0.5);
    const Vec3 from(3.21, 2.5, 0), to(16.4, 8.1, 0);
    for (const bool back : {false, true}) {
        const Section section = back ? section_between(field, to, from)  //
                                     : section_between(field, from, to);
        ASSERT_EQ(section.pieces.size(), 1u);
        const SectionPiece& piece = section.pieces[0];
        EXPECT_LT((piece.point.front() - (back ? to : from)).norm(), 1e-9);
        EXPECT_LT((piece.point.back() - (back ? from : to)).norm(), 1e-9);
        EXPECT_NEAR(piece.arc_length.back(), (to - from).norm(), 1e-9);
        EXPECT_EQ(piece.height.size(), piece.point.size());
    }
}

TEST(SectionBetween, RunsOverTheSeamAndOnToTheNextFace) {
    const HeightField round = pipe(10.0, 20.0, 90, 11);
    const double a = -0.4, b = 0.5;
    const Section over = section_between(round, {10 * std::cos(a), 10 * std::sin(a), 10},
                                         {10 * std::cos(b), 10 * std::sin(b), 10});
    ASSERT_EQ(over.pieces.size(), 1u);
    EXPECT_NEAR(over.pieces[0].arc_length.back(), 9.0, 0.02);

    const Section across = section_between(two_plates(), {4, 3, 0}, {20, 3, 0});
    ASSERT_EQ(across.pieces.size(), 2u);
    EXPECT_NEAR(across.pieces[1].arc_length.back(), 16.0, 1e-9);
    const Section from_the_end = section_between(two_plates(), {11, 3, 0}, {20, 3, 0});
    EXPECT_NEAR(from_the_end.pieces.back().point.back().x(), 20.0, 1e-9);
}

}  // namespace
}  // namespace beltgrinding

#include "gap/gap_map.h"
#include "contact/wheel_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/blocks.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// The wheel above (x, y, z), its axis turned by `angle` about the vertical, pressing down.
Frame above(double x, double y, double z, double angle = 0.0) {
    Frame frame = Frame::Identity();
    frame.linear() =
        (Eigen::AngleAxisd(angle, Vec3::UnitZ()) * Eigen::AngleAxisd(M_PI, Vec3::UnitX()))
            .toRotationMatrix();
    frame.translation() = Vec3(x, y, z);
    return frame;
}

using testing::all_of;

TEST(GapMap, GivesTheRadialGapOfAPlateAtAnyAngle) {
    const ContactWheel wheel{80.0, 20.0, 0.0};
    const HeightField field = testing::plate(80.0, 80.0, 0.5, 0.2);
    const double lift = 0.15;  // of the wheel above the stock
    for (const double angle : {0.0, 0.3, 0.785, 1.2}) {
        GapMap map(wheel, 1.0);
        const SampleBlocks blocks(field);
        map.update(blocks, all_of(blocks), above(40.0, 40.0, 0.2 + lift, angle), 1.0);
        const ContactGrid& grid = map.grid();
        int seen = 0;
        for (int j = 0; j < grid.ny; ++j) {
            for (int i = 0; i < grid.nx; ++i) {
                const double theta = grid.s(i) / wheel.radius;
                if (std::abs(grid.s(i)) > 10.0) continue;
                const double exact = (wheel.radius + lift) / std::cos(theta) - wheel.radius;
                EXPECT_NEAR(map.gap()[j * grid.nx + i], exact, 2.0e-3);
                EXPECT_EQ(map.coverage()[j * grid.nx + i], 1.0);
                ++seen;
            }
        }
        EXPECT_GT(seen, 300);
    }
}

TEST(GapMap, WhatAnApproachDoesToItIsKnownWithoutMappingAnew) {
    const ContactWheel wheel{80.0, 20.0, 0.0};
    const double approach = 0.04;
    // A plate, which lies askew to the wheel away from its middle, and a ridge across its feed.
    for (const HeightField& field :
         {testing::plate(80.0, 80.0, 0.5, 0.2), testing::cylinder(30.0, 60.0, 80.0, 0.5)}) {
        const SampleBlocks blocks(field);
        const bool flat = field.height[0] > 0.0;
        const double x = flat ? 40.0 : 4.0, z = flat ? 0.2 : -0.2;
        GapMap map(wheel, 1.0), moved(wheel, 1.0);
        map.update(blocks, all_of(blocks), above(x, 40.0, z), 1.0);
        moved.update(blocks, all_of(blocks), above(x, 40.0, z - approach), 1.0);
        const ContactGrid& grid = map.grid();
        ASSERT_EQ(grid, moved.grid());
        const Eigen::ArrayXd tilt = tilt_by_approach(wheel, grid, map.gap());
        double most = 0.0, left = 0.0;
        for (int k = 0; k < grid.cells(); ++k) {
            if (std::abs(grid.s(k % grid.nx)) > (flat ? 8.0 : 4.5)) continue;  // all in reach
            const double change = moved.gap()[k] - (map.gap()[k] - approach);
            most = std::max(most, std::abs(change));
            left = std::max(left, std::abs(change - approach * tilt[k]));
        }
        EXPECT_GT(most, 5e-5);
        EXPECT_LT(left, 0.1 * most);
    }
}

TEST(GapMap, CrownOpensTheGapTowardsTheEdges) {
    const ContactWheel wheel{80.0, 20.0, 60.0};
    const HeightField field = testing::plate(60.0, 60.0, 0.4);
    GapMap map(wheel, 1.0);
    const SampleBlocks blocks(field);
    map.update(blocks, all_of(blocks), above(30.0, 30.0, 0.0), 3.0);
    const ContactGrid& grid = map.grid();
    for (int j = 0; j < grid.ny; ++j) {
        EXPECT_NEAR(map.gap()[j * grid.nx + grid.nx / 2], wheel.drop(grid.y(j)), 5e-3);
    }
}

TEST(GapMap, AProfileOpensTheGapAsItDropsFromOneStretchToTheNext) {
    const ContactWheel wheel{
        80.0, 20.0, 0.0, {{-11.0, 0.4}, {-4.0, 0.0}, {2.0, 0.1}, {7.0, 0.0}, {11.0, 0.6}}};
    const HeightField field = testing::plate(60.0, 60.0, 0.4);
    const SampleBlocks blocks(field);
    GapMap map(wheel, 1.0);
    map.update(blocks, all_of(blocks), above(30.0, 30.0, 0.0), 3.0);
    const ContactGrid& grid = map.grid();
    for (int j = 0; j < grid.ny; ++j) {
        // Cells over a kink have the mean of what lies round it.
        EXPECT_NEAR(map.gap()[j * grid.nx + grid.nx / 2], wheel.drop(grid.y(j)), 3e-2) << j;
    }
}

// Samples by themselves, as near edges, and eight at a time are the same.
TEST(GapMap, SamplesAreWhereTheyAreHoweverTheyArePlaced) {
    for (const ContactWheel& wheel :
         {ContactWheel{50.0, 20.0, 0.0}, ContactWheel{50.0, 20.0, 40.0},
          ContactWheel{50.0, 20.0, 0.0, {{-11.0, 0.4}, {0.0, 0.0}, {11.0, 0.6}}}}) {
        const HeightField field = testing::cylinder(45.0, 60.0, 40.0, 0.3, 0.5);
        HeightField leaning = field;  // all by themselves, along their normals still
        leaning.rays = field.normal;
        for (Vec3f& ray : leaning.rays) ray *= 1.0f + 1e-6f;
        const Frame pose = above(0.0, 20.0, 0.3, 0.4);
        const SampleBlocks regular(field), alone(leaning);
        GapMap one(wheel, 1.0), other(wheel, 1.0);
        one.update(regular, all_of(regular), pose, 0.6);
        other.update(alone, all_of(alone), pose, 0.6);
        ASSERT_EQ(one.grid(), other.grid());
        EXPECT_EQ(one.samples(), other.samples());
        for (int k = 0; k < one.grid().cells(); ++k) {
            EXPECT_EQ(one.coverage()[k] > 0.0, other.coverage()[k] > 0.0);
            if (!(one.coverage()[k] > 0.0)) continue;
            EXPECT_NEAR(one.coverage()[k], other.coverage()[k], 1e-5);
            EXPECT_NEAR(one.gap()[k], other.gap()[k], 2e-6);
        }
    }
}

TEST(GapMap, CoverageEndsWhereTheFaceEnds) {
    const ContactWheel wheel{80.0, 20.0, 0.0};
    const HeightField field = testing::plate(60.0, 60.0, 0.5);
    GapMap map(wheel, 1.0);
    // Half of the wheel's width hangs over the edge y = 0; cells are halved there.
    const SampleBlocks blocks(field);
    map.update(blocks, all_of(blocks), above(30.0, 0.0, 0.0), 0.5);
    const ContactGrid& grid = map.grid();
    double covered = 0.0;
    for (int j = 0; j < grid.ny; ++j)
        covered += map.coverage()[j * grid.nx + grid.nx / 2] * grid.dy;
    EXPECT_NEAR(covered, 10.0, 0.3);
}

TEST(GapMap, SeesOnlyTheNearestLayer) {
    HeightField field = testing::plate(40.0, 40.0, 0.5);
    const HeightField below = testing::plate(40.0, 40.0, 0.5);
    const std::size_t n = field.size();
    field.resize(2 * n);
    for (std::size_t i = 0; i < n; ++i) {
        field.point[n + i] = below.point[i] - Vec3(0, 0, 2.0);
        field.normal[n + i] = below.normal[i];
        field.area[n + i] = below.area[i];
    }
    GapMap map({60.0, 20.0, 0.0}, 1.0);
    SampleBlocks blocks(field);
    map.update(blocks, all_of(blocks), above(20.0, 20.0, 0.0), 5.0);
    EXPECT_NEAR(map.lowest(), 0.0, 2e-3);
    Eigen::ArrayXd rate = (map.gap() < 0.2).select(Eigen::ArrayXd::Ones(map.gap().size()), 0.0);
    map.remove(blocks, rate, {}, 0.01, 1.0);
    for_changed(blocks.changes(), [&](std::size_t k) { EXPECT_LT(blocks.sample(k), n); });
    EXPECT_FALSE(blocks.changes().empty());
}

TEST(GapMap, RemovesTheVolumeOfTheCells) {
    for (const double spacing : {0.2, 0.37, 0.66}) {
        HeightField field = testing::cylinder(45.0, 60.0, 40.0, spacing, 0.5);
        const std::vector<double> before = field.height;
        GapMap map({50.0, 15.0, 0.0}, 1.0);
        SampleBlocks blocks(field);
        map.update(blocks, all_of(blocks), above(0.0, 20.0, 0.2, 0.4), 1.0);
        const Eigen::ArrayXd rate = (-map.gap()).max(0.0);
        const double volume = map.remove(blocks, rate, {}, 0.5, 1.0);
        field.height = blocks.heights();
        EXPECT_NEAR(volume, (rate * map.coverage()).sum() * map.grid().cell_area() * 0.5, 1e-12);
        double removed = 0.0;
        for (std::size_t i = 0; i < field.size(); ++i) {
            removed += field.area[i] * (before[i] - field.height[i]);
        }
        EXPECT_NEAR(removed, volume, 1e-9 * volume);
    }
}

/// mm by which the top of a sample lies within the wheel at `work_from_contact`, moved by
/// `approach` along z; negative: outside.
double overlap(const HeightField& field, std::size_t sample, const ContactWheel& wheel,
               const Frame& work_from_contact, double approach) {
    const Vec3 top = work_from_contact.inverse() * field.top(sample) - approach * Vec3::UnitZ();
    if (std::abs(top.y()) > 0.5 * (wheel.width + field.spacing)) return -1.0;
    const double y = std::clamp(top.y(), -0.5 * wheel.width, 0.5 * wheel.width);
    return wheel.radius - wheel.drop(y) - std::hypot(top.x(), top.z() + wheel.radius);
}

TEST(GapMap, NoSampleFallsBelowTheEnvelope) {
    const Frame pose = above(0.0, 20.0, 0.2, 0.4);
    for (const ContactWheel& wheel :
         {ContactWheel{50.0, 15.0, 0.0}, ContactWheel{50.0, 15.0, 20.0}}) {
        for (const double approach : {0.3, 3.0}) {
            HeightField field = testing::cylinder(45.0, 60.0, 40.0, 0.6, 0.5);
            const HeightField before = field;
            GapMap map(wheel, 1.0);
            SampleBlocks blocks(field);
            map.update(blocks, all_of(blocks), pose, 1.0);
            // The middle gets more than there is, the border about as much.
            const Eigen::ArrayXd rate = 2.0 * (approach + 0.5 - map.gap()).max(0.0);
            const double volume = map.remove(blocks, rate, {}, 1.0, approach);
            EXPECT_FALSE(blocks.changes().empty());
            field.height = blocks.heights();
            double removed = 0.0;
            for (std::size_t i = 0; i < field.size(); ++i) {
                EXPECT_LE(field.height[i], before.height[i]);
                removed += field.area[i] * (before.height[i] - field.height[i]);
                const double was = overlap(before, i, wheel, pose, approach);
                const double is = overlap(field, i, wheel, pose, approach);
                EXPECT_GE(is, std::min(was, -1e-9)) << i;  // none goes through
            }
            EXPECT_NEAR(removed, volume, 1e-9 * volume);
        }
    }
}

TEST(GapMap, ADeepCutEndsOnTheEnvelope) {
    // Along a normal far from the wheel's radius the cut is no straight share of the overlap.
    const ContactWheel wheel{40.0, 20.0, 30.0};
    for (const double deep : {0.1, 2.0, 8.0}) {
        HeightField field = testing::plate(60.0, 40.0, 0.5);
        const HeightField before = field;
        GapMap map(wheel, 1.0);
        const Frame pose = above(30.0, 20.0, -deep);
        SampleBlocks blocks(field);
        map.update(blocks, all_of(blocks), pose, 0.2);
        map.cut(blocks);
        EXPECT_FALSE(blocks.changes().empty());
        field.height = blocks.heights();
        for_changed(blocks.changes(), [&](std::size_t k) {
            EXPECT_NEAR(overlap(field, blocks.sample(k), wheel, pose, 0.0), 0.0, 2e-5) << deep;
        });
    }
}

TEST(GapMap, LeavesOutWhatFacesAwayOrWasMissed) {
    HeightField field = testing::plate(20.0, 20.0, 0.5);
    for (auto& n : field.normal) n = -n;
    GapMap map({60.0, 20.0, 0.0}, 1.0);
    const SampleBlocks blocks(field);
    map.update(blocks, all_of(blocks), above(10.0, 10.0, 0.0), 5.0);
    EXPECT_TRUE(map.empty());
    field = testing::plate(20.0, 20.0, 0.5);
    for (auto& f : field.flags) f |= kMissed;
    const SampleBlocks missed(field);
    map.update(missed, all_of(missed), above(10.0, 10.0, 0.0), 5.0);
    EXPECT_TRUE(map.empty());
}

}  // namespace
}  // namespace beltgrinding

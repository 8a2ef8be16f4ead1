#include "heightfield/kdop_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

HeightField wavy(double spacing) {
    HeightField field = testing::cylinder(40.0, 60.0, 50.0, spacing, 0.3);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> height(-0.5, 1.5);
    for (double& h : field.height) h = height(random);
    return field;
}

WheelReach random_reach(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    WheelReach reach;
    reach.centre = 40.0 * Vec3(unit(random), unit(random) + 0.6, unit(random));
    reach.axis = Vec3(unit(random), unit(random), unit(random)).normalized();
    reach.direction = reach.axis.unitOrthogonal();
    reach.radius = 5.0 + 25.0 * std::abs(unit(random));
    reach.half_width = 1.0 + 15.0 * std::abs(unit(random));
    reach.min_along = reach.radius * unit(random);
    return reach;
}

/// The segment, sampled densely: an independent (if coarser) way to say that it meets the reach.
bool brute_force(const HeightField& field, std::size_t s, const WheelReach& reach, double slack) {
    for (int k = 0; k <= 200; ++k) {
        const double h = -field.depth + (field.height[s] + field.depth) * k / 200.0;
        const Vec3 v = field.point[s] + h * field.normal[s].cast<double>() - reach.centre;
        const double y = v.dot(reach.axis);
        if (std::abs(y) <= reach.half_width + slack &&
            v.dot(reach.direction) >= reach.min_along - slack &&
            (v - y * reach.axis).norm() <= reach.radius + slack) {
            return true;
        }
    }
    return false;
}

template <class Tree>
class KDopTreeTest : public ::testing::Test {};
using Trees = ::testing::Types<KDopTree<6>, KDopTree<14>, KDopTree<18>, KDopTree<26>>;
TYPED_TEST_SUITE(KDopTreeTest, Trees);

TYPED_TEST(KDopTreeTest, NeverMissesASegmentBeforeAndAfterRemoval) {
    HeightField field = wavy(0.8);
    TypeParam tree(field);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<std::uint32_t> hits;
    std::size_t all_hits = 0;
    for (int pose = 0; pose < 60; ++pose) {
        const WheelReach reach = random_reach(random);
        tree.query(field, reach, hits);
        EXPECT_TRUE(std::is_sorted(hits.begin(), hits.end()));
        std::vector<char> hit(field.size(), 0);
        for (const std::uint32_t s : hits) hit[s] = 1;
        for (std::size_t s = 0; s < field.size(); ++s) {
            if (hit[s] == 0) {
                ASSERT_FALSE(brute_force(field, s, reach, 0.0)) << "missed " << s;
            } else {
                // The dense sampling sees points at most 1/200 of the segment apart.
                ASSERT_TRUE(brute_force(field, s, reach, 0.01)) << "false hit " << s;
            }
        }
        all_hits += hits.size();
        for (const std::uint32_t s : hits) field.height[s] -= 0.05 * unit(random);
        tree.refit(field, hits);
    }
    EXPECT_GT(all_hits, 1000u);
}

TYPED_TEST(KDopTreeTest, RefitGivesTheBoundsOfANewTree) {
    HeightField field = wavy(1.0);
    TypeParam tree(field);
    std::vector<std::uint32_t> changed;
    for (std::uint32_t s = 100; s < 900; s += 3) {
        field.height[s] = -0.9;
        changed.push_back(s);
    }
    tree.refit(field, changed);
    const TypeParam fresh(field);
    std::mt19937 random(5);
    std::vector<std::uint32_t> a, b;
    for (int pose = 0; pose < 100; ++pose) {
        const WheelReach reach = random_reach(random);
        tree.query(field, reach, a);
        fresh.query(field, reach, b);
        EXPECT_EQ(a, b);
    }
}

TEST(SegmentTree, DoesNotDependOnTheNumberOfThreads) {
    const HeightField field = wavy(0.15);
    std::vector<std::uint32_t> one, many;
    std::mt19937 random(5);
    const WheelReach reach = random_reach(random);
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        SegmentTree(field).query(field, reach, one);
    }
    SegmentTree(field).query(field, reach, many);
    EXPECT_EQ(one, many);
}

TEST(SegmentTree, TakesFewBytesASample) {
    const HeightField field = testing::plate(200.0, 200.0, 0.4);
    const SegmentTree tree(field);
    EXPECT_LT(static_cast<double>(tree.bytes() + field.bytes()) / static_cast<double>(field.size()),
              110.0);
}

TEST(SegmentTree, CopesWithFewSamples) {
    std::vector<std::uint32_t> hits{1, 2, 3};
    SegmentTree(HeightField{}).query(HeightField{}, WheelReach{}, hits);
    EXPECT_TRUE(hits.empty());
    const HeightField field = testing::plate(1.0, 1.0, 1.0);
    WheelReach reach;
    reach.radius = 10.0;
    reach.half_width = 10.0;
    reach.min_along = -10.0;
    SegmentTree(field).query(field, reach, hits);
    EXPECT_EQ(hits.size(), 4u);
}

}  // namespace
}  // namespace beltgrinding

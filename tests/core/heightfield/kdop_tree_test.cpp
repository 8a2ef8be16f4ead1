#include "heightfield/kdop_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>
#include <vector>

#include "heightfield/sample_blocks.h"
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

TYPED_TEST(KDopTreeTest, NeverMissesASegment) {
    HeightField field = wavy(0.8);
    TypeParam tree(field);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<std::uint32_t> found;
    std::size_t all_found = 0;
    for (int pose = 0; pose < 60; ++pose) {
        const WheelReach reach = random_reach(random);
        tree.query(reach, found);
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
        all_found += found.size();
        for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf) {
            if (std::binary_search(found.begin(), found.end(), leaf)) continue;
            for (const std::uint32_t s : tree.leaf(leaf))
                ASSERT_FALSE(brute_force(field, s, reach, 0.0)) << "missed " << s;
        }
        // Shorter ones lie in the same bounds; longer ones have to be told.
        for (std::uint32_t s = 0; s < field.size(); ++s)
            field.height[s] = std::max(field.height[s] - 0.05 * unit(random), -field.depth);
        const auto leaf = static_cast<std::uint32_t>(random() % tree.leaves());
        const std::uint32_t deep = tree.leaf(leaf).front();
        field.height[deep] = -field.depth - 3.0 * unit(random);
        tree.extend(leaf, field.top(deep));
    }
    EXPECT_GT(all_found, 100u);
    EXPECT_LT(all_found, 60u * tree.leaves() / 2);
}

TEST(SegmentTree, DoesNotDependOnTheNumberOfThreads) {
    const HeightField field = wavy(0.15);
    const auto order_of = [&] {
        const SegmentTree tree(field);
        return std::vector<std::uint32_t>(tree.order().begin(), tree.order().end());
    };
    std::vector<std::uint32_t> one;
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        one = order_of();
    }
    EXPECT_EQ(one, order_of());
}

TEST(SegmentTree, FillsItsLeaves) {
    const HeightField field = wavy(0.5);
    const SegmentTree tree(field);
    std::vector<char> seen(field.size(), 0);
    for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf) {
        const auto samples = tree.leaf(leaf);
        EXPECT_TRUE(std::is_sorted(samples.begin(), samples.end()));
        const bool last = leaf + 1 == tree.leaves();
        EXPECT_TRUE(last || samples.size() == SegmentTree::kLeafSize);
        for (const std::uint32_t s : samples) ++seen[s];
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(field.size()));
}

TEST(SegmentTree, CopesWithFewSamples) {
    std::vector<std::uint32_t> found{1, 2, 3};
    SegmentTree(HeightField{}).query(WheelReach{}, found);
    EXPECT_TRUE(found.empty());
    WheelReach reach;
    reach.radius = 10.0;
    reach.half_width = 10.0;
    reach.min_along = -10.0;
    SegmentTree(testing::plate(1.0, 1.0, 1.0)).query(reach, found);
    EXPECT_EQ(found, std::vector<std::uint32_t>{0});
}

TEST(SampleBlocks, TheDiscMissesNoTopThatIsInReach) {
    HeightField field = wavy(0.8);
    for (std::uint32_t s = 0; s < field.size(); s += 50) field.height[s] = 4.0;
    SampleBlocks blocks(field);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    NearBlocks near;
    std::vector<std::uint32_t> found;
    WheelReach reach = random_reach(random);
    std::size_t all_found = 0;
    for (int pose = 0; pose < 200; ++pose) {
        // A way in small steps, now and then somewhere else.
        if (pose % 20 == 0) {
            reach = random_reach(random);
        } else {
            const Eigen::AngleAxisd turn(0.03 * unit(random),
                                         Vec3(unit(random), 1, 0).normalized());
            reach.axis = turn * reach.axis;
            reach.direction = turn * reach.direction;
            reach.centre += Vec3(unit(random), unit(random), unit(random) - 0.5);
        }
        near.find(blocks, reach, found);
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
        all_found += found.size();
        for (std::size_t k = 0; k < field.size(); ++k) {
            const auto block = static_cast<std::uint32_t>(k / SampleBlocks::kLanes);
            if (std::binary_search(found.begin(), found.end(), block)) continue;
            const Vec3 v = blocks.top(k) - reach.centre;
            const Vec3 bottom = field.bottom(blocks.sample(k)) - reach.centre;
            const double y = v.dot(reach.axis);
            ASSERT_FALSE(
                std::abs(y) <= reach.half_width && (v - y * reach.axis).norm() <= reach.radius &&
                std::max(v.dot(reach.direction), bottom.dot(reach.direction)) >= reach.min_along)
                << k;
        }
        for (std::size_t k = random() % 7; k < field.size(); k += 5)
            blocks.lower(k, 0.02 * unit(random));
        blocks.clear_changes();
    }
    EXPECT_GT(all_found, 300u);
    EXPECT_LT(all_found, 200u * blocks.count() / 2);
}

TEST(SampleBlocks, TellsWhatWasLoweredOnceByBlocks) {
    const HeightField field = wavy(0.8);
    SampleBlocks blocks(field);
    for (const std::size_t k : {700, 3, 701, 3, 64}) blocks.lower(k, 0.125);
    std::vector<std::size_t> positions;
    for_changed(blocks.changes(), [&](std::size_t k) { positions.push_back(k); });
    EXPECT_EQ(positions, (std::vector<std::size_t>{3, 64, 700, 701}));
    const std::vector<double> heights = blocks.heights();
    for (std::size_t k = 0; k < field.size(); ++k) {
        const double less = k == 3 ? 0.25 : (k == 64 || k == 700 || k == 701 ? 0.125 : 0.0);
        const std::uint32_t s = blocks.sample(k);
        EXPECT_DOUBLE_EQ(heights[s], field.height[s] - less);
    }
    for (const SampleBlocks::Change& change : blocks.changes())
        for (std::size_t lane = 0; lane < SampleBlocks::kLanes; ++lane)
            EXPECT_EQ(blocks.before(change)[lane],
                      field.height[blocks.sample(change.block * SampleBlocks::kLanes + lane)]);
    blocks.clear_changes();
    EXPECT_TRUE(blocks.changes().empty());
    blocks.lower(3, 0.125);  // from where it is now
    EXPECT_EQ(blocks.before(blocks.changes()[0])[3], field.height[blocks.sample(3)] - 0.25);
}

}  // namespace
}  // namespace beltgrinding

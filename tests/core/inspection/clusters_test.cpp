#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "beltgrinding/verdict.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr Tolerance kBand{-0.05, 0.1};

/// Spots of all sizes above and below, ground by many motions; some samples stand for no area, some
/// were missed, some never touched.
HeightField spotted(std::uint32_t seed) {
    HeightField field = testing::plate(20.0, 15.0, 0.5);
    field.trace.reset(field.size());
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::uint32_t> any(0, 11);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const std::uint32_t spot = any(random);
        field.height[i] = spot < 5 ? 0.15 + 0.01 * any(random) : spot < 9 ? -0.2 : 0.0;
        field.area[i] = any(random) == 0 ? 0.0F : 0.25F + 0.01F * static_cast<float>(any(random));
        field.face[i] = field.point[i].x() < 9.1 ? 2 : 5;
        if (any(random) == 0) field.flags[i] |= kMissed;
        if (any(random) < 3) continue;
        field.trace.first[i] = any(random) / 3;
        field.trace.last[i] = any(random) / 3 + 4;
        field.trace.dominant[i] = any(random) < 6 ? field.trace.first[i] : any(random);
        field.trace.dominant_depth[i] = 0.01F * static_cast<float>(any(random));
    }
    return field;
}

/// mm beyond the band, above it positive; 0: inside, or not known.
double beyond(const HeightField& field, std::uint32_t i) {
    if ((field.flags[i] & kMissed) != 0) return 0.0;
    const double h = field.height[i];
    return h > kBand.upper ? h - kBand.upper : std::min(h - kBand.lower, 0.0);
}

/// The smallest sample that triangles with samples on the same side lead to, found by walking
/// through all triangles until nothing changes.
std::vector<std::uint32_t> smallest_joined(const HeightField& field) {
    std::vector<std::uint32_t> smallest(field.size());
    for (std::uint32_t i = 0; i < field.size(); ++i) smallest[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (const Triangle& t : field.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                if (!(beyond(field, a) * beyond(field, b) > 0.0)) continue;
                const std::uint32_t least = std::min(smallest[a], smallest[b]);
                changed = changed || smallest[a] != least || smallest[b] != least;
                smallest[a] = smallest[b] = least;
            }
        }
    }
    return smallest;
}

/// Of each motion the share of the cluster's area and the depth, added up motion by motion.
std::vector<MotionShare> motions_of(const HeightField& field, const Cluster& cluster,
                                    const std::vector<std::uint32_t>& samples) {
    std::map<std::uint32_t, MotionShare> found;
    const RemovalTrace& trace = field.trace;
    for (std::uint32_t motion = 0; motion < 12; ++motion) {
        MotionShare share{motion, 0.0, 0.0};
        bool any = false;
        for (const std::uint32_t i : samples) {
            if (trace.first[i] == RemovalTrace::kNever) continue;
            const bool dominant = trace.dominant[i] == motion;
            const bool also = trace.first[i] == motion || trace.last[i] == motion;
            if (!dominant && !(cluster.above && also)) continue;
            any = true;
            share.share += field.area[i];
            if (dominant) share.depth = std::max<double>(share.depth, trace.dominant_depth[i]);
        }
        share.share /= cluster.area;
        if (any) found[motion] = share;
    }
    std::vector<MotionShare> shares;
    for (const auto& one : found) shares.push_back(one.second);
    std::stable_sort(shares.begin(), shares.end(),
                     [](const MotionShare& a, const MotionShare& b) { return a.share > b.share; });
    return shares;
}

TEST(Clusters, AreThoseThatWalkingFromTriangleToTriangleFindsToTheBit) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const HeightField field = spotted(seed);
        const Verdict verdict = judge(field, {}, kBand);
        const std::vector<std::uint32_t> smallest = smallest_joined(field);
        std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
        for (std::uint32_t i = 0; i < field.size(); ++i) {
            if (beyond(field, i) != 0.0) {
                groups[smallest[i]].push_back(i);
            } else {
                EXPECT_EQ(verdict.cluster[i], Verdict::kNone);
            }
        }
        ASSERT_GT(groups.size(), 20U);
        std::size_t largest = 0;
        std::set<std::uint32_t> numbers;
        for (const auto& group : groups) {
            const std::vector<std::uint32_t>& samples = group.second;
            const std::uint32_t number = verdict.cluster[samples.front()];
            ASSERT_LT(number, verdict.clusters.size());
            numbers.insert(number);
            const Cluster& cluster = verdict.clusters[number];
            EXPECT_EQ(cluster.samples, samples.size());
            largest = std::max(largest, samples.size());
            double area = 0.0, volume = 0.0, untouched = 0.0;
            Vec3 centroid = Vec3::Zero();
            std::set<std::uint32_t> faces;
            std::uint32_t worst = samples.front();
            for (const std::uint32_t i : samples) {
                EXPECT_EQ(verdict.cluster[i], number);
                area += field.area[i];
                volume += field.area[i] * std::abs(beyond(field, i));
                centroid += field.area[i] * field.point[i];
                if (!field.trace.touched(i)) untouched += field.area[i];
                faces.insert(field.face[i]);
                if (std::abs(beyond(field, i)) > std::abs(beyond(field, worst))) worst = i;
            }
            EXPECT_EQ(cluster.above, beyond(field, worst) > 0.0);
            EXPECT_EQ(cluster.area, area);
            EXPECT_EQ(cluster.volume, volume);
            EXPECT_EQ(cluster.untouched_area, untouched);
            EXPECT_EQ(cluster.worst.sample, worst);
            EXPECT_EQ(cluster.faces, std::vector<std::uint32_t>(faces.begin(), faces.end()));
            if (!(area > 0.0)) continue;
            EXPECT_EQ(cluster.centroid, Vec3(centroid / area));
            const std::vector<MotionShare> motions = motions_of(field, cluster, samples);
            ASSERT_EQ(cluster.motions.size(), motions.size());
            for (std::size_t k = 0; k < motions.size(); ++k) {
                EXPECT_EQ(cluster.motions[k].motion, motions[k].motion);
                EXPECT_EQ(cluster.motions[k].share, motions[k].share);
                EXPECT_EQ(cluster.motions[k].depth, motions[k].depth);
            }
        }
        EXPECT_EQ(numbers.size(), groups.size());
        EXPECT_EQ(verdict.clusters.size(), groups.size());
        EXPECT_GT(largest, 20U);
        EXPECT_TRUE(
            std::is_sorted(verdict.clusters.begin(), verdict.clusters.end(),
                           [](const Cluster& a, const Cluster& b) { return a.area > b.area; }));
    }
}

}  // namespace
}  // namespace beltgrinding

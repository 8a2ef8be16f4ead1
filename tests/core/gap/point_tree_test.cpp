#include "point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace beltgrinding {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

std::vector<Vec3> scattered(std::size_t count, double flat) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-10.0, 10.0);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(any(random), any(random), flat * any(random));
    return points;
}

TEST(PointTree, FindsTheNearestAsALookAtAllDoesAndLooksAtFew) {
    for (const std::size_t count : {1U, 8U, 9U, 1000U, 20000U}) {
        for (const double flat : {1.0, 0.0}) {
            const std::vector<Vec3> points = scattered(count, flat);
            const PointTree tree(points);
            for (const Vec3& from : scattered(20, 1.0)) {
                const auto nearness = [&](std::size_t k) { return -(points[k] - from).norm(); };
                std::size_t looked_at = 0;
                const double found = tree.greatest(
                    kNone,
                    [&](const Vec3& middle, double away) { return away - (middle - from).norm(); },
                    [&](std::size_t k) { return ++looked_at, nearness(k); });
                double nearest = kNone;
                for (std::size_t k = 0; k < count; ++k) nearest = std::max(nearest, nearness(k));
                EXPECT_EQ(found, nearest) << count << ' ' << flat;
                EXPECT_LE(looked_at, 9 + count / 5);
            }
        }
    }
}

TEST(PointTree, PointsOnOnePlaceAndNoneAtAllAreTrees) {
    const auto most = [](const Vec3&, double) { return 200.0; };
    const auto value = [](std::size_t k) { return double(k); };
    EXPECT_EQ(PointTree({}).greatest(-1.0, most, value), -1.0);
    EXPECT_EQ(PointTree(std::vector<Vec3>(100, Vec3::Ones())).greatest(-1.0, most, value), 99.0);
}

TEST(PointTree, WhatIsNotMoreThanTheLeastIsNotLookedAt) {
    const PointTree tree(scattered(100, 1.0));
    const auto fails = [](std::size_t) -> double {
        ADD_FAILURE();
        return 9.0;
    };
    EXPECT_EQ(tree.greatest(
                  3.0, [](const Vec3&, double) { return 3.0; }, fails),
              3.0);
}

}  // namespace
}  // namespace beltgrinding

#include "mesh/topology.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

#include "beltgrinding/error.h"
#include "mesh/mesh_check.h"

namespace beltgrinding {
namespace {

TEST(DisjointSets, TheLowestStandsForASetWhateverTheOrderOfJoins) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> joins = {{7, 3}, {3, 9}, {1, 2},
                                                                  {9, 8}, {4, 4}, {2, 1}};
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        std::shuffle(joins.begin(), joins.end(), random);
        DisjointSets sets(10);
        for (const auto& [a, b] : joins) round % 2 == 0 ? sets.join(a, b) : sets.join(b, a);
        const std::array<std::uint32_t, 10> expected{0, 1, 1, 3, 4, 5, 6, 3, 3, 3};
        for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(sets.find(i), expected[i]) << i;
    }
    DisjointSets growing;
    EXPECT_EQ(growing.add(), 0U);
    EXPECT_EQ(growing.add(), 1U);
    growing.join(1, 0);
    EXPECT_EQ(growing.find(1), 0U);
}

TEST(Topology, EdgeKeyIsTheSameBothWays) {
    EXPECT_EQ(edge_key(5, 2), edge_key(2, 5));
    EXPECT_EQ(edge_key(2, 5), (std::uint64_t{2} << 32U) + 5U);
    EXPECT_LT(edge_key(2, 0xFFFFFFFFU), edge_key(3, 4));
}

TEST(Topology, TrianglesAtEachVertexAscend) {
    const VertexTriangles around(5, {{0, 1, 2}, {2, 1, 3}, {0, 2, 3}});
    const auto of = [&](std::uint32_t v) {
        return std::vector<std::uint32_t>(around.of(v).begin(), around.of(v).end());
    };
    EXPECT_EQ(of(0), (std::vector<std::uint32_t>{0, 2}));
    EXPECT_EQ(of(2), (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(of(3), (std::vector<std::uint32_t>{1, 2}));
    EXPECT_TRUE(of(4).empty());
    EXPECT_TRUE(VertexTriangles(1, {}).of(0).empty());
}

TEST(Topology, WeldsEqualKeysInAscendingOrder) {
    EXPECT_EQ(weld(std::vector<int>{30, 10, 30, 20, 10}),
              (std::vector<std::uint32_t>{2, 0, 2, 1, 0}));
    EXPECT_EQ(weld(std::vector<std::array<float, 1>>{{0.0F}, {-0.0F}, {-1.0F}}),
              (std::vector<std::uint32_t>{1, 1, 0}));  // both zeros are one place
    EXPECT_TRUE(weld(std::vector<int>{}).empty());
}

TEST(Topology, ALevelLeavesAndEntersATriangle) {
    for (unsigned bits = 0; bits < 8; ++bits) {
        const std::array<bool, 3> above{(bits & 1U) != 0, (bits & 2U) != 0, (bits & 4U) != 0};
        const auto crossing = triangle_crossing(above);
        ASSERT_EQ(crossing.has_value(), bits != 0 && bits != 7) << bits;
        if (!crossing) continue;
        const auto& [leaves, enters] = *crossing;
        EXPECT_EQ(leaves[1], (leaves[0] + 1) % 3);
        EXPECT_EQ(enters[1], (enters[0] + 1) % 3);
        EXPECT_TRUE(above[leaves[0]] && !above[leaves[1]]) << bits;
        EXPECT_TRUE(!above[enters[0]] && above[enters[1]]) << bits;
    }
}

TEST(MeshCheck, OfATetrahedronWholeOpenTurnedAndDouble) {
    const std::vector<Vec3> corner = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<Triangle> faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    MeshCheck check = check_mesh(corner, faces);
    EXPECT_TRUE(check.closed());
    EXPECT_EQ(check.euler, 2);
    EXPECT_EQ(check.components, 1U);
    EXPECT_NEAR(check.volume, 1.0 / 6.0, 1e-15);
    std::swap(faces[3][0], faces[3][1]);
    EXPECT_EQ(check_mesh(corner, faces).turned_edges, 3U);
    faces.pop_back();
    EXPECT_EQ(check_mesh(corner, faces).border_edges, 3U);
    faces = {{0, 1, 2}, {0, 1, 3}, {1, 0, 2}, {3, 2, 1}};
    EXPECT_EQ(check_mesh(corner, faces).non_manifold_edges, 2U);
    EXPECT_THROW(check_mesh(corner, {{0, 1, 4}}), InputError);
}

}  // namespace
}  // namespace beltgrinding

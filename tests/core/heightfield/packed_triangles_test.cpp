#include "beltgrinding/packed_triangles.h"

#include <gtest/gtest.h>

#include <random>

#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

void expect_same(const PackedTriangles& packed, const std::vector<Triangle>& triangles) {
    ASSERT_EQ(packed.size(), triangles.size());
    EXPECT_EQ(packed.empty(), triangles.empty());
    for (std::size_t i = 0; i < triangles.size(); ++i) ASSERT_EQ(packed[i], triangles[i]) << i;
    EXPECT_EQ(packed.unpacked(), triangles);
    PackedTriangles one_by_one;
    for (const Triangle& t : packed) one_by_one.push_back(t);
    EXPECT_EQ(one_by_one, packed);
}

TEST(PackedTriangles, GiveBackWhateverTheyAreMadeOf) {
    std::mt19937 random(3);
    for (const std::uint32_t most : {0U, 1U, 2U, 1000U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
        std::uniform_int_distribution<std::uint32_t> corner(0, most);
        for (const std::size_t count : {0, 1, 63, 64, 65, 128, 1000}) {
            std::vector<Triangle> triangles(count);
            for (Triangle& t : triangles) t = {corner(random), corner(random), corner(random)};
            expect_same(PackedTriangles(triangles), triangles);
        }
    }
}

TEST(PackedTriangles, OfEachWidthOfBits) {
    for (std::uint32_t bits = 0; bits <= 32; ++bits) {
        const auto most = static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1);
        std::vector<Triangle> triangles;
        for (std::uint32_t k = 0; k < 200; ++k)
            triangles.push_back({k % 3 == 0 ? most : 0, k % 2 == 0 ? most : most / 2, 7});
        expect_same(PackedTriangles(triangles), triangles);
    }
}

TEST(PackedTriangles, OfALatticeTakeAThird) {
    const HeightField field = testing::plate(300.0, 200.0, 0.5);
    expect_same(field.triangles, field.triangles.unpacked());
    PackedTriangles made = field.triangles;
    made.shrink_to_fit();
    EXPECT_LT(made.bytes(), made.size() * sizeof(Triangle) / 3);
    EXPECT_FALSE(made == PackedTriangles());
}

}  // namespace
}  // namespace beltgrinding

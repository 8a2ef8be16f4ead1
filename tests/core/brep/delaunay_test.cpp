#include "delaunay.h"

#include <gtest/gtest.h>

#include <random>

namespace beltgrinding {
namespace {

double twice_area(const Delaunay& d, const std::vector<GridPoint>& p) {
    double sum = 0;
    for (const auto& f : d.faces())
        if (Delaunay::inner(f)) {
            const auto size = orient(p[Delaunay::point(f, 0)], p[Delaunay::point(f, 1)],
                                     p[Delaunay::point(f, 2)]);
            EXPECT_GT(size, 0);
            sum += double(size);
        }
    return sum;
}

TEST(Delaunay, TriangulatesGridsFullOfTies) {
    std::vector<GridPoint> points;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) points.push_back({x * 1000, y * 1000});
    points.push_back({5000, 5000});
    const Delaunay d(points);
    EXPECT_EQ(d.canonical(1600), d.canonical(5 * 40 + 5));
    EXPECT_EQ(twice_area(d, points), 2.0 * 39000 * 39000);
}

TEST(Delaunay, CircumcirclesAreEmpty) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> at(0, 1 << 20);
    std::vector<GridPoint> points;
    for (int i = 0; i < 300; ++i) points.push_back({at(random), at(random)});
    const Delaunay d(points);
    for (const auto& f : d.faces()) {
        if (!Delaunay::inner(f)) continue;
        const GridPoint a = points[Delaunay::point(f, 0)], b = points[Delaunay::point(f, 1)],
                        c = points[Delaunay::point(f, 2)];
        const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
        const double det = 2 * (bx * cy - by * cx);
        const double ux = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / det;
        const double uy = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / det;
        for (const GridPoint& q : points)
            ASSERT_GT(std::hypot(q.x - a.x - ux, q.y - a.y - uy), std::hypot(ux, uy) * (1 - 1e-9));
    }
}

TEST(Delaunay, ConstraintsBecomeEdges) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> at(0, 1 << 20);
    std::vector<GridPoint> points{
        {0, 0}, {1 << 20, 1 << 20}, {1 << 19, 1 << 19}, {0, 1 << 20}, {1 << 20, 1}};
    for (int i = 0; i < 500; ++i) points.push_back({at(random), at(random)});
    Delaunay d(points);
    const double area = twice_area(d, points);
    EXPECT_TRUE(d.constrain(0, 1));   // through point 2, which lies exactly on it
    EXPECT_FALSE(d.constrain(3, 4));  // crosses it
    EXPECT_EQ(twice_area(d, points), area);
    const auto has = [&](std::uint32_t a, std::uint32_t b) {
        for (const auto& f : d.faces())
            for (int i = 0; i < 3 && Delaunay::inner(f); ++i)
                if (Delaunay::point(f, i) == a && Delaunay::point(f, (i + 1) % 3) == b &&
                    (f.fixed >> ((i + 2) % 3) & 1))
                    return true;
        return false;
    };
    EXPECT_TRUE(has(0, 2) && has(2, 0));
    EXPECT_TRUE(has(2, 1) && has(1, 2));
}

}  // namespace
}  // namespace beltgrinding

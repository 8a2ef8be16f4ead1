#include "point_cells.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace beltgrinding {
namespace {

/// `across` by `across` points, `apart` mm from each other, on a plate or a tilted one.
std::vector<Vec3> lattice(int across, double apart, double slope = 0.0) {
    std::vector<Vec3> points;
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < across; ++i)
            points.emplace_back(i * apart, j * apart, slope * i * apart);
    return points;
}

std::vector<std::size_t> points_in(const PointCells& cells, const Box& box) {
    std::vector<std::size_t> found;
    cells.in(box, [&](std::size_t i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    return found;
}

TEST(PointCells, ACellHasAboutTheSamePointsWhateverTheirDensity) {
    for (const double apart : {0.01, 0.5, 20.0}) {
        for (const int across : {50, 200}) {
            const std::vector<Vec3> points = lattice(across, apart);
            const PointCells cells(points);
            const Vec3 middle = points[points.size() / 2 + static_cast<std::size_t>(across) / 2];
            const std::size_t found = points_in(cells, Box(middle, middle)).size();
            EXPECT_GE(found, 2U) << apart << ' ' << across;
            EXPECT_LE(found, 20U) << apart << ' ' << across;
        }
    }
}

TEST(PointCells, FindsAllPointsOfABox) {
    for (const double slope : {0.0, 0.7}) {
        const std::vector<Vec3> points = lattice(60, 0.5, slope);
        const PointCells cells(points);
        const Box box(Vec3(3.1, 4.2, -1.0), Vec3(9.3, 12.4, 30.0));
        const std::vector<std::size_t> found = points_in(cells, box);
        std::size_t inside = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!box.contains(points[i])) continue;
            ++inside;
            EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << points[i].transpose();
        }
        EXPECT_LT(found.size(), 2 * inside);  // and few besides
    }
}

}  // namespace
}  // namespace beltgrinding

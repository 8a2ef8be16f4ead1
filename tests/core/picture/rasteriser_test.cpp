#include "rasteriser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace beltgrinding {
namespace {

/// Of a vertex: eighths of a column, eighths of a row, quarters of a mm before (-) or behind.
using Place = std::array<std::int64_t, 3>;

/// Meshes whose vertices lie on a lattice of eighths of the rays' distance: all that is computed of
/// them is exact, so that rays on edges and vertices are as certain as others.
struct Lattice {
    std::vector<Place> places;
    std::vector<Triangle> triangles;
};

constexpr std::int64_t kParts = 8;  // of a ray's distance
constexpr double kQuarter = 0.25;   // mm

RayGrid grid_of(std::uint32_t columns, std::uint32_t rows, double start) {
    return {{4, -2, 8}, {0.25, 0, 0}, {0, -0.25, 0}, {0, 0, -1}, start, columns, rows};
}

std::vector<Vec3> vertices_of(const Lattice& lattice, const RayGrid& grid) {
    std::vector<Vec3> vertices;
    for (const Place& p : lattice.places) {
        vertices.push_back(grid.corner + static_cast<double>(p[0]) / double{kParts} * grid.right +
                           static_cast<double>(p[1]) / double{kParts} * grid.down +
                           kQuarter * static_cast<double>(p[2]) * grid.into);
    }
    return vertices;
}

/// What a ray meets of each triangle by itself, in whole numbers.
struct Meeting {
    std::uint32_t triangle;
    double depth, u, v;
};

/// `flat`: each triangle lies across the rays.
Lattice random_lattice(std::uint32_t count, bool flat, std::mt19937& random) {
    std::uniform_int_distribution<std::int64_t> middle(-40, 400), size(-90, 90), depth(-40, 40);
    Lattice lattice;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::int64_t x = middle(random), y = middle(random), z = depth(random);
        // A third of the corners lie on rays; every fifth triangle is small.
        const std::int64_t step = i % 3 == 0 ? kParts : 1, part = i % 5 == 0 ? 9 : 1;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::int64_t there = flat ? z : z + size(random) / 10;
            lattice.places.push_back({(x + size(random) / part) / step * step,
                                      (y + size(random) / part) / step * step, there});
        }
        Place* const corner = &lattice.places[3 * std::size_t{i}];
        if (i % 11 == 0) corner[2] = corner[i % 2];          // no area: a line
        if (i % 13 == 0) corner[1] = corner[2] = corner[0];  // a point
        if (i % 17 == 0)                                     // three in a row
            for (std::size_t k = 0; k < 3; ++k) corner[2][k] = 2 * corner[1][k] - corner[0][k];
        lattice.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return lattice;
}

std::vector<Meeting> meetings(const std::vector<Lattice>& meshes, std::int64_t column,
                              std::int64_t row, double start) {
    std::vector<Meeting> found;
    std::uint32_t number = 0;
    for (const Lattice& mesh : meshes) {
        for (const Triangle& t : mesh.triangles) {
            const Place &a = mesh.places[t[0]], &b = mesh.places[t[1]], &c = mesh.places[t[2]];
            const std::int64_t x = kParts * column, y = kParts * row;
            const auto turn = [x, y](const Place& p, const Place& q) {
                return (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
            };
            std::int64_t wa = turn(b, c), wb = turn(c, a), wc = turn(a, b);
            if (wa + wb + wc < 0) wa = -wa, wb = -wb, wc = -wc;
            const std::int64_t whole = wa + wb + wc, number_of = number++;
            if (whole == 0 || wa < 0 || wb < 0 || wc < 0) continue;
            const double depth = kQuarter * static_cast<double>(wa * a[2] + wb * b[2] + wc * c[2]) /
                                 static_cast<double>(whole);
            if (depth < -start) continue;
            found.push_back({static_cast<std::uint32_t>(number_of), depth,
                             static_cast<double>(wb) / static_cast<double>(whole),
                             static_cast<double>(wc) / static_cast<double>(whole)});
        }
    }
    return found;
}

/// Compares every ray with every triangle; returns how many rays meet one.
std::size_t compare(Rasteriser& rasteriser, const std::vector<Lattice>& lattices,
                    const RayGrid& grid, std::uint32_t band, double tolerance) {
    std::vector<std::vector<Vec3>> vertices;
    std::vector<Rasteriser::Mesh> meshes;
    for (const Lattice& lattice : lattices) vertices.push_back(vertices_of(lattice, grid));
    for (std::size_t k = 0; k < lattices.size(); ++k)
        meshes.push_back({vertices[k], lattices[k].triangles});
    rasteriser.lay_out(meshes, grid, band, {});
    EXPECT_EQ(rasteriser.bands(), (grid.rows - 1 + band - 1) / band);
    std::vector<RayHit> hits(std::size_t{band + 1} * grid.columns);
    std::size_t met = 0;
    for (std::uint32_t b = 0; b < rasteriser.bands(); ++b) {
        rasteriser.rasterise(b, hits);
        for (std::uint32_t row = b * band; row <= std::min((b + 1) * band, grid.rows - 1); ++row) {
            for (std::uint32_t column = 0; column < grid.columns; ++column) {
                const RayHit& hit = hits[std::size_t{row - b * band} * grid.columns + column];
                const Meeting* nearest = nullptr;
                const auto all = meetings(lattices, column, row, grid.start);
                for (const Meeting& one : all)
                    if (nearest == nullptr || one.depth < nearest->depth) nearest = &one;
                EXPECT_EQ(hit.met(), nearest != nullptr) << column << " " << row;
                if (nearest == nullptr || !hit.met()) continue;
                met += row < (b + 1) * band || b + 1 == rasteriser.bands() ? 1 : 0;
                EXPECT_NEAR(hit.depth, nearest->depth, tolerance) << column << " " << row;
                for (const Meeting& one : all) {  // of those as near the one that it names
                    if (one.triangle == hit.triangle) nearest = &one;
                }
                EXPECT_EQ(hit.triangle, nearest->triangle) << column << " " << row;
                EXPECT_NEAR(hit.depth, nearest->depth, tolerance);
                EXPECT_NEAR(hit.u, nearest->u, 1e-6) << column << " " << row;
                EXPECT_NEAR(hit.v, nearest->v, 1e-6) << column << " " << row;
                if (tolerance > 0.0) continue;
                for (const Meeting& one : all)  // the first of them
                    EXPECT_FALSE(one.depth == hit.depth && one.triangle < hit.triangle);
            }
        }
    }
    return met;
}

TEST(Rasteriser, MeetsWhatEveryTriangleByItselfWould) {
    std::mt19937 random(5);
    Rasteriser rasteriser;  // used again, for grids of other sizes
    for (const bool flat : {true, false}) {
        for (const std::uint32_t band : {1U, 4U, 7U, 64U}) {
            const std::vector<Lattice> meshes{random_lattice(60, flat, random),
                                              {},
                                              {{{0, 0, 0}, {90, 0, 0}}, {}},
                                              random_lattice(60, flat, random)};
            const RayGrid grid = grid_of(40 + band % 4, 41, flat ? 1e9 : 6.0);
            EXPECT_GT(compare(rasteriser, meshes, grid, band, flat ? 0.0 : 1e-5),
                      std::size_t{grid.columns} * 10);
        }
    }
}

TEST(Rasteriser, MeetsEdgesAndCornersThatLieOnRays) {
    // One triangle, every way round, its corners on rays: on the outline, and nowhere beyond it.
    const std::vector<Place> corners{{8, 8, 0}, {56, 16, 4}, {24, 64, 8}};
    for (const Triangle& t : {Triangle{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}}) {
        Rasteriser rasteriser;
        EXPECT_GT(compare(rasteriser, {{corners, {t}}}, grid_of(9, 10, 10.0), 3, 1e-6), 15U);
    }
    // Right angles along a row and a column of rays.
    Rasteriser rasteriser;
    EXPECT_EQ(compare(rasteriser, {{{{8, 8, 0}, {24, 8, 0}, {8, 24, 0}}, {{0, 1, 2}}}},
                      grid_of(9, 10, 10.0), 3, 0.0),
              6U);
}

TEST(Rasteriser, MeetsNothingOfWhatHasNoArea) {
    const Lattice flat{{{0, 0, 0}, {64, 64, 4}, {32, 32, 2}, {0, 0, 0}, {64, 0, 0}},
                       {{0, 1, 2}, {0, 3, 1}, {0, 0, 0}, {0, 4, 4}}};
    Rasteriser rasteriser;
    EXPECT_EQ(compare(rasteriser, {flat}, grid_of(9, 9, 10.0), 4, 0.0), 0U);
    EXPECT_EQ(compare(rasteriser, {}, grid_of(9, 9, 10.0), 4, 0.0), 0U);
    EXPECT_EQ(compare(rasteriser, {{}, {}}, grid_of(9, 9, 10.0), 4, 0.0), 0U);
}

TEST(Rasteriser, PassesOverBoxesBesideThePictureAndNothingElse) {
    std::mt19937 random(9);
    Lattice lattice = random_lattice(40 * kTrianglesOfBox + 7, false, random);
    // Neighbours lie together, as those of a surface do; some boxes far away, or without end.
    for (std::size_t i = 0; i < lattice.places.size(); ++i) {
        const auto box = static_cast<std::int64_t>(i / 3 / kTrianglesOfBox);
        for (std::size_t k = 0; k < 2; ++k)
            lattice.places[i][k] =
                lattice.places[i][k] / 3 + (k == 0 ? box % 7 : box / 7) * 140 - 300;
    }
    const Lattice few = random_lattice(9, true, random);
    for (const auto& [columns, rows] :
         {std::pair(20U, 30U), {9U, 120U}, {130U, 8U}, {200U, 200U}}) {
        const RayGrid grid = grid_of(columns, rows, 6.0);
        std::vector<Vec3> vertices = vertices_of(lattice, grid), others = vertices_of(few, grid);
        vertices[3 * kTrianglesOfBox] = {1e300, -1e300, 0.0};
        const auto boxes = boxes_of(vertices, lattice.triangles);
        const auto other_boxes = boxes_of(others, few.triangles);
        Rasteriser all, chosen;
        all.lay_out(
            std::vector<Rasteriser::Mesh>{{others, few.triangles}, {vertices, lattice.triangles}},
            grid, 8, {});
        // The corners of an earlier, wider picture are no longer there.
        chosen.lay_out(std::vector<Rasteriser::Mesh>{{others, few.triangles}}, grid_of(9, 9, 1.0),
                       8, {});
        chosen.lay_out(std::vector<Rasteriser::Mesh>{{others, few.triangles, other_boxes},
                                                     {vertices, lattice.triangles, boxes}},
                       grid, 8, {});
        std::vector<RayHit> wanted(std::size_t{9} * columns), hits(wanted.size());
        std::size_t met = 0;
        for (std::uint32_t b = 0; b < all.bands(); ++b) {
            all.rasterise(b, wanted);
            chosen.rasterise(b, hits);
            for (std::size_t i = 0; i < hits.size(); ++i) {
                met += wanted[i].met() ? 1 : 0;
                EXPECT_EQ(hits[i].depth, wanted[i].depth);
                EXPECT_EQ(hits[i].triangle, wanted[i].triangle);
                EXPECT_EQ(hits[i].u, wanted[i].u);
                EXPECT_EQ(hits[i].v, wanted[i].v);
            }
        }
        EXPECT_GT(met, 20U);
    }
}

TEST(Rasteriser, LeavesOutWhatNoNumberHolds) {
    // Finite, and so far away that single precision has no number for it.
    const std::vector<Vec3> vertices{{1e300, 0, 0}, {0, 1e300, 0}, {4, -2, 8}};
    const std::vector<Triangle> triangles{{0, 1, 2}};
    Rasteriser rasteriser;
    rasteriser.lay_out(std::vector<Rasteriser::Mesh>{{vertices, triangles}}, grid_of(9, 9, 10.0), 8,
                       {});
    std::vector<RayHit> hits(81);
    rasteriser.rasterise(0, hits);
    for (const RayHit& hit : hits) EXPECT_FALSE(std::isnan(hit.depth));
}

}  // namespace
}  // namespace beltgrinding

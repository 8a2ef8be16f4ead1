#include "raster/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

using std::numbers::pi;

struct Sample {
    Vec3 point, normal;
    double scalar = 0.0;
};

/// nu x nv quads over [0, 1]^2 as triangles; `keep` says which quads are there, by their middle.
/// `closed`: the last column is the first one again, its scalar a period on.
RasterSurface patch(int nu, int nv, const std::function<Sample(double, double)>& at,
                    const std::function<bool(double, double)>& keep = {}, bool closed = false,
                    double period = 0.0) {
    RasterSurface surface;
    surface.period = period;
    std::vector<double> scalar;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu - (closed ? 1 : 0); ++i) {
            const Sample s = at(double(i) / nu, double(j) / nv);
            surface.point.push_back(s.point);
            surface.normal.push_back(s.normal);
            scalar.push_back(s.scalar);
        }
    const int columns = closed ? nu : nu + 1;
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(j * columns + (closed ? i % nu : i));
    };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            if (keep && !keep((i + 0.5) / nu, (j + 0.5) / nv)) continue;
            const std::uint32_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1),
                                d = index(i, j + 1);
            for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
                surface.triangles.push_back(t);
                surface.scalar.push_back({scalar[t[0]], scalar[t[1]], scalar[t[2]]});
            }
        }
    return surface;
}

double distance_to(const RasterLine& line, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.point.size(); ++i) {
        const Vec3 way = line.point[i + 1] - line.point[i];
        const double length = way.squaredNorm();
        const double w =
            length > 0 ? std::clamp((p - line.point[i]).dot(way) / length, 0.0, 1.0) : 0.0;
        least = std::min(least, (p - line.point[i] - w * way).norm());
    }
    return least;
}

/// The largest distance of a used vertex from the nearest pass. `counts` leaves out what lies at a
/// border that passes meet at a slant: beyond their ends, the distance is longer.
double farthest(const RasterSurface& surface, const std::vector<RasterLine>& lines,
                const std::function<bool(const Vec3&)>& counts = {}) {
    double worst = 0.0;
    for (const Triangle& t : surface.triangles)
        for (const std::uint32_t v : t) {
            if (counts && !counts(surface.point[v])) continue;
            double least = std::numeric_limits<double>::infinity();
            for (const RasterLine& line : lines)
                least = std::min(least, distance_to(line, surface.point[v]));
            worst = std::max(worst, least);
        }
    return worst;
}

std::map<std::size_t, int> pieces(const RasterLines& found) {
    std::map<std::size_t, int> count;
    for (const RasterLine& line : found.lines) ++count[line.level];
    return count;
}

RasterOptions options(double step_over, RasterSpacing spacing) {
    RasterOptions o;
    o.step_over = step_over;
    o.spacing = spacing;
    return o;
}

constexpr RasterSpacing kBoth[] = {RasterSpacing::kLines, RasterSpacing::kEven};

Sample on_plate(double u, double v) {  // 100 x 60 mm, passes along x
    return {Vec3(100 * u, 60 * v, 0), Vec3::UnitZ(), 60 * v};
}

TEST(Raster, LiesEvenlyOnAPlateWithAHole) {
    const auto keep = [](double u, double v) {
        return std::hypot(100 * u - 50, 60 * v - 30) > 12.0;
    };
    const RasterSurface plate = patch(100, 60, on_plate, keep);
    for (const RasterSpacing spacing : kBoth) {
        const RasterLines found = raster_lines(plate, options(10.0, spacing));
        EXPECT_NEAR(found.uncovered_area, 0.0, 1e-9);
        for (const double d : found.distance) EXPECT_LE(d, 10.0 + 1e-9);
        if (spacing == RasterSpacing::kLines) {
            ASSERT_EQ(found.distance.size(), 6u);
            const auto count = pieces(found);
            for (const std::size_t level : {0u, 1u, 4u, 5u}) EXPECT_EQ(count.at(level), 1) << level;
            for (const std::size_t level : {2u, 3u}) EXPECT_EQ(count.at(level), 2) << level;
            for (const RasterLine& line : found.lines) {
                for (std::size_t i = 0; i < line.point.size(); ++i) {
                    EXPECT_NEAR(line.point[i].y(), 5.0 + 10.0 * double(line.level), 0.02);
                    EXPECT_NEAR(line.tangent[i].x(), 1.0, 1e-9);  // higher y to the left
                    EXPECT_NEAR(line.normal[i].z(), 1.0, 1e-12);
                }
                EXPECT_FALSE(line.closed);
                EXPECT_LT(line.point.front().x(), line.point.back().x());
            }
        }
        const auto off_the_hole = [](const Vec3& p) {
            return std::hypot(p.x() - 50, p.y() - 30) > 17;
        };
        EXPECT_LT(farthest(plate, found.lines, off_the_hole), 5.1);
    }
}

constexpr double kRadius = 20.0;

Sample on_cylinder(double u, double v, bool around) {
    const double t = 2 * pi * u;
    const Vec3 normal(std::cos(t), std::sin(t), 0);
    return {kRadius * normal + Vec3(0, 0, 50 * v), normal, around ? t : 50 * v};
}

TEST(Raster, CrossesTheSeamOfACylinder) {
    const RasterSurface along = patch(
        120, 50, [](double u, double v) { return on_cylinder(u, v, true); }, {}, true, 2 * pi);
    for (const RasterSpacing spacing : kBoth) {
        const RasterLines found = raster_lines(along, options(7.0, spacing));
        const auto count = static_cast<std::size_t>(std::ceil(2 * pi * kRadius / 7.0));
        EXPECT_EQ(found.distance.size(), count);
        ASSERT_EQ(found.lines.size(), count);
        for (const RasterLine& line : found.lines) {
            EXPECT_NEAR(std::abs(line.point.front().z() - line.point.back().z()), 50.0, 1e-9);
            EXPECT_FALSE(line.closed);
        }
        EXPECT_LT(farthest(along, found.lines), 3.55);
    }
    const RasterSurface around = patch(
        120, 50, [](double u, double v) { return on_cylinder(u, v, false); }, {}, true);
    const RasterLines rings = raster_lines(around, options(10.0, RasterSpacing::kLines));
    ASSERT_EQ(rings.lines.size(), 5u);
    for (const RasterLine& line : rings.lines) {
        EXPECT_TRUE(line.closed);
        EXPECT_LT((line.point.front() - line.point.back()).norm(), 1e-9);
        for (std::size_t i = 0; i < line.point.size(); ++i) {
            EXPECT_NEAR(line.normal[i].dot(line.point[i]), kRadius, 0.02);
            EXPECT_NEAR(std::abs(line.tangent[i].cross(line.normal[i]).z()), 1.0, 1e-6);
        }
    }
}

Sample on_sphere(double u, double v) {  // up to 60 degrees from the pole, about x and y
    const double a = pi / 3 * (2 * u - 1), b = pi / 3 * (2 * v - 1);
    const Vec3 normal = Vec3(std::tan(a), std::tan(b), 1).normalized();
    return {50 * normal, normal, 50 * normal.y()};
}

TEST(Raster, CoversASphereWithinHalfAStepOver) {
    const RasterSurface cap = patch(120, 120, on_sphere);
    for (const RasterSpacing spacing : kBoth) {
        const RasterLines found = raster_lines(cap, options(8.0, spacing));
        const auto inner = [](const Vec3& p) {
            return std::max(std::abs(p.x()), std::abs(p.y())) < 1.5 * p.z();
        };
        EXPECT_LT(farthest(cap, found.lines, inner), 4.0 * 1.03);
        for (const RasterLine& line : found.lines)
            for (std::size_t i = 0; i < line.point.size(); ++i)
                EXPECT_NEAR(line.normal[i].dot(line.point[i].normalized()), 1.0, 1e-4);
    }
    // Planes are nearer to each other where the surface is steeper; even passes are not.
    const RasterLines even = raster_lines(cap, options(8.0, RasterSpacing::kEven));
    for (std::size_t k = 0; k + 1 < even.lines.size(); ++k) {
        if (even.lines[k].level + 1 != even.lines[k + 1].level) continue;
        const RasterLine& line = even.lines[k];
        const std::size_t n = line.point.size();
        for (std::size_t i = n / 4; i < 3 * n / 4; ++i)
            EXPECT_NEAR(distance_to(even.lines[k + 1], line.point[i]), even.distance[line.level],
                        0.03 * even.distance[line.level]);
    }
}

/// Two plates of 40 x 40 mm that meet at x = 40 under `turn`, each with its own vertices there.
RasterSurface folded(double turn) {
    RasterSurface both = patch(40, 40, [](double u, double v) {
        return Sample{Vec3(40 * u, 40 * v, 0), Vec3::UnitZ(), 40 * v};
    });
    const RasterSurface second = patch(40, 40, [&](double u, double v) {
        return Sample{Vec3(40 + 40 * u * std::cos(turn), 40 * v, -40 * u * std::sin(turn)),
                      Vec3(std::sin(turn), 0, std::cos(turn)), 40 * v};
    });
    const auto base = static_cast<std::uint32_t>(both.point.size());
    both.point.insert(both.point.end(), second.point.begin(), second.point.end());
    both.normal.insert(both.normal.end(), second.normal.begin(), second.normal.end());
    for (const Triangle& t : second.triangles)
        both.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    both.scalar.insert(both.scalar.end(), second.scalar.begin(), second.scalar.end());
    return both;
}

TEST(Raster, RunsOverAnEdgeBetweenFacesOrEndsThere) {
    for (const RasterSpacing spacing : kBoth) {
        RasterOptions o = options(10.0, spacing);
        o.weld = 0.1;
        EXPECT_EQ(raster_lines(folded(0.3), o).lines.size(), 4u);
        const RasterLines split = raster_lines(folded(1.2), o);
        EXPECT_EQ(split.distance.size(), 4u);
        EXPECT_EQ(split.lines.size(), 8u);
        o.smoothing = 20.0;
        const RasterLines smooth = raster_lines(folded(0.3), o);
        ASSERT_EQ(smooth.lines.size(), 4u);
        for (const RasterLine& line : smooth.lines)
            for (std::size_t i = 1; i < line.point.size(); ++i) {
                const double way = (line.point[i] - line.point[i - 1]).norm();
                const double turn =
                    std::acos(std::min(1.0, line.normal[i].dot(line.normal[i - 1])));
                EXPECT_LT(turn, 1.1 * 0.3 * way / 20.0 + 1e-6);
            }
    }
    RasterOptions apart = options(10.0, RasterSpacing::kLines);
    EXPECT_EQ(raster_lines(folded(0.3), apart).lines.size(), 8u);  // nothing is welded
}

TEST(Raster, SaysWhatItsPlanesCannotReach) {
    // A plate and a wall that the planes y = constant run along.
    RasterSurface plate = patch(40, 40, [](double u, double v) {
        return Sample{Vec3(40 * u, 40 * v, 0), Vec3::UnitZ(), 40 * v};
    });
    const RasterSurface wall = patch(40, 40, [](double u, double v) {
        return Sample{Vec3(40 * u, 40, 10 * v), -Vec3::UnitY(), 40};
    });
    const auto base = static_cast<std::uint32_t>(plate.point.size());
    plate.point.insert(plate.point.end(), wall.point.begin(), wall.point.end());
    plate.normal.insert(plate.normal.end(), wall.normal.begin(), wall.normal.end());
    for (const Triangle& t : wall.triangles)
        plate.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    plate.scalar.insert(plate.scalar.end(), wall.scalar.begin(), wall.scalar.end());
    const RasterLines found = raster_lines(plate, options(10.0, RasterSpacing::kLines));
    EXPECT_NEAR(found.uncovered_area, 400.0, 1e-6);
    EXPECT_NEAR(found.area, 2000.0, 1e-6);
    EXPECT_EQ(found.distance.size(), 4u);
}

TEST(Raster, LeavesNoPassBetweenSurfacesApart) {
    const auto keep = [](double, double v) { return v < 1.0 / 3 || v > 2.0 / 3; };
    const RasterSurface strips = patch(50, 60, on_plate, keep);
    for (const RasterSpacing spacing : kBoth) {
        const RasterLines found = raster_lines(strips, options(10.0, spacing));
        EXPECT_EQ(found.distance.size(), 4u);
        EXPECT_LT(farthest(strips, found.lines), 5.2);
    }
}

TEST(Raster, LaysLinesOnSomeTrianglesWhereItLaysThemOnAll) {
    for (const RasterSpacing spacing : {RasterSpacing::kLines, RasterSpacing::kEven}) {
        RasterSurface surface = patch(40, 20, [](double u, double v) {
            return Sample{{100 * u, 50 * v, 0}, {0, 0, 1}, 50 * v};
        });
        const RasterOptions close = options(4.0, spacing);
        const RasterLines all = raster_lines(surface, close);
        for (const Triangle& t : surface.triangles)  // the right third
            surface.wanted.push_back(surface.point[t[0]][0] >= 65 && surface.point[t[1]][0] >= 65 &&
                                     surface.point[t[2]][0] >= 65);
        const RasterLines some = raster_lines(surface, close);
        ASSERT_EQ(some.lines.size(), all.lines.size());
        EXPECT_EQ(some.distance, all.distance);
        EXPECT_EQ(some.area, all.area);
        for (std::size_t k = 0; k < all.lines.size(); ++k) {
            double least = 100, most = 0;
            for (const Vec3& p : some.lines[k].point) {
                least = std::min(least, p[0]), most = std::max(most, p[0]);
                EXPECT_NEAR(p[1], all.lines[k].point.front()[1], 1e-9);
            }
            EXPECT_NEAR(least, 65, 2.5);
            EXPECT_NEAR(most, 100, 1e-9);
        }
    }
}

TEST(Raster, ThinsToTheFewestPosesWithinTheLimits) {
    RasterLine arc;
    for (int i = 0; i <= 1000; ++i) {
        const double t = 0.001 * i * pi / 2;
        arc.normal.push_back(Vec3(std::cos(t), std::sin(t), 0));
        arc.tangent.push_back(Vec3(-std::sin(t), std::cos(t), 0));
        arc.point.push_back(50 * arc.normal.back());
    }
    PoseSpacing spacing{0.1, 1e3, 10.0, 0.0};
    const auto turn_of = [&](const std::vector<std::size_t>& kept) {
        double most = 0;
        for (std::size_t k = 1; k < kept.size(); ++k)
            most = std::max(most, 0.001 * pi / 2 * double(kept[k] - kept[k - 1]));
        return most;
    };
    const double by_chord = 2 * std::acos(1 - 0.1 / 50);
    EXPECT_NEAR(turn_of(thin(arc, spacing)), by_chord, 0.004);
    EXPECT_EQ(thin(arc, spacing).back(), 1000u);
    spacing.max_turn = 0.05;
    EXPECT_NEAR(turn_of(thin(arc, spacing)), 0.05, 0.002);
    spacing.max_distance = 1.0;
    EXPECT_NEAR(turn_of(thin(arc, spacing)), 1.0 / 50, 0.002);
    // A lever of 400 mm: t^2 (50 + 400) / 8 = 0.1.
    spacing = {0.1, 1e3, 10.0, 400.0};
    EXPECT_NEAR(turn_of(thin(arc, spacing)), std::sqrt(0.8 / 450), 0.003);
}

TEST(Raster, RefusesWhatIsNone) {
    const RasterSurface plate = patch(10, 10, on_plate);
    EXPECT_THROW(raster_lines(plate, options(0.0, RasterSpacing::kLines)), InputError);
    EXPECT_THROW(raster_lines(plate, options(1e-6, RasterSpacing::kEven)), InputError);
    RasterSurface short_of_one = plate;
    short_of_one.wanted.assign(plate.triangles.size() - 1, 1);
    EXPECT_THROW(raster_lines(short_of_one, options(5.0, RasterSpacing::kLines)), InputError);
    const RunContext context;
    context.cancel();
    EXPECT_THROW(raster_lines(plate, options(5.0, RasterSpacing::kEven), context), Cancelled);
}

}  // namespace
}  // namespace beltgrinding

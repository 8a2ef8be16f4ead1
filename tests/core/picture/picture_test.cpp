#include "picture/picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/threads.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr std::uint32_t kRed = 0xC04020FF, kBlue = 0x2040C0FF;

/// A square of `side` mm around (x, 0, z), its normal along z.
ColouredSurface square(double side, double x, double z, std::uint32_t colour) {
    const double h = 0.5 * side;
    return {{{x - h, -h, z}, {x + h, -h, z}, {x + h, h, z}, {x - h, h, z}},
            {{0, 1, 2}, {0, 2, 3}},
            {},
            {colour}};
}

std::array<int, 3> pixel(const Picture& picture, std::size_t x, std::size_t y) {
    const std::size_t at = 3 * (y * picture.width + x);
    return {picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
}

float depth(const Picture& picture, std::size_t x, std::size_t y) {
    return picture.depth[y * picture.width + x];
}

// Looks down on the plane z = 0: 1 pixel is 0.1 mm.
const Camera kFromAbove{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 10.0};

TEST(Renderer, DrawsASquareWhereItIs) {
    const Renderer renderer({square(4.0, 1.0, 2.0, kRed)});
    const Picture picture = renderer.render(kFromAbove, 200, 100);
    const std::array<int, 3> white{255, 255, 255};
    // x from -1 to 3 mm: columns 90 to 130; y from -2 to 2 mm: rows 30 to 70.
    EXPECT_EQ(pixel(picture, 87, 50), white);
    EXPECT_EQ(pixel(picture, 132, 50), white);
    EXPECT_EQ(pixel(picture, 110, 27), white);
    EXPECT_EQ(pixel(picture, 110, 72), white);
    EXPECT_TRUE(std::isnan(depth(picture, 87, 50)));
    for (const auto& [x, y] : {std::pair{92, 50}, {127, 50}, {110, 32}, {110, 67}}) {
        const auto [r, g, b] =
            pixel(picture, static_cast<std::size_t>(x), static_cast<std::size_t>(y));
        EXPECT_NEAR(depth(picture, static_cast<std::size_t>(x), static_cast<std::size_t>(y)), -2.0,
                    1e-4);  // 2 mm nearer than the target's plane
        // The light takes all channels down alike.
        EXPECT_GT(r, 150);
        EXPECT_NEAR(static_cast<double>(g) / r, 64.0 / 192.0, 0.01);
        EXPECT_NEAR(static_cast<double>(b) / r, 32.0 / 192.0, 0.01);
    }
    // Its outline is darker than its inside.
    EXPECT_LT(pixel(picture, 110, 30)[0] + pixel(picture, 110, 29)[0],
              2 * pixel(picture, 110, 50)[0]);
}

TEST(Renderer, ShowsWhatIsNearestUnlessItIsCutAway) {
    const Renderer renderer({square(4.0, 0.0, 0.0, kRed), square(2.0, 0.0, 1.0, kBlue)});
    Camera camera = kFromAbove;
    Picture picture = renderer.render(camera, 100, 100);
    EXPECT_GT(pixel(picture, 50, 50)[2], pixel(picture, 50, 50)[0]);
    EXPECT_GT(pixel(picture, 65, 50)[0], pixel(picture, 65, 50)[2]);
    camera.near = 0.5;
    picture = renderer.render(camera, 100, 100);
    EXPECT_GT(pixel(picture, 50, 50)[0], pixel(picture, 50, 50)[2]);
    EXPECT_NEAR(depth(picture, 50, 50), 0.0, 1e-4);
    // From below the nearer one is the other.
    camera = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 10.0};
    picture = renderer.render(camera, 100, 100);
    EXPECT_GT(pixel(picture, 50, 50)[0], pixel(picture, 50, 50)[2]);
}

TEST(Renderer, BlendsTheVerticesColours) {
    ColouredSurface surface = square(8.0, 0.0, 0.0, kRed);
    surface.colours = {kRed, kBlue, kBlue, kRed};
    const Picture picture = Renderer({surface}).render(kFromAbove, 100, 100);
    const auto share = [&](std::size_t x) {
        const auto c = pixel(picture, x, 52);
        return static_cast<double>(c[2]) / (c[0] + c[2]);
    };
    EXPECT_LT(share(15), share(40));
    EXPECT_LT(share(40), share(60));
    EXPECT_LT(share(60), share(85));
    EXPECT_NEAR(share(50), 0.5, 0.02);
}

TEST(Renderer, KeepsItsPrecisionFarFromZero) {
    ColouredSurface near = square(4.0, 1.0, 2.0, kRed), far = near;
    const Vec3 away(3e4, -2e4, 5e4);
    for (Vec3& v : far.vertices) v += away;
    Camera camera = kFromAbove;
    const Picture here = Renderer({near}).render(camera, 120, 100);
    camera.target = away;
    EXPECT_EQ(Renderer({far}).render(camera, 120, 100).rgb, here.rgb);
}

TEST(Renderer, DoesNotDependOnTheNumberOfThreads) {
    ColouredSurface wavy;
    constexpr std::uint32_t n = 120;
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            wavy.vertices.emplace_back(0.1 * i, 0.1 * j, std::sin(0.3 * i) * std::cos(0.2 * j));
            wavy.colours.push_back((i * 2 << 24) | (j * 2 << 16) | 0x80FF);
            if (i + 1 < n && j + 1 < n) {
                const std::uint32_t a = j * n + i;
                wavy.triangles.push_back({a, a + 1, a + n + 1});
                wavy.triangles.push_back({a, a + n + 1, a + n});
            }
        }
    }
    const Camera camera{{6, 6, 0}, {0.3, 0.5, -1}, {0, 0, 1}, 15.0};
    set_threads(1);
    const Picture one = Renderer({wavy}).render(camera, 301, 203);
    set_threads(2);
    const Picture two = Renderer({wavy}).render(camera, 301, 203);
    set_threads(0);
    EXPECT_EQ(one.rgb, two.rgb);
}

TEST(Renderer, RefusesWhatCannotBeDrawn) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(Renderer({}), InputError);
    EXPECT_THROW(Renderer({ColouredSurface{{{0, 0, 0}}, {}, {}, {kRed}}}), InputError);
    ColouredSurface bad = square(1, 0, 0, kRed);
    bad.triangles[0][1] = 4;
    EXPECT_THROW(Renderer({bad}), InputError);
    bad = square(1, 0, 0, kRed);
    bad.vertices[2].y() = nan;
    EXPECT_THROW(Renderer({bad}), InputError);
    bad = square(1, 0, 0, kRed);
    bad.colours = {kRed, kBlue};
    EXPECT_THROW(Renderer({bad}), InputError);
    bad = square(1, 0, 0, kRed);
    bad.normals.resize(3);
    EXPECT_THROW(Renderer({bad}), InputError);

    const Renderer renderer({square(1, 0, 0, kRed)});
    EXPECT_THROW(renderer.render({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, 1.0}, 10, 10), InputError);
    EXPECT_THROW(renderer.render({{0, 0, 0}, {0, 0, nan}, {0, 1, 0}, 1.0}, 10, 10), InputError);
    EXPECT_THROW(renderer.render({{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.0}, 10, 10), InputError);
    EXPECT_THROW(renderer.render(kFromAbove, 0, 10), InputError);
    EXPECT_THROW(renderer.render(kFromAbove, 10, 8193), InputError);
    RunContext context;
    context.cancel();
    EXPECT_THROW(renderer.render(kFromAbove, 10, 10, context), Cancelled);
}

TEST(Renderer, SeesPastWhatDoesNotHideAPoint) {
    // A square of 4 mm, 1 mm above the point: hides it from above, not from the side.
    const Renderer renderer({square(4.0, 0.0, 1.0, kRed), square(20.0, 0.0, 0.0, kBlue)});
    const std::vector<Vec3> points{{0, 0, 0}, {5, 0, 0}};
    const std::vector<Vec3> ways{{0, 0, 2}, {1, 0, 0.2}, {-1, 0, 0.2}, {0, 0, -1}};
    const std::vector<std::uint8_t> expected{0, 1, 1, 1, 1, 1, 0, 1};
    // From below the point's own surface lies within the slack.
    EXPECT_EQ(renderer.seen(points, ways, 0.01), expected);
    EXPECT_EQ(renderer.seen({{0, 0, 0}}, {{0, 0, 1}}, 1.5), std::vector<std::uint8_t>{1});
    EXPECT_TRUE(renderer.seen({}, ways, 0.01).empty());
    std::vector<std::uint8_t> asked(expected.size());
    for (std::size_t k = 0; k < asked.size(); ++k) asked[k] = k % 3 != 0 ? 1 : 0;
    const auto seen = renderer.seen(points, ways, 0.01, asked);
    for (std::size_t k = 0; k < asked.size(); ++k)
        EXPECT_EQ(seen[k], asked[k] != 0 ? expected[k] : 0) << k;
    asked.pop_back();
    EXPECT_THROW(renderer.seen(points, ways, 0.01, asked), InputError);
}

TEST(Renderer, KnowsItsFarthestVertices) {
    const Renderer renderer({square(4.0, 0.0, 1.0, kRed), square(20.0, 0.0, 0.0, kBlue)});
    const std::vector<Vec3> ways{{0, 0, 1}, {1, 1, 0}};
    // Of each surface the first that is no nearer than another, and both ends of its diagonal.
    const std::vector<Vec3> expected{{-2, -2, 1}, {2, 2, 1}, {-10, -10, 0}, {10, 10, 0}};
    EXPECT_EQ(renderer.farthest(ways), expected);
    EXPECT_TRUE(renderer.farthest({}).empty());
}

/// Triangles of all sizes and ways round, in no order, among them flat ones and slivers.
ColouredSurface tangle(std::uint32_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-10.0, 10.0), size(-1.0, 1.0);
    ColouredSurface surface;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 middle(place(random), place(random), place(random));
        const double reach = i % 10 == 0 ? 8.0 : 0.6;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Vec3 away(size(random), size(random), i % 3 == 0 ? 0.0 : size(random));
            surface.vertices.push_back(middle + reach * away);
            surface.colours.push_back(std::uint32_t(random()) | 255U);
        }
        if (i % 7 == 0) surface.vertices.back() = surface.vertices[3 * std::size_t{i}];
        surface.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return surface;
}

/// mm along the ray to each triangle that it meets; `sure`: none is met near its border.
std::vector<double> distances(const ColouredSurface& surface, const Vec3& from, const Vec3& way,
                              bool& sure) {
    constexpr double kBorder = 1e-3;
    std::vector<double> found;
    for (const Triangle& t : surface.triangles) {
        Eigen::Matrix3d sides;
        sides << surface.vertices[t[1]] - surface.vertices[t[0]],
            surface.vertices[t[2]] - surface.vertices[t[0]], -way;
        if (std::abs(sides.determinant()) < 1e-12) continue;
        const Vec3 at = sides.inverse() * (from - surface.vertices[t[0]]);
        const double inside = std::min({at.x(), at.y(), 1.0 - at.x() - at.y()});
        if (std::abs(inside) < kBorder) sure = false;
        if (inside > 0.0) found.push_back(at.z());
    }
    return found;
}

TEST(Renderer, DrawsWhatEveryTriangleByItselfWouldShow) {
    const ColouredSurface surface = tangle(400);
    Camera camera{{1, -2, 0.5}, {0.3, 0.5, -1}, {0.1, 0.2, 1}, 24.0};
    for (const double near : {std::numeric_limits<double>::infinity(), 3.0}) {
        camera.near = near;
        const Picture picture = Renderer({surface}).render(camera, 90, 70);
        const Vec3 into = camera.direction.normalized();
        const Vec3 right = into.cross(camera.up).normalized(), down = into.cross(right);
        const double ray = camera.height / 140.0;
        std::size_t compared = 0, met = 0;
        for (std::size_t y = 0; y < 70; ++y) {
            for (std::size_t x = 0; x < 90; ++x) {
                double nearest = std::numeric_limits<double>::infinity();
                bool sure = true;
                for (int k = 0; k < 4; ++k) {
                    const Vec3 from = camera.target +
                                      ray * (2.0 * double(x) + 0.5 + k % 2 - 90.0) * right +
                                      ray * (2.0 * double(y) + 0.5 + k / 2 - 70.0) * down;
                    for (const double d : distances(surface, from, into, sure)) {
                        if (std::abs(d + near) < 1e-3) sure = false;
                        if (d >= -near) nearest = std::min(nearest, d);
                    }
                }
                if (!sure) continue;
                ++compared;
                if (std::isinf(nearest)) {
                    EXPECT_TRUE(std::isnan(depth(picture, x, y))) << x << " " << y;
                } else {
                    ++met;
                    EXPECT_NEAR(depth(picture, x, y), nearest, 1e-4) << x << " " << y;
                }
            }
        }
        EXPECT_GT(compared, 3000U);
        EXPECT_GT(met, 2000U);
    }
}

TEST(Renderer, LeavesNoGapBetweenNeighbours) {
    // A fan around a point on a ray, its spokes along rows and diagonals of rays: whoever meets an
    // edge must be drawn, on whichever side.
    ColouredSurface fan{{{0.05, 0.05, 0}}, {}, {}, {kRed}};
    constexpr std::uint32_t kSpokes = 64;
    for (std::uint32_t k = 0; k < kSpokes; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kSpokes;
        fan.vertices.emplace_back(0.05 + 20 * std::cos(angle), 0.05 + 20 * std::sin(angle),
                                  0.3 * (k % 2));
        fan.triangles.push_back({0, 1 + k, 1 + (k + 1) % kSpokes});
    }
    const Picture picture = Renderer({fan}).render(kFromAbove, 100, 100);
    for (std::size_t at = 0; at < picture.depth.size(); ++at)
        ASSERT_FALSE(std::isnan(picture.depth[at])) << at;
}

TEST(Renderer, SeesWhatEveryTriangleByItselfWouldHide) {
    const ColouredSurface surface = tangle(3000);
    const ColouredSurface other = square(4.0, 1.0, 2.0, kBlue);
    const Renderer renderer({surface, other});
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-12.0, 12.0), part(-1.0, 1.0);
    std::vector<Vec3> points, ways{{0, 0, 1}, {0, -3, 0}, {1, 0, 0}};
    for (int k = 0; k < 60; ++k) points.emplace_back(place(random), place(random), place(random));
    for (int k = 0; k < 20; ++k) ways.emplace_back(part(random), part(random), part(random));
    const std::vector<std::uint8_t> seen = renderer.seen(points, ways, 0.25);
    std::size_t compared = 0, hidden = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        for (std::size_t d = 0; d < ways.size(); ++d) {
            bool sure = true, clear = true;
            for (const ColouredSurface* one : {&surface, &other})
                for (const double far : distances(*one, points[p], ways[d].normalized(), sure)) {
                    if (std::abs(far - 0.25) < 1e-3) sure = false;
                    if (far > 0.25) clear = false;
                }
            if (!sure && clear) continue;
            ++compared;
            if (!clear) ++hidden;
            EXPECT_EQ(seen[p * ways.size() + d], clear ? 1 : 0) << p << " " << d;
        }
    }
    EXPECT_GT(hidden, 200U);
    EXPECT_GT(compared - hidden, 100U);
}

}  // namespace
}  // namespace beltgrinding

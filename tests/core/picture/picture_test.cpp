#include "picture/picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

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
}

TEST(Renderer, KnowsItsFarthestVertices) {
    const Renderer renderer({square(4.0, 0.0, 1.0, kRed), square(20.0, 0.0, 0.0, kBlue)});
    const std::vector<Vec3> ways{{0, 0, 1}, {1, 1, 0}};
    // Of each surface the first that is no nearer than another, and both ends of its diagonal.
    const std::vector<Vec3> expected{{-2, -2, 1}, {2, 2, 1}, {-10, -10, 0}, {10, 10, 0}};
    EXPECT_EQ(renderer.farthest(ways), expected);
    EXPECT_TRUE(renderer.farthest({}).empty());
}

}  // namespace
}  // namespace beltgrinding

// Bodies that stand at poses, against boxes whose distances are known.
#include "collision/standing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/threads.h"
#include "beltgrinding/error.h"
#include "support/box.h"

namespace beltgrinding {
namespace {

CollisionMesh box(const Vec3& low, const Vec3& high) {
    return CollisionMesh(testing::box(low, high));
}

Frame at(double x, double turn = 0.0) {
    Frame frame = Frame::Identity();
    frame.translate(Vec3(x, 0, 0));
    frame.rotate(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    return frame;
}

const CollisionMesh cube = box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
const CollisionMesh wall = box(Vec3(10, -50, -50), Vec3(20, 50, 50));

std::vector<std::int32_t> met(const std::vector<CollisionMesh>& held,
                              const std::vector<FixedBody>& fixed,
                              const std::vector<Frame>& frames) {
    return first_met(held, fixed, frames);
}

using Numbers = std::vector<std::int32_t>;

TEST(Standing, TouchesWhereItsCornerReaches) {
    const double corner = std::sqrt(2.0);  // of the cube, turned by 45 degrees
    const double turn = 0.25 * M_PI;
    EXPECT_EQ(met({cube}, {{wall}},
                  {at(8.99), at(9.01), at(10.0 - corner - 0.01, turn),
                   at(10.0 - corner + 0.01, turn), at(21.01), at(20.99)}),
              (Numbers{-1, 0, -1, 0, -1, 0}));
}

TEST(Standing, AMarginMakesTheFixedBodyThicker) {
    EXPECT_EQ(met({cube}, {{wall, 2.5}}, {at(6.49), at(6.51), at(23.49), at(23.51)}),
              (Numbers{-1, 0, 0, -1}));
}

TEST(Standing, OneThatLiesWithinTheOtherIsMet) {
    const CollisionMesh large = box(Vec3(-30, -60, -60), Vec3(30, 60, 60));
    EXPECT_EQ(met({cube}, {{wall}}, {at(15)}), Numbers{0});
    EXPECT_EQ(met({large}, {{wall}}, {at(15), at(-25)}), (Numbers{0, -1}));
    // Beside an open surface nothing is within.
    TriangleMesh sheet;
    sheet.vertices = {Vec3f(10, -50, -50), Vec3f(10, 50, -50), Vec3f(10, 0, 50)};
    sheet.triangles = {{0, 1, 2}};
    EXPECT_EQ(met({cube}, {{CollisionMesh(sheet)}}, {at(15), at(10)}), (Numbers{-1, 0}));
}

TEST(Standing, NamesTheFirstOfThoseThatGoWithTheWheel) {
    const CollisionMesh ahead = box(Vec3(4, -1, -1), Vec3(5, 1, 1));
    EXPECT_EQ(met({cube, ahead}, {{wall}}, {at(4), at(5.5), at(9.5), at(30)}),
              (Numbers{-1, 1, 0, -1}));
    EXPECT_EQ(met({ahead}, {{box(Vec3(90, 0, 0), Vec3(91, 1, 1))}, {wall}}, {at(5.5)}), Numbers{0});
    EXPECT_EQ(met({}, {{wall}}, {at(15)}), Numbers{-1});
    EXPECT_EQ(met({cube}, {}, {at(15)}), Numbers{-1});
    EXPECT_TRUE(met({cube}, {{wall}}, {}).empty());
}

TEST(Standing, IsTheSameOnAnyNumberOfThreads) {
    std::vector<Frame> frames;
    for (int k = 0; k < 500; ++k) frames.push_back(at(0.05 * k, 0.1 * k));
    const Numbers all = met({cube}, {{wall, 0.5}}, frames);
    set_threads(1);
    const Numbers one = met({cube}, {{wall, 0.5}}, frames);
    set_threads(0);
    EXPECT_EQ(one, all);
}

TEST(Standing, RefusesMarginsThatAreNone) {
    for (const double margin : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(met({cube}, {{wall, margin}}, {at(0)}), InputError);
    }
    RunContext context;
    context.cancel();
    EXPECT_THROW(first_met({cube}, {{wall}}, {at(0)}, context), Cancelled);
}

}  // namespace
}  // namespace beltgrinding

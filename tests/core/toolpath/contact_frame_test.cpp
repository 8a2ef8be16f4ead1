#include "beltgrinding/tool_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

TEST(ContactFrame, PutsZIntoTheWorkAndXAsFarAlongAsItCan) {
    const Frame found = contact_frame({1, 2, 3}, {0, 0, -5}, {2, 0, 7});
    EXPECT_TRUE(found.translation().isApprox(Vec3(1, 2, 3)));
    Eigen::Matrix3d down;
    down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    EXPECT_TRUE(found.linear().isApprox(down, 1e-15));
}

TEST(ContactFrame, IsARotationWhateverTheLengths) {
    std::srand(5);
    for (int i = 0; i < 200; ++i) {
        const double length = std::pow(10.0, i - 100);
        const Vec3 into = length * Vec3::Random(), along = Vec3::Random() / length;
        const Frame found = contact_frame(Vec3::Random(), into, along);
        const Eigen::Matrix3d r = found.linear();
        EXPECT_TRUE((r.transpose() * r).isIdentity(1e-12));
        EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
        EXPECT_NEAR(r.col(2).dot(into.stableNormalized()), 1.0, 1e-12);
        EXPECT_NEAR(r.col(1).dot(along.stableNormalized()), 0.0, 1e-9);
        EXPECT_GT(r.col(0).dot(along.stableNormalized()), 0.0);
    }
}

TEST(ContactFrame, RefusesWhatGivesNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    const Vec3 x(1, 0, 0), z(0, 0, 1), zero(0, 0, 0);
    EXPECT_THROW(contact_frame(zero, z, -3 * z), InputError);
    EXPECT_THROW(contact_frame(zero, zero, x), InputError);
    EXPECT_THROW(contact_frame(zero, z, zero), InputError);
    EXPECT_THROW(contact_frame({0, nan, 0}, z, x), InputError);
    EXPECT_THROW(contact_frame(zero, {0, 0, infinite}, x), InputError);
    EXPECT_THROW(contact_frame(zero, z, {nan, 0, 0}), InputError);
}

}  // namespace
}  // namespace beltgrinding

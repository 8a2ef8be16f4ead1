#include "thickness/thickness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/threads.h"
#include "support/synthetic_field.h"
#include "support/unsound_fields.h"

namespace beltgrinding {
namespace {

std::vector<std::uint32_t> all(const HeightField& field) {
    std::vector<std::uint32_t> numbers(field.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

/// Two parallel plates, the upper one's normal up, the lower one's down, `thickness` apart, far
/// from the origin.
HeightField two_plates(double thickness, const Vec3& at) {
    HeightField field = testing::plate(20.0, 10.0, 0.5);
    const HeightField lower = testing::plate(20.0, 10.0, 0.47);
    const auto base = static_cast<std::uint32_t>(field.size());
    for (std::size_t i = 0; i < lower.size(); ++i) {
        field.point.push_back(lower.point[i] - Vec3(0, 0, thickness));
        field.normal.push_back(-lower.normal[i]);
    }
    for (const Triangle& t : lower.triangles) {
        field.triangles.push_back({base + t[0], base + t[2], base + t[1]});
    }
    field.resize(field.point.size());
    for (std::size_t i = 0; i < lower.size(); ++i) field.flags[base + i] = lower.flags[i];
    for (Vec3& p : field.point) p += at;
    return field;
}

TEST(Thickness, TwoParallelPlates) {
    HeightField field = two_plates(3.0, Vec3(5000.0, -3000.0, 800.0));
    for (std::size_t i = 0; i < field.size(); ++i) {
        const bool upper = field.normal[i].z() > 0.0F;
        field.height[i] = upper ? 0.2 : 0.01 * (field.point[i].x() - 5000.0);  // a wedge below
    }
    const Thickness found = measure_thickness(field, all(field), {});
    for (std::size_t i = 0; i < field.size(); ++i) {
        ASSERT_FALSE(std::isnan(found.design[i])) << i;
        EXPECT_NEAR(found.design[i], 3.0, 1e-4);
        EXPECT_NEAR(found.deviation[i], 0.2 + 0.01 * (field.point[i].x() - 5000.0), 2e-4);
    }
}

TEST(Thickness, AFaceThatIsNotGroundStaysAsDesigned) {
    HeightField field = testing::plate(20.0, 10.0, 0.5, -0.1);
    TriangleMesh others;
    others.vertices = {{0, 0, -2}, {20, 0, -2}, {20, 10, -2}, {0, 10, -2}};
    others.triangles = {{0, 2, 1}, {0, 3, 2}};
    const Thickness found = measure_thickness(field, all(field), others);
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_NEAR(found.design[i], 2.0, 1e-5);
        EXPECT_NEAR(found.deviation[i], -0.1, 1e-6);
    }
    // Nothing behind it, or the wrong side of a face: not measured.
    EXPECT_TRUE(std::isnan(measure_thickness(field, {3}, {}).design[0]));
    std::swap(others.triangles[0][1], others.triangles[0][2]);
    std::swap(others.triangles[1][1], others.triangles[1][2]);
    EXPECT_TRUE(std::isnan(measure_thickness(field, {3}, others).design[0]));
}

TEST(Thickness, ASlantedFaceIsMeasuredAlongTheRay) {
    // A wedge of 30 degrees, and one of 70 degrees that has no opposite face.
    for (const double angle : {30.0, 70.0}) {
        const double slope = std::tan(angle * M_PI / 180.0);
        HeightField field = testing::plate(20.0, 10.0, 0.5, 0.1);
        const std::size_t upper = field.size();
        const HeightField lower = testing::mapped_field(
            20.0, 10.0, 0.5, 0.0, [=](double u, double v) { return Vec3(u, v, -1.0 - slope * u); },
            [=](double, double) { return Vec3(-slope, 0, -1).normalized(); });
        const auto base = static_cast<std::uint32_t>(upper);
        field.point.insert(field.point.end(), lower.point.begin(), lower.point.end());
        field.normal.insert(field.normal.end(), lower.normal.begin(), lower.normal.end());
        for (const Triangle& t : lower.triangles) {
            field.triangles.push_back({base + t[0], base + t[2], base + t[1]});
        }
        field.resize(field.point.size());
        for (std::size_t i = upper; i < field.size(); ++i) field.height[i] = 0.2;
        for (const std::uint32_t i : {45U, 200U, 411U}) {
            const Thickness found = measure_thickness(field, {i}, {});
            if (angle > 60.0) {
                EXPECT_TRUE(std::isnan(found.deviation[0]));
            } else {
                EXPECT_NEAR(found.design[0], 1.0 + slope * field.point[i].x(), 1e-4);
                EXPECT_NEAR(found.deviation[0], 0.1 + 0.2 / std::cos(angle * M_PI / 180.0), 1e-4);
            }
        }
    }
}

TEST(Thickness, MissedStockAtEitherEndIsNoMeasure) {
    HeightField field = two_plates(3.0, Vec3::Zero());
    const std::uint32_t upper = 210;
    EXPECT_FALSE(std::isnan(measure_thickness(field, {upper}, {}).deviation[0]));
    HeightField missed = field;
    missed.flags[upper] |= kMissed;
    EXPECT_TRUE(std::isnan(measure_thickness(missed, {upper}, {}).deviation[0]));
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field.normal[i].z() < 0.0F) field.flags[i] |= kMissed;
    }
    EXPECT_TRUE(std::isnan(measure_thickness(field, {upper}, {}).deviation[0]));
}

TEST(Thickness, IsTheSameOnOneAndTwoThreads) {
    HeightField field = two_plates(1.7, Vec3(10.0, 0.0, 0.0));
    std::vector<Thickness> found;
    for (const std::size_t count : {1, 2}) {
        set_threads(count);
        found.push_back(measure_thickness(field, all(field), {}));
    }
    set_threads(0);
    EXPECT_EQ(found[0].design, found[1].design);
    EXPECT_EQ(found[0].deviation, found[1].deviation);
}

TEST(Thickness, AnUnsoundFieldAndASampleThatIsNotThereAreRefused) {
    const HeightField plate = testing::plate(4.0, 3.0, 1.0, 0.2);
    testing::expect_unsound_refused(plate, [](HeightField& f) { measure_thickness(f, {0}, {}); });
    EXPECT_THROW(measure_thickness(plate, {static_cast<std::uint32_t>(plate.size())}, {}),
                 InputError);
}

}  // namespace
}  // namespace beltgrinding

#include "base/student.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(Student, HasItsClosedForms) {
    for (const double t : {-30.0, -2.0, -0.1, 0.0, 0.3, 1.0, 7.0}) {
        EXPECT_NEAR(student_distribution(t, 1.0), 0.5 + std::atan(t) / std::numbers::pi, 1e-12);
        EXPECT_NEAR(student_distribution(t, 2.0), 0.5 + t / (2.0 * std::sqrt(2.0 + t * t)), 1e-12);
        const double s = 1.0 + t * t / 3.0, root = std::sqrt(3.0);
        EXPECT_NEAR(student_distribution(t, 3.0),
                    0.5 + (t / (root * s) + std::atan(t / root)) / std::numbers::pi, 1e-12);
        EXPECT_NEAR(student_distribution(t, kInfinite), 0.5 * std::erfc(-t / std::numbers::sqrt2),
                    1e-15);
        EXPECT_NEAR(student_distribution(t, 1e8), student_distribution(t, kInfinite), 1e-8);
    }
}

TEST(Student, HasTheQuantilesOfTheTables) {
    // Abramowitz and Stegun, table 26.10.
    const double tabled[][3] = {{0.975, 1, 12.706}, {0.975, 3, 3.182},  {0.975, 10, 2.228},
                                {0.95, 2, 2.920},   {0.995, 30, 2.750}, {0.975, kInfinite, 1.960}};
    for (const auto& [share, freedom, t] : tabled) {
        EXPECT_NEAR(student_quantile(share, freedom), t, 6e-4);
        EXPECT_NEAR(student_quantile(1.0 - share, freedom), -t, 6e-4);
        EXPECT_NEAR(student_distribution(student_quantile(share, freedom), freedom), share, 1e-12);
    }
    EXPECT_EQ(student_quantile(0.5, 4.2), 0.0);
    for (const double freedom : {0.0, -1.0, std::nan("")})
        EXPECT_THROW(student_quantile(0.9, freedom), InputError);
    for (const double share : {0.0, 1.0, std::nan("")})
        EXPECT_THROW(student_quantile(share, 3.0), InputError);
}

}  // namespace
}  // namespace beltgrinding

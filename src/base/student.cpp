#include "base/student.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr int kMostTerms = 10000;
constexpr double kPrecision = 1e-15;
constexpr double kTiny = 1e-300;
// From here on the normal distribution is as near as a double tells the sums.
constexpr double kMostFreedom = 1e10;

void refuse_no_freedom(double freedom) {
    if (!(freedom > 0.0))
        throw InputError("call.freedom", "the degrees of freedom must be above 0");
}

/// The continued fraction of the incomplete beta function.
double fraction(double a, double b, double x) {
    const auto away_from_zero = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
    double c = 1.0, d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)), value = d;
    for (int m = 1; m <= kMostTerms; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double change = 1.0;
        for (const double term : {even, odd}) {
            d = 1.0 / away_from_zero(1.0 + term * d);
            c = away_from_zero(1.0 + term / c);
            change = c * d;
            value *= change;
        }
        if (std::abs(change - 1.0) < kPrecision) break;
    }
    return value;
}

/// I_x(a, b), x and its complement y in [0, 1].
double incomplete_beta(double a, double b, double x, double y) {
    if (x <= 0.0 || y <= 0.0) return x <= 0.0 ? 0.0 : 1.0;
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log(y));
    if (x < (a + 1.0) / (a + b + 2.0)) return front * fraction(a, b, x) / a;
    return 1.0 - front * fraction(b, a, y) / b;
}

}  // namespace

double student_distribution(double t, double freedom) {
    refuse_no_freedom(freedom);
    if (freedom > kMostFreedom) return 0.5 * std::erfc(-t / std::numbers::sqrt2);
    const double square = t * t, whole = freedom + square;
    if (!std::isfinite(whole)) return t > 0.0 ? 1.0 : 0.0;
    const double beyond =
        0.5 * incomplete_beta(0.5 * freedom, 0.5, freedom / whole, square / whole);
    return t > 0.0 ? 1.0 - beyond : beyond;
}

double student_quantile(double share, double freedom) {
    refuse_no_freedom(freedom);
    if (!(share > 0.0 && share < 1.0))
        throw InputError("call.share", "a quantile's share must lie between 0 and 1");
    if (share == 0.5) return 0.0;
    const double tail = std::min(share, 1.0 - share);
    // The tail falls monotonically with t: doubled until it is small enough, then halved.
    double low = 0.0, high = 1.0;
    while (student_distribution(-high, freedom) > tail && high < 1e150) {
        low = high;
        high *= 2.0;
    }
    for (int i = 0; i < 200 && high - low > 4e-16 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (student_distribution(-middle, freedom) > tail ? low : high) = middle;
    }
    return share > 0.5 ? 0.5 * (low + high) : -0.5 * (low + high);
}

}  // namespace beltgrinding

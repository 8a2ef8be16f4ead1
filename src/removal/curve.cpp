#include "beltgrinding/curve.h"

#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

/// Slope at the end of a curve: three-point formula, kept from overshooting.
double end_slope(double h0, double h1, double d0, double d1) {
    const double slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if (slope * d0 <= 0.0) return 0.0;
    if (d0 * d1 <= 0.0 && std::abs(slope) > 3.0 * std::abs(d0)) return 3.0 * d0;
    return slope;
}

void refuse_too_steep(const std::vector<double>& slopes, const std::string& name) {
    if (std::all_of(slopes.begin(), slopes.end(), [](double s) { return std::isfinite(s); }))
        return;
    throw InputError("law.curve_too_steep",
                     "{key}: two points of the curve are so near that its slope cannot be computed",
                     {{"key", name}});
}

}  // namespace

Curve::Curve(std::vector<Eigen::Vector2d> points, const std::string& name)
    : points_(std::move(points)) {
    if (points_.empty()) return;
    bool usable = points_.size() >= 2;
    for (std::size_t k = 0; k < points_.size(); ++k) {
        usable = usable && points_[k].allFinite() && points_[k].y() >= 0.0 &&
                 (k == 0 || points_[k].x() > points_[k - 1].x());
    }
    if (!usable) {
        throw InputError("law.curve",
                         "{key}: a curve needs at least two points [x, value], x ascending and "
                         "values zero or positive",
                         {{"key", name}});
    }
    const std::size_t n = points_.size();
    std::vector<double> h(n - 1), d(n - 1);
    for (std::size_t k = 0; k + 1 < n; ++k) {
        h[k] = points_[k + 1].x() - points_[k].x();
        d[k] = (points_[k + 1].y() - points_[k].y()) / h[k];
    }
    slopes_.assign(n, d[0]);
    refuse_too_steep(d, name);
    if (n == 2) return;
    for (std::size_t k = 1; k + 1 < n; ++k) {
        slopes_[k] = 0.0;
        if (d[k - 1] * d[k] <= 0.0) continue;
        const double a = 2.0 * h[k] + h[k - 1], b = h[k] + 2.0 * h[k - 1];
        slopes_[k] = (a + b) / (a / d[k - 1] + b / d[k]);
    }
    slopes_.front() = end_slope(h[0], h[1], d[0], d[1]);
    slopes_.back() = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
    refuse_too_steep(slopes_, name);
}

double Curve::operator()(double x) const {
    if (x <= lower()) return points_.front().y();
    if (x >= upper()) return points_.back().y();
    const auto after = std::upper_bound(points_.begin(), points_.end(), x,
                                        [](double v, const auto& point) { return v < point.x(); });
    const auto k = static_cast<std::size_t>(after - points_.begin());
    const double h = points_[k].x() - points_[k - 1].x(), t = (x - points_[k - 1].x()) / h;
    const double u = 1.0 - t;
    return u * u * (1.0 + 2.0 * t) * points_[k - 1].y() + t * t * (1.0 + 2.0 * u) * points_[k].y() +
           h * t * u * (u * slopes_[k - 1] - t * slopes_[k]);
}

}  // namespace beltgrinding

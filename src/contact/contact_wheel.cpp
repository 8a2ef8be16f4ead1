#include "beltgrinding/contact_wheel.h"

#include <cmath>
#include <string>

#include "beltgrinding/error.h"

namespace beltgrinding {

namespace {

// mm: of larger ones single precision loses the samples' places along the normal.
constexpr double kLargest = 1e6;

/// The profile's stretch that y lies on.
std::pair<Eigen::Vector2d, Eigen::Vector2d> stretch(const std::vector<Eigen::Vector2d>& profile,
                                                    double y) {
    std::size_t k = 1;
    while (k + 1 < profile.size() && profile[k].x() < y) ++k;
    return {profile[k - 1], profile[k]};
}

}  // namespace

double ContactWheel::drop(double y) const {
    double drop = 0.0;
    if (crown_radius > 0.0) {
        drop = crown_radius - std::sqrt(crown_radius * crown_radius - y * y);
    }
    if (!profile.empty()) {
        const auto [a, b] = stretch(profile, y);
        drop += a.y() + (b.y() - a.y()) * (y - a.x()) / (b.x() - a.x());
    }
    return drop;
}

double ContactWheel::drop_slope(double y) const {
    double slope = 0.0;
    if (crown_radius > 0.0) slope = y / std::sqrt(crown_radius * crown_radius - y * y);
    if (!profile.empty()) {
        const auto [a, b] = stretch(profile, y);
        slope += (b.y() - a.y()) / (b.x() - a.x());
    }
    return slope;
}

void ContactWheel::validate() const {
    if (!(radius > 0.0 && radius <= kLargest)) {
        throw InputError("wheel.radius",
                         "contact wheel: radius is {radius:g} mm; give one above 0 and up to "
                         "{most:g} mm",
                         {{"radius", radius}, {"most", kLargest}});
    }
    if (!(width > 0.0 && width <= kLargest)) {
        throw InputError(
            "wheel.width",
            "contact wheel: width is {width:g} mm; give one above 0 and up to {most:g} "
            "mm",
            {{"width", width}, {"most", kLargest}});
    }
    if (!std::isfinite(crown_radius) || crown_radius < 0.0) {
        throw InputError("wheel.crown_radius",
                         "contact wheel: crown radius is {radius:f} mm; give a positive one, or 0 "
                         "for a cylinder",
                         {{"radius", crown_radius}});
    }
    if (!profile.empty()) {
        const double half = 0.5 * width * (1.0 - 1e-9);
        bool usable =
            profile.size() >= 2 && profile.front().x() <= -half && profile.back().x() >= half;
        for (std::size_t k = 0; k < profile.size(); ++k) {
            usable = usable && profile[k].allFinite() && profile[k].y() >= 0.0 &&
                     profile[k].y() < radius && (k == 0 || profile[k].x() > profile[k - 1].x());
        }
        if (!usable) {
            throw InputError(
                "wheel.profile",
                "contact wheel: the profile needs points (y, drop) with y ascending from {begin:f} "
                "to {end:f} mm at least, and drops from 0 to below the radius",
                {{"begin", -0.5 * width}, {"end", 0.5 * width}});
        }
    }
    if (crown_radius > 0.0 && (crown_radius <= 0.5 * width || drop(0.5 * width) >= radius)) {
        throw InputError("wheel.crown_too_strong",
                         "contact wheel: a crown radius of {radius:f} mm does not reach across the "
                         "width of {width:f} mm; give one larger than half the width",
                         {{"radius", crown_radius}, {"width", width}});
    }
}

}  // namespace beltgrinding

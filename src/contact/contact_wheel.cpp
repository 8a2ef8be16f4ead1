#include "contact/contact_wheel.h"

#include <cmath>
#include <string>

#include "base/error.h"

namespace beltgrinding {

double ContactWheel::drop(double y) const {
    if (crown_radius <= 0.0) return 0.0;
    return crown_radius - std::sqrt(crown_radius * crown_radius - y * y);
}

double ContactWheel::drop_slope(double y) const {
    if (crown_radius <= 0.0) return 0.0;
    return y / std::sqrt(crown_radius * crown_radius - y * y);
}

void ContactWheel::validate() const {
    if (!std::isfinite(radius) || radius <= 0.0) {
        throw InputError("contact wheel: radius is " + std::to_string(radius) +
                         " mm; give a positive one");
    }
    if (!std::isfinite(width) || width <= 0.0) {
        throw InputError("contact wheel: width is " + std::to_string(width) +
                         " mm; give a positive one");
    }
    if (!std::isfinite(crown_radius) || crown_radius < 0.0) {
        throw InputError("contact wheel: crown radius is " + std::to_string(crown_radius) +
                         " mm; give a positive one, or 0 for a cylinder");
    }
    if (crown_radius > 0.0 && (crown_radius <= 0.5 * width || drop(0.5 * width) >= radius)) {
        throw InputError("contact wheel: a crown radius of " + std::to_string(crown_radius) +
                         " mm does not reach across the width of " + std::to_string(width) +
                         " mm; give one larger than half the width");
    }
}

}  // namespace beltgrinding

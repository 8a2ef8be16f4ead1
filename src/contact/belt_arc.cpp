#include "contact/belt_arc.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {

double BeltArc::angle(double s) const {
    return flat() ? 0.0 : std::clamp(s / radius, -end, end);
}

double BeltArc::x(double s) const {
    if (flat()) return s;
    const double turned = angle(s);
    return radius * std::sin(turned) + (s - radius * turned) * std::cos(end);
}

double BeltArc::s(double x) const {
    if (flat()) return x;
    const double last = radius * std::sin(end);
    if (std::abs(x) <= last) return radius * std::asin(x / radius);
    return std::copysign(half_length() + (std::abs(x) - last) / std::cos(end), x);
}

double BeltArc::behind(double x) const {
    if (flat()) return 0.0;
    const double on = std::min(std::abs(x), radius * std::sin(end));
    // The sagitta in a form that loses no digits of a large radius.
    return on * on / (radius + std::sqrt(radius * radius - on * on)) +
           (std::abs(x) - on) * std::tan(end);
}

}  // namespace beltgrinding

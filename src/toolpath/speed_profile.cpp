#include "speed_profile.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

/// s to go `length` when beginning with `speed` under a constant acceleration; no cancellation
/// where either is small.
double time_of_rise(double length, double speed, double acceleration) {
    const double reached = std::sqrt(speed * speed + 2.0 * acceleration * length);
    return length > 0.0 ? 2.0 * length / (speed + reached) : 0.0;
}

}  // namespace

SpeedProfile::SpeedProfile(const std::vector<SpeedLimit>& limits) {
    const std::size_t n = limits.size();
    std::vector<double> square(n + 1, 0.0);  // of the speed at each boundary; at rest at both ends
    for (std::size_t k = 0; k + 1 < n; ++k) {
        const double speed = std::min(limits[k].speed, limits[k + 1].speed);
        if (!limits[k].stop) square[k + 1] = speed * speed;
    }
    const auto gain = [&](std::size_t k) {
        return 2.0 * limits[k].acceleration * limits[k].length;
    };
    for (std::size_t k = 0; k < n; ++k)
        square[k + 1] = std::min(square[k + 1], square[k] + gain(k));
    for (std::size_t k = n; k-- > 0;) square[k] = std::min(square[k], square[k + 1] + gain(k));

    stretches_.reserve(n);
    for (std::size_t k = 0; k < n; ++k) {
        const SpeedLimit& limit = limits[k];
        Stretch s;
        s.length = limit.length;
        s.acceleration = limit.acceleration;
        s.begin = std::sqrt(square[k]);
        s.end = std::sqrt(square[k + 1]);
        const double highest = 0.5 * (gain(k) + square[k] + square[k + 1]);
        const double peak =
            std::clamp(highest, std::max(square[k], square[k + 1]),
                       std::max({limit.speed * limit.speed, square[k], square[k + 1]}));
        s.peak = std::sqrt(peak);
        s.rise = std::min(s.length, 0.5 * (peak - square[k]) / s.acceleration);
        s.fall = std::min(s.length - s.rise, 0.5 * (peak - square[k + 1]) / s.acceleration);
        s.duration = time_of_rise(s.rise, s.begin, s.acceleration) +
                     time_of_rise(s.fall, s.end, s.acceleration);
        const double even = s.length - s.rise - s.fall;
        if (even > 0.0 && s.peak > 0.0) s.duration += even / s.peak;
        stretches_.push_back(s);
    }
}

double SpeedProfile::elapsed(std::size_t stretch, double length) const {
    const Stretch& s = stretches_[stretch];
    if (length <= s.rise) return time_of_rise(length, s.begin, s.acceleration);
    const double left = s.length - length;
    if (left <= s.fall) {
        return s.duration - time_of_rise(std::max(left, 0.0), s.end, s.acceleration);
    }
    return time_of_rise(s.rise, s.begin, s.acceleration) + (length - s.rise) / s.peak;
}

double SpeedProfile::speed(std::size_t stretch, double length) const {
    const Stretch& s = stretches_[stretch];
    if (length < s.rise) return std::sqrt(s.begin * s.begin + 2.0 * s.acceleration * length);
    const double left = std::max(s.length - length, 0.0);
    if (left < s.fall) return std::sqrt(s.end * s.end + 2.0 * s.acceleration * left);
    return s.peak;
}

}  // namespace beltgrinding

#include "gap/wheel_pose.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr double kOnEnvelope = 1e-5;  // mm: a sample as near to the wheel's envelope lies on it
constexpr int kMaxSecants = 20;

}  // namespace

WheelPose::WheelPose(const ContactWheel& wheel) : wheel_(wheel) {
    const double half = 0.5 * wheel.width;
    for (const double y : {-half, half})
        steepest_flank_ = std::max(steepest_flank_, std::abs(wheel.drop_slope(y)));
    for (const Eigen::Vector2d& at : wheel.profile)
        steepest_flank_ =
            std::max(steepest_flank_, std::abs(wheel.drop_slope(std::clamp(at.x(), -half, half))));
    for (std::size_t k = 1; k < wheel.profile.size(); ++k) {
        const Eigen::Vector2d &from = wheel.profile[k - 1], &to = wheel.profile[k];
        const double slope = (to.y() - from.y()) / (to.x() - from.x());
        profile_.push_back({static_cast<float>(to.x()),
                            static_cast<float>(from.y() - slope * from.x()),
                            static_cast<float>(slope)});
    }
}

Eigen::Vector2d WheelPose::slopes(const Vec3& normal, double s, double gap) const {
    const Vec3 n = contact_from_work_.linear() * normal;
    const double sine = std::sin(s / wheel_.radius), cosine = std::cos(s / wheel_.radius);
    const double facing = std::max<double>(-n.x() * sine - n.z() * cosine, kSteepest * n.norm());
    const double tangential = n.x() * cosine - n.z() * sine;
    return {tangential / facing * (1.0 + gap / wheel_.radius), n.y() / facing};
}

double WheelPose::down_to_envelope(const SampleBlocks& blocks, const Footprint& f, double approach,
                                   double wanted) const {
    const HeightField& field = blocks.field();
    // By the slopes at most, and by the curvature of the radius seen from z.
    const double overlap = approach * f.facing - f.own_gap;
    const double bent = approach * approach / wheel_.radius;
    const double way = field.leans(f.sample) ? wanted * field.rays[f.sample].norm() : wanted;
    if (overlap - bent >= (1.0 + steepest_flank_) * way) return wanted;
    const Vec3 ray = contact_from_work_.linear() * field.ray(f.sample).cast<double>();
    const Vec3 top = contact_from_work_ * blocks.top(f.position);
    const auto gap = [&](double lowering) {
        const Vec3 at = top - lowering * ray;
        const double y = std::clamp(at.y(), -0.5 * wheel_.width, 0.5 * wheel_.width);
        return std::hypot(at.x(), at.z() - approach + wheel_.radius) -
               (wheel_.radius - wheel_.drop(y));
    };
    double at_low = gap(0.0);
    if (at_low >= 0.0) return 0.0;
    double at_high = gap(wanted);
    if (at_high <= kOnEnvelope) return wanted;
    // Regula falsi. The radius is convex in the lowering, so that it comes from within.
    double low = 0.0, high = wanted;
    for (int k = 0; k < kMaxSecants && at_low < -kOnEnvelope; ++k) {
        const double between = low + (high - low) * at_low / (at_low - at_high);
        const double found = gap(between);
        (found <= 0.0 ? low : high) = between;
        (found <= 0.0 ? at_low : at_high) = found;
    }
    return low;
}

}  // namespace beltgrinding

#include "cost.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr double kSlow = 10.0;                      // times what a motion takes longer
constexpr double kSmooth = 0.5;                     // s, times squared changes of speed
constexpr double kLimitNear = 15.0 * M_PI / 180.0;  // rad from a limit where it begins to cost
constexpr double kPlace = 5.0;                      // s in a second at a limit or singularity
constexpr double kLeastTime = 0.02;                 // s that a pose counts for at least

double beneath(double value, double wanted) {
    const double share = std::clamp(1.0 - value / wanted, 0.0, 1.0);
    return share * share;
}

}  // namespace

double Cost::slow(const Coordinates& a, const Coordinates& b, double duration) const {
    const double least = (b - a).cwiseAbs().cwiseQuotient(options_.speed).maxCoeff();
    return kSlow * std::max(0.0, least - duration);
}

double Cost::acceleration(const Coordinates& a, const Coordinates& b, const Coordinates& c,
                          double before, double after) const {
    const Coordinates change =
        (c - b) / std::max(after, kLeastTime) - (b - a) / std::max(before, kLeastTime);
    return kSmooth * change.cwiseQuotient(options_.speed).squaredNorm();
}

double Cost::place(const Coordinates& at) const {
    const Joints q = at.head<6>();
    const Joints room = (q - arm_.lower()).cwiseMin(arm_.upper() - q);
    double sum = beneath(std::max(0.0, room.minCoeff()), kLimitNear);
    if (options_.singularity > 0.0) {
        const SingularDistance d = singular_distance(arm_, q);
        for (const double angle : {d.wrist, d.elbow, d.shoulder, d.general})
            sum += beneath(angle, 2.0 * options_.singularity);
    }
    return kPlace * sum;
}

std::vector<double> times_at(const std::vector<PassPose>& poses) {
    std::vector<double> times(poses.size(), 0.0);
    for (std::size_t i = 1; i < poses.size(); ++i) {
        if (poses[i].begins) continue;
        times[i - 1] += 0.5 * poses[i].duration;
        times[i] += 0.5 * poses[i].duration;
    }
    for (double& time : times) time = std::max(time, kLeastTime);
    return times;
}

}  // namespace beltgrinding

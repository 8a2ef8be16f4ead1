#include "crowns.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beltgrinding {

double crown_spacing(const FaceSamples& samples, double spacing, double most_turn) {
    double least = std::numeric_limits<double>::infinity();  // radius, mm
    for (const Triangle& triangle : samples.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
            if (((samples.flags[a] | samples.flags[b]) & kDegenerate) != 0) continue;
            const Vec3 along = samples.point[b] - samples.point[a];
            const Vec3 change = (samples.normal[b] - samples.normal[a]).cast<double>();
            if (!(along.dot(change) > 0.0)) continue;  // hollow
            const double half = std::asin(std::min(1.0, 0.5 * change.norm()));
            if (2.0 * half > most_turn) least = std::min(least, along.norm() / change.norm());
        }
    }
    if (!std::isfinite(least)) return 0.0;
    const double wanted = SampleDensity::kTurn * least;
    return std::min(std::max(wanted, SampleDensity::kFinestShare * spacing), spacing);
}

}  // namespace beltgrinding

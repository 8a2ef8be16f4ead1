#include "heat/depth_factors.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace beltgrinding {

const DepthFactors::Factors& DepthFactors::operator()(double duration) {
    const auto hash = std::bit_cast<std::uint64_t>(duration) * 0x9E3779B97F4A7C15ULL;
    Factors& known = known_[hash >> 58U];
    if (duration == known.duration) return known;
    known.duration = duration;
    const auto& rates = DepthModes::rates();
    for (std::size_t j = 0; j < rates.size(); ++j) {
        const double lost = -std::expm1(-rates[j] * material_.diffusivity() * duration);
        known.decay[j] = static_cast<float>(1.0 - lost);
        known.gain[j] = static_cast<float>(j == 0 ? duration / material_.capacity()
                                                  : lost / (material_.conductivity * rates[j]));
    }
    return known;
}

}  // namespace beltgrinding

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
    for (std::size_t j = 0; j < DepthModes::kModes; ++j) {
        const double rate = DepthModes::rates()[j] / (longer_ * longer_);
        const double lost = -std::expm1(-rate * material_.diffusivity() * duration);
        known.decay[j] = decays_ ? static_cast<float>(1.0 - lost) : 1.0f;
        known.gain[j] = static_cast<float>(j == 0 ? duration / material_.capacity()
                                                  : lost / (material_.conductivity * rate));
    }
    return known;
}

}  // namespace beltgrinding

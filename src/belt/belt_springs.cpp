#include "belt_springs.h"

#include "registers.h"

namespace beltgrinding {

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
bool press_springs(int count, const double* __restrict__ from, double raised,
                   const double* __restrict__ to, const double* __restrict__ stiffness,
                   double* __restrict__ forces, std::uint8_t* __restrict__ on) {
    for (int k = 0; k < count; ++k) {
        const double in = (from[k] + raised) - to[k];
        forces[k] = in > 0.0 ? stiffness[k] * in : 0.0;
    }
    // Stiffnesses of 0 are on as well.
    std::uint8_t changed = 0;
    for (int k = 0; k < count; ++k) {
        const std::uint8_t now = (from[k] + raised) - to[k] > 0.0 ? 1 : 0;
        changed |= static_cast<std::uint8_t>(now ^ on[k]);
        on[k] = now;
    }
    return changed == 0;
}

#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx2", "default")))
#endif
double
sum_apart(int count, const double* values) {
    constexpr int kFour = 4;
    Four low{}, high{};
    int k = 0;
    for (; k + 2 * kFour <= count; k += 2 * kFour) {
        low += read<Four>(values + k);
        high += read<Four>(values + k + kFour);
    }
    const Four both = low + high;
    double sum = (both[0] + both[1]) + (both[2] + both[3]);
    for (; k < count; ++k) sum += values[k];
    return sum;
}

}  // namespace beltgrinding

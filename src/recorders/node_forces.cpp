#include "node_forces.h"

#include "base/lanes.h"

namespace beltgrinding {

using namespace lanes;

BELTGRINDING_CLONES
void add_up_forces(const float* pressure, const float* area, const NodeShare* shares,
                   std::size_t count, float* forces) {
    constexpr int kGroups = 64 / kWide;
    Floats force[kGroups];
    for (int g = 0; g < kGroups; ++g)
        force[g] = load(pressure + kWide * g) * larger(load(area + kWide * g), Floats{});
    for (std::size_t k = 0; k < count; ++k) {
        Floats sum{};
        for (int g = 0; g < kGroups; ++g)
            sum += kept(force[g], mask_of(shares[k].samples, kWide * g));
        sum += __builtin_shufflevector(sum, sum, 4, 5, 6, 7, 0, 1, 2, 3);
        sum += __builtin_shufflevector(sum, sum, 2, 3, 0, 1, 6, 7, 4, 5);
        forces[k] = sum[0] + sum[1];
    }
}

}  // namespace beltgrinding

#include "heat/heat_rows.h"

#include "base/lanes.h"

namespace beltgrinding {

using namespace lanes;

namespace {

/// Without what would become too small for normal numbers, which processors are slow with.
BELTGRINDING_INLINE Floats told(const Floats& values) {
    return kept(values, magnitude(values) > 1e-20f);
}

}  // namespace

BELTGRINDING_CLONES
void conduct_stage(const HeatWays& ways, const float* now, const float* before, float* next,
                   float a, float b, float c) {
    for (std::size_t k = 0; k < ways.nodes; ++k) {
        const float* mine = now + 2 * kWide * k;
        const Floats low = load(mine), high = load(mine + kWide);
        Floats low_sum{}, high_sum{};
        for (std::uint32_t e = ways.first[k]; e < ways.first[k + 1]; ++e) {
            const float* other = now + 2 * kWide * std::size_t{ways.neighbour[e]};
            const Floats rate = all(ways.rate[e]);
            Floats low_rate = rate;
            low_rate[0] = ways.mean_rate[e];
            low_sum += low_rate * (load(other) - low);
            high_sum += rate * (load(other + kWide) - high);
        }
        const float* old = before + 2 * kWide * k;
        store(next + 2 * kWide * k, a * low + b * load(old) + c * low_sum);
        store(next + 2 * kWide * k + kWide, a * high + b * load(old + kWide) + c * high_sum);
    }
}

BELTGRINDING_CLONES
void heat_row(float* row, const float* decay, const float* gain, const float* own, float flux,
              const float* other, float other_flux) {
    for (int k = 0; k < 2 * kWide; k += kWide) {
        const Floats source = load(own + k) * flux + load(other + k) * other_flux;
        store(row + k, told(load(row + k) * load(decay + k) + source * load(gain + k)));
    }
}

BELTGRINDING_CLONES
void decay_row(float* row, const float* decay) {
    for (int k = 0; k < 2 * kWide; k += kWide)
        store(row + k, told(load(row + k) * load(decay + k)));
}

}  // namespace beltgrinding

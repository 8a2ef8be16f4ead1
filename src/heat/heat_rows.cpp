#include "heat/heat_rows.h"

#include "base/lanes.h"

namespace beltgrinding {

using namespace lanes;

namespace {

/// Without what would become too small for normal numbers, which processors are slow with.
BELTGRINDING_INLINE Floats told(const Floats& values) {
    return kept(values, magnitude(values) > 1e-20f);
}

BELTGRINDING_INLINE float total(const Floats& values) {
    Floats sum = values + __builtin_shufflevector(values, values, 4, 5, 6, 7, 0, 1, 2, 3);
    sum += __builtin_shufflevector(sum, sum, 2, 3, 0, 1, 6, 7, 4, 5);
    return sum[0] + sum[1];
}

BELTGRINDING_INLINE float greatest(const Floats& values) {
    Floats most = larger(values, __builtin_shufflevector(values, values, 4, 5, 6, 7, 0, 1, 2, 3));
    most = larger(most, __builtin_shufflevector(most, most, 2, 3, 0, 1, 6, 7, 4, 5));
    return most[0] > most[1] ? most[0] : most[1];
}

}  // namespace

BELTGRINDING_CLONES
void conduct_stage(const HeatWays& ways, const HeatStage& stage, const float* now,
                   const float* before, const float* rows, float* next) {
    const Floats a = all(static_cast<float>(stage.now)), b = all(static_cast<float>(stage.before)),
                 d = all(static_cast<float>(stage.rows)), c = all(static_cast<float>(stage.change));
    for (std::size_t k = 0; k < ways.nodes; ++k) {
        const std::size_t at = 2 * kWide * k;
        const HeatWay *way = ways.ways + ways.first[k], *end = ways.ways + ways.first[k + 1];
        const Floats low = load(now + at);
        Floats low_sum{};
        if (ways.slow[k] != 0) {
            for (; way != end; ++way) {
                Floats rate = all(way->rate);
                rate[0] = way->mean_rate;
                low_sum += rate * (load(now + 2 * kWide * std::size_t{way->other}) - low);
            }
            store(next + at, a * low + b * load(before + at) + d * load(rows + at) + c * low_sum);
            store(next + at + kWide, Floats{});
            continue;
        }
        const Floats high = load(now + at + kWide);
        Floats high_sum{};
        for (; way != end; ++way) {
            const float* other = now + 2 * kWide * std::size_t{way->other};
            const Floats rate = all(way->rate);
            Floats low_rate = rate;
            low_rate[0] = way->mean_rate;
            low_sum += low_rate * (load(other) - low);
            high_sum += rate * (load(other + kWide) - high);
        }
        store(next + at, a * low + b * load(before + at) + d * load(rows + at) + c * low_sum);
        store(next + at + kWide, a * high + b * load(before + at + kWide) +
                                     d * load(rows + at + kWide) + c * high_sum);
    }
}

BELTGRINDING_CLONES
void sum_rows(const float* rows, std::size_t count, float* sums) {
    for (std::size_t k = 0; k < count; ++k, rows += 2 * kWide)
        sums[k] = total(load(rows) + load(rows + kWide));
}

BELTGRINDING_CLONES
void heat_row(float* row, const float* gain, const float* own, float flux, const float* other,
              float other_flux) {
    for (int k = 0; k < 2 * kWide; k += kWide) {
        const Floats source = load(own + k) * flux + load(other + k) * other_flux;
        store(row + k, load(row + k) + source * load(gain + k));
    }
}

BELTGRINDING_CLONES
float decay_row(float* row, const float* decay) {
    store(row, told(load(row) * load(decay)));
    const Floats high = told(load(row + kWide) * load(decay + kWide));
    store(row + kWide, high);
    return greatest(magnitude(high));
}

BELTGRINDING_CLONES
void decay_rows(float* rows, std::size_t count, const float* decay) {
    const Floats low = load(decay), high = load(decay + kWide);
    for (float* row = rows; row < rows + 2 * kWide * count; row += 2 * kWide) {
        store(row, told(load(row) * low));
        store(row + kWide, told(load(row + kWide) * high));
    }
}

BELTGRINDING_CLONES
float greatest_of_row(const float* row) {
    return greatest(larger(magnitude(load(row)), magnitude(load(row + kWide))));
}

BELTGRINDING_CLONES
float sum_of_row(const float* row) {
    return total(load(row) + load(row + kWide));
}

BELTGRINDING_CLONES
float sum_of_row(const float* row, const float* decay) {
    return total(load(row) * load(decay) + load(row + kWide) * load(decay + kWide));
}

}  // namespace beltgrinding

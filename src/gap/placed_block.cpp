#include "gap/placed_block.h"

#include <algorithm>
#include <limits>

#include "base/lanes.h"

namespace beltgrinding {
namespace {

using namespace lanes;

// Square of the tangent of half the angle under the wheel up to which the series below holds.
constexpr float kWidestAngle = 0.36f;

/// Four rows of eight lanes -> lanes 0 to 7 of four.
BELTGRINDING_INLINE void turn(const Floats& a, const Floats& b, const Floats& c, const Floats& d,
                              Four* lanes) {
    const Floats ab_low = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const Floats ab_high = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const Floats cd_low = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const Floats cd_high = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    const Floats l04 = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
    const Floats l15 = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
    const Floats l26 = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
    const Floats l37 = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
    lanes[0] = __builtin_shufflevector(l04, l04, 0, 1, 2, 3);
    lanes[1] = __builtin_shufflevector(l15, l15, 0, 1, 2, 3);
    lanes[2] = __builtin_shufflevector(l26, l26, 0, 1, 2, 3);
    lanes[3] = __builtin_shufflevector(l37, l37, 0, 1, 2, 3);
    lanes[4] = __builtin_shufflevector(l04, l04, 4, 5, 6, 7);
    lanes[5] = __builtin_shufflevector(l15, l15, 4, 5, 6, 7);
    lanes[6] = __builtin_shufflevector(l26, l26, 4, 5, 6, 7);
    lanes[7] = __builtin_shufflevector(l37, l37, 4, 5, 6, 7);
}
/// atan(t) / t by q = t * t up to `kWidestAngle`: a Chebyshev fit, to 4e-8.
BELTGRINDING_INLINE Floats angle_by(const Floats& q) {
    Floats sum = all(0.029195188f);
    sum = sum * q - 0.07193945f;
    sum = sum * q + 0.10694442f;
    sum = sum * q - 0.14236552f;
    sum = sum * q + 0.19997175f;
    sum = sum * q - 0.33333272f;
    return sum * q + 1.0f;
}

/// How far the wheel's profile lies back at y, and its slope.
BELTGRINDING_INLINE void shape(const Placing& p, const Floats& y, Floats& drop, Floats& slope) {
    drop = slope = Floats{};
    if (p.crown > 0.0f) {
        const Floats height = root(all(p.crown * p.crown) - y * y);
        drop = y * y / (height + p.crown);
        slope = y / height;
    }
    for (int k = p.stretches; k-- > 0;) {
        const ProfileStretch& one = p.profile[k];
        if (k + 1 == p.stretches) {
            drop += one.at + one.slope * y;
            slope += one.slope;
        } else {
            const ProfileStretch& next = p.profile[k + 1];
            const Ints here = y <= one.end;
            drop += kept((one.at - next.at) + (one.slope - next.slope) * y, here);
            slope += kept(all(one.slope - next.slope), here);
        }
    }
}

/// The cell of the four that each sample lies in.
BELTGRINDING_INLINE Ints own_cells(const PlacedBlock& placed, int first, int above) {
    const Ints right = load(placed.u + first) >= 0.5f, up = load(placed.v + first) >= 0.5f;
    return load(placed.cell + first) - right + (up & above);
}

/// By sample, its weight in the four cells and its gap carried to their centres.
BELTGRINDING_INLINE void share_out(const PlacedBlock& placed, int first, Four* weights,
                                   Four* carried) {
    const Floats u = load(placed.u + first), v = load(placed.v + first);
    const Floats w = load(placed.weight + first), g = load(placed.gap + first);
    const Floats slope_s = load(placed.slope_s + first), slope_y = load(placed.slope_y + first);
    const Floats wu = w * u, rest = w - wu;
    turn(rest * (1.0f - v), wu * (1.0f - v), rest * v, wu * v, weights);
    turn(g, g + slope_s, g + slope_y, g + slope_s + slope_y, carried);
}

BELTGRINDING_INLINE void add(double* to, const Four& values) {
    using FourDoubles = double __attribute__((vector_size(32)));
    FourDoubles sum;
    __builtin_memcpy(&sum, to, sizeof sum);
    sum += __builtin_convertvector(values, FourDoubles);
    __builtin_memcpy(to, &sum, sizeof sum);
}

BELTGRINDING_INLINE Floats between(const PlacedBlock& placed, const Bilinear* table, int first) {
    Four rows[kWide];
    for (int k = 0; k < kWide; ++k) {
        const Bilinear& from = table[placed.cell[first + k]];
        rows[k] = Four{from.a, from.b, from.c, from.d};
    }
    // Eight rows of four -> four rows of eight.
    const auto join = [](const Four& a, const Four& b) __attribute__((always_inline)) {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    };
    const Floats r04 = join(rows[0], rows[4]), r15 = join(rows[1], rows[5]);
    const Floats r26 = join(rows[2], rows[6]), r37 = join(rows[3], rows[7]);
    const Floats ab01 = __builtin_shufflevector(r04, r15, 0, 8, 1, 9, 4, 12, 5, 13);
    const Floats cd01 = __builtin_shufflevector(r04, r15, 2, 10, 3, 11, 6, 14, 7, 15);
    const Floats ab23 = __builtin_shufflevector(r26, r37, 0, 8, 1, 9, 4, 12, 5, 13);
    const Floats cd23 = __builtin_shufflevector(r26, r37, 2, 10, 3, 11, 6, 14, 7, 15);
    const Floats a = __builtin_shufflevector(ab01, ab23, 0, 1, 8, 9, 4, 5, 12, 13);
    const Floats b = __builtin_shufflevector(ab01, ab23, 2, 3, 10, 11, 6, 7, 14, 15);
    const Floats c = __builtin_shufflevector(cd01, cd23, 0, 1, 8, 9, 4, 5, 12, 13);
    const Floats d = __builtin_shufflevector(cd01, cd23, 2, 3, 10, 11, 6, 7, 14, 15);
    const Floats u = load(placed.u + first), v = load(placed.v + first);
    const Floats value = a + b * u + (c + d * u) * v;
    return kept(value, mask_of(placed.regular, first));
}

}  // namespace

BELTGRINDING_CLONES
void place_block(const Placing& p, const SampleArrays& in, PlacedBlock& out, float* across) {
    const float* m = p.rotation;
    const float radius = p.radius, by_ds = 1.0f / p.ds, by_dy = 1.0f / p.dy;
    out.regular = out.aside = out.special = out.in_reach = 0;
    Floats farthest{};
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const Floats h = load(in.height + first);
        const Floats nx = load(in.nx + first), ny = load(in.ny + first), nz = load(in.nz + first);
        const Floats px = load(in.x + first) + h * nx;
        const Floats py = load(in.y + first) + h * ny;
        const Floats pz = load(in.z + first) + h * nz;
        const Floats x = m[0] * px + m[1] * py + m[2] * pz + in.origin[0];
        const Floats y = m[3] * px + m[4] * py + m[5] * pz + in.origin[1];
        const Floats z = m[6] * px + m[7] * py + m[8] * pz + in.origin[2];
        const Floats n_x = m[0] * nx + m[1] * ny + m[2] * nz;
        const Floats n_y = m[3] * nx + m[4] * ny + m[5] * nz;
        const Floats n_z = m[6] * nx + m[7] * ny + m[8] * nz;
        const Floats along = z + radius;
        const Floats r = root(x * x + along * along);
        Floats drop, drop_slope;
        shape(p, smaller(larger(y, all(-p.half_width)), all(p.half_width)), drop, drop_slope);
        // r - radius without its cancellation.
        const Floats gap = (x * x + z * z + 2.0f * radius * z) / (r + radius) + drop;
        const Floats inverse = 1.0f / r;
        const Floats sine = x * inverse, cosine = along * inverse;
        const Floats n_radial = n_x * sine + n_z * cosine;
        const Floats n_tangential = n_x * cosine - n_z * sine;
        const Floats away = magnitude(y);
        const Floats lowest = along - (h + p.depth) * n_z;  // the segment's other end
        const Ints seen = (along > 0.0f) & (gap <= p.seen) & (n_radial <= -kSteepest) &
                          (away <= p.width_limit) & ((along >= p.ahead) | (lowest >= p.ahead));
        const Floats tangent = x / (along + r);  // of half the angle
        const Floats q = tangent * tangent;
        const Ints special = seen & (q > kWidestAngle), known = seen & ~special;
        const Ints aside = known & (away > p.side_limit), regular = known & ~aside;
        const Ints in_reach = regular & (gap <= p.reach);
        out.regular |= bits(regular) << first;
        out.aside |= bits(aside) << first;
        out.special |= bits(special) << first;
        out.in_reach |= bits(in_reach) << first;
        const Floats s = kept(2.0f * radius * tangent * angle_by(q), known);
        farthest = larger(farthest, kept(magnitude(s), in_reach));
        const Floats at_s = s * by_ds;
        const Ints cut = __builtin_convertvector(at_s, Ints);
        const Ints column = cut + (__builtin_convertvector(cut, Floats) > at_s);
        const Floats u = at_s - __builtin_convertvector(column, Floats);
        const Floats at_y = kept(y * by_dy + p.middle_row, known);
        Ints row = __builtin_convertvector(larger(at_y, Floats{}), Ints);
        row = row < p.last_row ? row : Ints{} + p.last_row;
        const Floats beyond = at_y - __builtin_convertvector(row, Floats);
        const Floats v =
            p.middle_row > 0.0f ? smaller(larger(beyond, Floats{}), all(1.0f)) : Floats{};
        const Floats steep = -1.0f / n_radial;
        const Floats slope_s = n_tangential * steep * (r * (p.ds / radius));
        const Floats slope_y = (n_y * steep + drop_slope) * p.dy;
        store(out.gap + first, gap - slope_s * u - slope_y * beyond);
        store(out.u + first, u);
        store(out.v + first, v);
        store(out.slope_s + first, slope_s);
        store(out.slope_y + first, slope_y);
        store(out.own_gap + first, gap);
        store(out.facing + first, cosine);
        store(out.weight + first, -n_radial * load(in.area + first));
        store(out.cell + first, column);
        store(out.row + first, row);
        store(across + first, y);
    }
    out.farthest = 0.0f;
    for (int k = 0; k < kWide; ++k)
        if (farthest[k] > out.farthest) out.farthest = farthest[k];
}

BELTGRINDING_CLONES
void number_cells(PlacedBlock& placed, int columns, int middle) {
    std::uint64_t regular = 0;
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const Ints column = load(placed.cell + first) + middle;
        const Ints here = mask_of(placed.regular, first) & (column >= 0) & (column < columns - 1);
        regular |= bits(here) << first;
        store(placed.cell + first, (load(placed.row + first) * columns + column) & here);
    }
    placed.regular = regular;
}

BELTGRINDING_CLONES
void range_cells(const PlacedBlock& placed, int above, double* nearest, double* farthest) {
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const auto lanes = static_cast<std::uint32_t>((placed.regular >> first) & 0xFFU);
        if (lanes == 0) continue;
        const Ints right = load(placed.u + first) >= 0.5f, up = load(placed.v + first) >= 0.5f;
        alignas(32) std::int32_t own[kWide];
        alignas(32) float gap[kWide];
        store(own, own_cells(placed, first, above));
        store(gap, load(placed.gap + first) + kept(load(placed.slope_s + first), right) +
                       kept(load(placed.slope_y + first), up));
        for (int k = 0; k < kWide; ++k) {
            if ((lanes >> k & 1U) == 0) continue;
            double &low = nearest[own[k]], &high = farthest[own[k]];
            const auto here = static_cast<double>(gap[k]);
            low = here < low ? here : low;
            high = here > high ? here : high;
        }
    }
}

void clear_cells(FourCells* cells, std::size_t count) {
    constexpr float kNone = std::numeric_limits<float>::infinity();
    constexpr FourCells kEmpty{
        {}, {}, {kNone, kNone, kNone, kNone}, {-kNone, -kNone, -kNone, -kNone}};
    std::fill_n(cells, count, kEmpty);
}

BELTGRINDING_CLONES
void gather_cells(const PlacedBlock& placed, int above, FourCells* cells, std::uint8_t* inhabited) {
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const auto lanes = static_cast<std::uint32_t>((placed.regular >> first) & 0xFFU);
        if (lanes == 0) continue;
        Four by_lane[kWide], carried[kWide];
        share_out(placed, first, by_lane, carried);
        alignas(32) std::int32_t own[kWide];
        store(own, own_cells(placed, first, above));
        for (int k = 0; k < kWide; ++k) {
            if ((lanes >> k & 1U) == 0) continue;
            inhabited[own[k]] = 1;
            FourCells& to = cells[placed.cell[first + k]];
            add(to.weight, by_lane[k]);
            add(to.gap, by_lane[k] * carried[k]);
            Four low, high;
            __builtin_memcpy(&low, to.low, sizeof low);
            __builtin_memcpy(&high, to.high, sizeof high);
            low = carried[k] < low ? carried[k] : low;
            high = carried[k] > high ? carried[k] : high;
            __builtin_memcpy(to.low, &low, sizeof low);
            __builtin_memcpy(to.high, &high, sizeof high);
        }
    }
}

void spread_cells(const FourCells* cells, std::size_t count, int above, const CellSums& sums) {
    for (std::size_t first = 0; first < count; ++first) {
        const FourCells& from = cells[first];
        if (!(from.low[0] <= from.high[0])) continue;  // no sample
        const auto next = first + static_cast<std::size_t>(above);
        const std::size_t to[4] = {first, first + 1, next, next + 1};
        for (std::size_t k = 0; k < 4; ++k) {
            sums.weight[to[k]] += from.weight[k];
            sums.gap[to[k]] += from.gap[k];
            if (sums.low == nullptr) continue;
            sums.low[to[k]] = std::min(sums.low[to[k]], from.low[k]);
            sums.high[to[k]] = std::max(sums.high[to[k]], from.high[k]);
        }
    }
}

BELTGRINDING_CLONES
void average_cells(const PlacedBlock& placed, int above, const std::uint8_t* wanted,
                   const float* limit, FourCells* cells) {
    for (int first = 0; first < kBlockLanes; first += kWide) {
        std::uint32_t lanes = 0;
        for (int k = 0; k < kWide; ++k) lanes |= std::uint32_t{wanted[placed.cell[first + k]]} << k;
        lanes &= static_cast<std::uint32_t>(placed.regular >> first);
        if (lanes == 0) continue;
        Four by_lane[kWide], carried[kWide];
        share_out(placed, first, by_lane, carried);
        for (; lanes != 0; lanes &= lanes - 1) {
            const int k = __builtin_ctz(lanes);
            const std::int32_t at = placed.cell[first + k];
            const Four limits{limit[at], limit[at + 1], limit[at + above], limit[at + above + 1]};
            const FourInts near = carried[k] <= limits;
            const Four share =
                reinterpret_cast<Four>(reinterpret_cast<FourInts>(by_lane[k]) & near);
            FourCells& to = cells[at];
            add(to.weight, share);
            add(to.gap, share * carried[k]);
            to.low[0] = to.high[0] = 0.0f;  // there is one
        }
    }
}

BELTGRINDING_CLONES
std::uint64_t lanes_near(const PlacedBlock& placed, int columns, float column, float row, float ds,
                         float dy, float reach) {
    std::uint64_t lanes = 0;
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const Ints rows = load(placed.row + first);
        const Ints at = load(placed.cell + first) - rows * columns;
        const Floats s =
            (__builtin_convertvector(at, Floats) + load(placed.u + first) - column) * ds;
        const Floats y =
            (__builtin_convertvector(rows, Floats) + load(placed.v + first) - row) * dy;
        lanes |= bits(s * s + y * y <= reach * reach) << first;
    }
    return lanes & placed.regular;
}

BELTGRINDING_CLONES
bool interpolate(const PlacedBlock& placed, const Bilinear* table, float least, float* values) {
    Ints any{};
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const Floats value = larger(between(placed, table, first), all(least));
        any |= value != 0.0f;
        store(values + first, value);
    }
    return bits(any) != 0;
}

BELTGRINDING_CLONES
void raise_to(const PlacedBlock& placed, const Bilinear* table, float* largest) {
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const Floats value = between(placed, table, first);
        store(largest + first, larger(load(largest + first), value));
    }
}

BELTGRINDING_CLONES
double volume_of(const float* values, const float* area) {
    Doubles sum{};
    for (int first = 0; first < kBlockLanes; first += kWide)
        sum += __builtin_convertvector(load(values + first), Doubles) *
               __builtin_convertvector(load(area + first), Doubles);
    double total = 0.0;
    for (int k = 0; k < kWide; ++k) total += sum[k];
    return total;
}

BELTGRINDING_CLONES
Standing stand_off(const PlacedBlock& placed, const float* lowering, float approach, float bent,
                   float room) {
    Standing result{0, 0, 0};
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const Floats asked = load(lowering + first);
        const Floats overlap =
            approach * load(placed.facing + first) - load(placed.own_gap + first);
        const Ints some = asked > 0.0f;
        const Ints free = some & (overlap - bent >= room * asked);
        const Ints onto = some & (overlap <= 0.0f);
        result.free |= bits(free) << first;
        result.onto |= bits(onto) << first;
        result.unsure |= bits(some & ~free & ~onto) << first;
    }
    return result;
}

BELTGRINDING_CLONES
Lowered lower_block(double* height, const float* lowering, const float* area, double factor,
                    std::uint64_t lanes) {
    Doubles taken{}, low{}, high{};
    for (int first = 0; first < kBlockLanes; first += kWide) {
        const Floats by = kept(load(lowering + first), mask_of(lanes, first));
        const Doubles wide = factor * __builtin_convertvector(by, Doubles);
        const Doubles at = load_doubles(height + first) - wide;
        __builtin_memcpy(height + first, &at, sizeof at);
        taken += wide * __builtin_convertvector(load(area + first), Doubles);
        low = first == 0 ? at : (at < low ? at : low);
        high = first == 0 ? at : (at > high ? at : high);
    }
    Lowered result{low[0], high[0], 0.0};
    for (int k = 0; k < kWide; ++k) {
        if (low[k] < result.lowest) result.lowest = low[k];
        if (high[k] > result.highest) result.highest = high[k];
        result.volume += taken[k];
    }
    return result;
}

}  // namespace beltgrinding

#pragma once

#include <cstdint>

namespace beltgrinding {

// What a step does with most samples, eight at a time. Each lane does the same operations in the
// same order whatever the processor has, so that all give the same bits; no header of these loops
// may bring in inline functions that other units have as well.

constexpr int kBlockLanes = 64;
// A surface steeper than this against the wheel is its flank or back, which the wheel cannot press:
// cosine of the angle between surface normal and wheel's radius.
constexpr float kSteepest = 0.2f;

/// A block of samples as the wheel sees it. Only lanes in `regular` have values: those of samples
/// on whole cells, of one layer, under the wheel's width; and before `number_cells` those in
/// `aside`, at the wheel's side faces. The cells are the four that a sample lies
/// between.
struct alignas(64) PlacedBlock {
    float gap[kBlockLanes];                // mm, carried to the first cell's centre
    float u[kBlockLanes], v[kBlockLanes];  // weights of the cells of higher s, of higher y
    float slope_s[kBlockLanes], slope_y[kBlockLanes];  // mm by a cell
    float own_gap[kBlockLanes];                        // mm, radial, at the sample itself
    float facing[kBlockLanes];       // cosine of the wheel's radius there against the contact's z
    float weight[kBlockLanes];       // mm2: area times the cosine of its normal against that radius
    std::int32_t cell[kBlockLanes];  // the first; before `number_cells` its column from the middle
    std::int32_t row[kBlockLanes];
    std::uint64_t regular, aside;  // lanes
    std::uint64_t special;         // lanes that are to be placed one by one
    std::uint64_t in_reach;        // regular ones with a gap within `Placing::reach`
    float farthest;                // mm, largest |s| of those
    std::uint32_t block;
};

/// A stretch of the wheel's profile: drop = at + slope * y, mm, up to y = `end`.
struct ProfileStretch {
    float end, at, slope;
};

/// The wheel over the work; lengths in mm.
struct Placing {
    float rotation[9];  // contact_from_work, by rows
    float radius, half_width;
    float reach;        // gaps beyond are not asked for
    float seen;         // gaps beyond are left out
    float width_limit;  // |y| beyond is left out
    float side_limit;   // |y| beyond is aside
    float ahead;        // from the wheel's axis: no part of the segment beyond is left out
    float depth;        // of the segments below the design
    float crown;        // radius; 0: none
    const ProfileStretch* profile;
    int stretches;
    float ds, dy;
    float middle_row;  // of y = 0, in cells
    int last_row;      // that is the first of two
};

/// A block's samples (arrays of 64) and where its origin is in the contact's frame.
struct SampleArrays {
    const double* height;
    const float *x, *y, *z, *nx, *ny, *nz, *area;
    float origin[3];
};

/// Fills `out` but for `block`, and `across`: y of all lanes, mm.
void place_block(const Placing& placing, const SampleArrays& in, PlacedBlock& out, float* across);

/// Makes cells of columns and rows, `columns` in a row, the middle one being number `middle`. Lanes
/// beyond the last column are regular no longer.
void number_cells(PlacedBlock& placed, int columns, int middle);

/// What samples tell of the four cells that they lie between, gathered by the first of the four.
struct alignas(32) FourCells {
    double weight[4];       // mm2
    double gap[4];          // mm, by weight
    float low[4], high[4];  // mm, of what is in that mean
};
void clear_cells(FourCells* cells, std::size_t count);
/// Adds all regular samples to `cells`, and sets to 1 in `inhabited` the cells that they lie in.
void gather_cells(const PlacedBlock& placed, int above, FourCells* cells, std::uint8_t* inhabited);

/// What samples tell of each cell.
struct CellSums {
    double* gap;        // mm, by weight
    double* weight;     // mm2
    float *low, *high;  // mm, of what is in that mean
};
/// Adds what was gathered of `count` cells.
void spread_cells(const FourCells* cells, std::size_t count, int above, const CellSums& sums);

/// Lowers `nearest` and raises `farthest` (mm, by cell) to the gaps of the samples in each cell.
/// `above`: cells to the next row, 0 if there is one row.
void range_cells(const PlacedBlock& placed, int above, double* nearest, double* farthest);

/// The same for first cells that are `wanted` (1) only, of those samples only that lie no deeper
/// than `limit` (mm, by cell) of each cell, and without `low` and `high`.
void average_cells(const PlacedBlock& placed, int above, const std::uint8_t* wanted,
                   const float* limit, FourCells* cells);

/// What is true at (u, v) between four cells: a + b u + c v + d u v.
struct Bilinear {
    float a, b, c, d;
};

/// Values of the regular lanes by the table of their first cells, none below `least`; 0 in the
/// others. False if all are 0.
bool interpolate(const PlacedBlock& placed, const Bilinear* table, float least, float* values);
/// Regular lanes within `reach` cells (along: of `ds`, across: of `dy` mm) of column and row.
std::uint64_t lanes_near(const PlacedBlock& placed, int columns, float column, float row, float ds,
                         float dy, float reach);

/// Raises `largest` to the interpolated values.
void raise_to(const PlacedBlock& placed, const Bilinear* table, float* largest);

/// Sum of values times areas.
double volume_of(const float* values, const float* area);

/// Which lanes may be lowered as asked (mm) without reaching the wheel's envelope.
struct Standing {
    std::uint64_t free;    // by `room` times as much at least
    std::uint64_t onto;    // not at all: on the envelope, or out of it
    std::uint64_t unsure;  // to be looked at one by one
};
/// `approach` and `bent`: mm, of the envelope; `room`: times the lowering.
Standing stand_off(const PlacedBlock& placed, const float* lowering, float approach, float bent,
                   float room);

/// Lowers `height` (mm) by `factor` times `lowering` in `lanes`. Gives the block's lowest and
/// highest height, and the volume taken, mm3.
struct Lowered {
    double lowest, highest, volume;
};
Lowered lower_block(double* height, const float* lowering, const float* area, double factor,
                    std::uint64_t lanes);

}  // namespace beltgrinding

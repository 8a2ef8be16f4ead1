#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// A sample on the grid, shared by four cells, that is placed by itself: near an edge or a step, at
/// the wheel's side faces, or with a ray that is not its normal.
struct Footprint {
    double gap;  ///< mm, at (s, y); once on the grid, carried to the first cell's centre
    std::size_t position;
    std::uint32_t sample;
    int cell;                ///< the first of the four: lower s, lower y
    float s, y;              ///< mm
    float slope_s, slope_y;  ///< once on the grid, by a cell
    float u, v;              ///< weights of the cells of higher s, of higher y
    float shares[4];         ///< of the four cells in what is true at the sample; sum 1, or all 0
    float inside;            ///< share of its patch that lies within the wheel's width
    float own_gap;           ///< mm, radial, at the sample itself
    float cosine;            ///< of its normal against the wheel's radius
    float facing;            ///< cosine of the wheel's radius there against the contact's z
    float area;              ///< mm2, of the design surface
    float taken;             ///< share of what the cells' rate asked for that the envelope let go
    bool on_grid;            ///< else it is beyond what is in reach
    bool nearest;            ///< belongs to the layer nearest to the wheel
};

/// What a sample stands for, as a rectangle: middle and half its sides, mm.
struct Patch {
    double s, y, half_s, half_y;
};

/// Cells from one row to the next; 0 if there is one row.
inline int row_step(const ContactGrid& grid) {
    return grid.ny > 1 ? grid.nx : 0;
}

/// The one of the four cells that the sample lies in.
inline int own_cell(const ContactGrid& grid, const Footprint& f) {
    const int right = f.u >= 0.5f ? 1 : 0, up = f.v >= 0.5f ? grid.nx : 0;
    return f.cell + right + up;
}

/// Calls visit(cell, weight, gap carried to its centre) for each of the four cells.
template <class Visit>
void for_cells(const ContactGrid& grid, const Footprint& f, Visit visit) {
    const int above = f.cell + row_step(grid);
    visit(f.cell, (1.0f - f.u) * (1.0f - f.v), f.gap);
    visit(f.cell + 1, f.u * (1.0f - f.v), f.gap + f.slope_s);
    visit(above, (1.0f - f.u) * f.v, f.gap + f.slope_y);
    visit(above + 1, f.u * f.v, f.gap + f.slope_s + f.slope_y);
}

/// What `values` (one per cell) are at the sample.
inline double value_at(const ContactGrid& grid, const Footprint& f, const Eigen::ArrayXd& values) {
    const int above = f.cell + row_step(grid);
    return f.shares[0] * values[f.cell] + f.shares[1] * values[f.cell + 1] +
           f.shares[2] * values[above] + f.shares[3] * values[above + 1];
}

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// How much of each cell of a grid the workpiece covers, and where in the cell that lies. An edge
/// of the workpiece, or a step in it, covers cells in part.
struct Coverage {
    /// Share of the cell, [0, 1]; once slivers are merged a cell may have its neighbours' as well.
    Eigen::ArrayXd share;
    /// Middle of the covered part from that of the cell, in cells.
    Eigen::ArrayXd along, across;

    /// Nothing is covered.
    void clear(Eigen::Index cells);
    /// Gives what covers less than a quarter of its cell to the neighbour (along or across the
    /// wheel) that is covered most, if that has a quarter at least: the wheel yields so little
    /// under a sliver that its pressure, alone, would be of no use. Less than a twentieth that has
    /// no such neighbour is left out.
    void merge_slivers(const ContactGrid& grid);
};

/// The side of cell (i, j) along and across the wheel on which the workpiece ends: -1, 1, or 0
/// where it does not, or on both. It goes on beyond the grid.
struct OpenSides {
    int along, across;
};
OpenSides open_sides(const ContactGrid& grid, const Eigen::ArrayXd& share, int i, int j);

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

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

/// What an evenly pressed line of cells sinks in more than the line beside it, in kappa: 3/2 less
/// the mean over that line, which is 3/2 - 2 ln 2 (1.39 apart; 1.65 in the middles of the cells).
constexpr double kLineOverBeside = 1.5;

/// Where a cell's load acts at an edge of the workpiece, for a wheel whose cells press on one
/// another. Pressure at a sharp edge goes with one over the root of the distance: on a strip of
/// width w (in cells) its middle is 2 w / 3 from the inner side, where two cells bear it together.
/// Of itself the strip sinks in as a line load of its width and form does, by a logarithm more than
/// an even load on the cell: kappa (ln(1 / w) + 3/2 - 2 ln 2) (Johnson, Contact Mechanics, 1985,
/// section 2.3: the mean of -ln |x - t|, by the load itself). Away from edges: kappa ln(1 / w).
class EdgeLoads {
  public:
    /// kappa, mm per MPa on the whole cell, of strips along and across the wheel.
    struct Softness {
        double along = 0.0, across = 0.0;
    };

    EdgeLoads() = default;
    explicit EdgeLoads(Softness softness) : softness_(softness) {}
    /// Finds the edges of `share` on a grid, unless they are those of the last call.
    void find(const ContactGrid& grid, const Eigen::ArrayXd& share);
    /// Puts `load` (MPa on the whole cell) where it acts.
    void place(Eigen::ArrayXd& load);
    /// What cells sink in under the load that was placed last, from what the grid does: mm.
    void sink(Eigen::ArrayXd& displacement) const;

  private:
    struct Part {
        int cell;
        std::array<int, 4> cells;      // that bear its load
        std::array<double, 4> shares;  // of it
        double softness;               // mm/MPa, beyond what the grid sinks in
    };
    Softness softness_;
    ContactGrid grid_;
    Eigen::ArrayXd share_;
    std::vector<Part> parts_;
    std::vector<double> loads_;            // of the parts
    mutable std::vector<double> sinking_;  // work space
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "contact/coverage.h"

namespace beltgrinding {

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
    EdgeLoads() = default;
    explicit EdgeLoads(EdgeSoftness softness) : softness_(softness) {}
    const EdgeSoftness& softness() const { return softness_; }
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
    /// Of cell (i, j), of which the share w is covered.
    Part part_at(int i, int j, double w, const OpenSides& open) const;

    EdgeSoftness softness_;
    ContactGrid grid_;
    Eigen::ArrayXd share_;
    std::vector<Part> parts_;
    std::vector<double> loads_;            // of the parts
    mutable std::vector<double> sinking_;  // work space
};

}  // namespace beltgrinding

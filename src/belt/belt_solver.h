#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "belt_basis.h"
#include "belt_energy.h"
#include "belt_factor.h"
#include "belt_path.h"
#include "belt_support.h"
#include "beltgrinding/belt_machine.h"
#include "beltgrinding/contact_model.h"
#include "surface_under_belt.h"

namespace beltgrinding {

/// The belt about a path: what it deflects, what pulls it, where it touches.
struct BeltState {
    BeltPath path;
    Eigen::MatrixXd deflection;  ///< (splines, columns), mm
    Eigen::ArrayXXd load;        ///< N a cell of rows and columns, along the path's normal
    double lift = 0.0;           ///< mm, what the work was raised by from where it was mapped
    double pull = 0.0;           ///< N/mm along the belt
    int iterations = 0;
    bool converged = false;

    /// Of memory, about.
    std::size_t bytes() const;
};

/// Solves the contact of a belt about a path: the least of the energy of bending, stress and face
/// springs, which are on or off, by Newton's method on a line.
class BeltSolver {
  public:
    /// Thick: the face deflects more than the middle surface, by shear and by the thickness, under
    /// what is short against that; thin: by a quarter of that.
    enum class Sheet { kThin, kThick };

    BeltSolver(const AbrasiveBelt& belt, const BeltRun& run, const ContactGrid& grid, Sheet sheet);

    const std::vector<BeltRow>& rows() const { return rows_; }
    /// The depth is not given, but what a force or a robot that gives way makes of it.
    static bool yields(const ContactProblem& problem) { return BeltDrive{problem, 0.0}.yields(); }
    /// N/mm along a belt that is longer than the path by `elongated` mm.
    double pull_of(const BeltPath& path, double elongated) const;
    /// mm that a path's own turn, 1/mm, moves the face by from half a thickness off the middle
    /// surface.
    double face_moved_by(double turn) const { return shear_ * turn; }
    /// mm that the belt's face deflects by at the middles of rows and columns, of a state's
    /// deflection.
    Eigen::ArrayXXd face_deflection(const BeltColumns& columns,
                                    const Eigen::MatrixXd& coefficients) const {
        return basis_.finest().face.deflection(columns, coefficients);
    }

    struct Request {
        const ContactProblem* problem = nullptr;  ///< control, tolerance, iterations
        const BeltGap* gap = nullptr;             ///< as seen from the path
        double depth = 0.0;  ///< mm that the work has been raised by in that gap
        /// Where pressure is expected, row by row of each column; empty: nothing is known.
        std::vector<std::uint8_t> touching = {};
        const BeltState* before = nullptr;  ///< to start from
        double lift = 0.0;                  ///< mm, the same
        BeltBacking* backing = nullptr;
    };
    BeltState solve(BeltPath path, Request request);

  private:
    /// With the splines as they are.
    BeltState solve_on(BeltPath path, const Request& request);
    /// By every other knot, to say where pressure is.
    BeltState solve_roughly(BeltPath path, const Request& request);
    /// Where the one before was, on another path's columns.
    BeltIterate start(const Request& request, const BeltPath& path) const;
    /// Newton's method, from there to the energy's least: iterations, and whether it is found.
    void descend(BeltEnergy& energy, BeltIterate& at, BeltState& state);
    /// Lifts the work until it touches the belt. False: there is none.
    bool touch(BeltIterate& at) const;

    AbrasiveBelt belt_;
    BeltRun run_;
    double shear_;  // mm2: of the face's deflection, by what the sheet is bent
    std::vector<BeltRow> rows_;
    BeltBasis basis_;
    BeltSupport support_;
    BeltFactor factor_;
};

}  // namespace beltgrinding

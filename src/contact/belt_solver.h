#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "belt_path.h"
#include "belt_sheet.h"
#include "belt_spline.h"
#include "beltgrinding/belt_machine.h"
#include "beltgrinding/contact_model.h"
#include "block_banded.h"
#include "surface_under_belt.h"

namespace beltgrinding {

/// What lies behind the belt and bears it where the belt is pressed on it: linear about a state,
/// one value a cell of the rows (rows) and the path's columns (columns).
class BeltBacking {
  public:
    virtual ~BeltBacking() = default;
    /// mm of deflection from which on it bears, and what then adds to the pressure, MPa/mm.
    const Eigen::ArrayXXd& rest() const { return rest_; }
    double stiffness() const { return stiffness_; }
    /// Follows a deflection, mm; the share of what it bears that has changed.
    virtual double follow(const Eigen::ArrayXXd& deflection) = 0;

  protected:
    Eigen::ArrayXXd rest_;
    double stiffness_ = 0.0;
};

/// The belt about a path: what it deflects, what pulls it, where it touches.
struct BeltState {
    BeltPath path;
    Eigen::MatrixXd deflection;  ///< (splines, columns), mm
    Eigen::MatrixXd function;    ///< of the stress, as of `BeltStress`
    Eigen::ArrayXXd load;        ///< N a cell of rows and columns, along the path's normal
    double lift = 0.0;           ///< mm, what the work was raised by from where it was mapped
    double pull = 0.0;           ///< N/mm along the belt
    double lean = 0.0;           ///< N/mm more at the edge at +y
    int iterations = 0;
    bool converged = false;

    /// Of memory, about.
    std::size_t bytes() const;
};

/// Solves the contact of a belt about a path: Newton's method on where it touches (the face's
/// springs are on or off), while its stress and its length follow.
class BeltSolver {
  public:
    /// Thin: what deflects is the middle surface, as Kirchhoff has it; thick: its face, which shear
    /// and the thickness let deflect more under what is short against that.
    enum class Sheet { kThin, kThick };

    BeltSolver(const AbrasiveBelt& belt, const BeltRun& run, const ContactGrid& grid, Sheet sheet);

    const std::vector<BeltRow>& rows() const { return rows_; }
    /// The depth is not given, but what a force or a robot that gives way makes of it.
    static bool yields(const ContactProblem& problem) {
        return problem.force_control || problem.robot_compliance > 0.0;
    }
    /// N/mm along a belt that is longer than the path by `elongated` mm.
    double pull_of(const BeltPath& path, double elongated) const;
    /// mm that the belt's face deflects by at the middles of a row and a column of the path.
    double deflection_at(const BeltColumns& columns, const Eigen::MatrixXd& coefficients,
                         std::size_t row, int column) const;

    struct Request {
        const ContactProblem* problem = nullptr;  ///< control, tolerance, iterations
        const BeltGap* gap = nullptr;             ///< as seen from the path
        double depth = 0.0;  ///< mm that the work has been raised by in that gap
        /// Where pressure is expected, row by row of each column; empty: nothing is known.
        std::vector<std::uint8_t> touching = {};
        const BeltState* before = nullptr;  ///< to start from, if its columns are the same
        BeltBacking* backing = nullptr;
    };
    BeltState solve(BeltPath path, Request request);

  private:
    /// mm by row and column, and the forces there under the deflection, N: the work's less the
    /// backing's. `raised` is that by which the work has been lifted.
    struct Cells {
        Eigen::ArrayXXd deflection, force;
        double raised = 0.0;
    };
    struct Sums {
        double total = 0.0, change = 0.0, along_z = 0.0;  // N
        bool same = true;
    };
    void assemble(const Request& request, const BeltState& state, const BeltForces& forces);
    /// N that the work is pressed with where it has been lifted by so much.
    static double commanded(const Request& request, double lift);
    /// mm that the work must rise for the force.
    double lift_for(const Request& request, const BeltState& state) const;
    /// What the last solution deflects by, and the forces of the springs that were on.
    Cells solved(const Request& request, const BeltState& state, double lift) const;
    /// The share of the way from one state to the other, up to 1, at which the energy is least.
    double least_energy(const Request& request, const BeltPath& path, const Cells& from,
                        const Cells& to) const;
    /// The derivative of the energy on that way, N mm.
    double slope(const Request& request, const BeltPath& path, const Cells& from, const Cells& to,
                 double share) const;
    /// Where belt and work overlap now, and where the backing bears.
    Sums touch(Request& request, BeltState& state, const Cells& cells);
    double work_force(const Request& request, const BeltPath& path, int i, std::size_t k,
                      double deflection, double lift) const;
    double backing_force(const Request& request, const BeltPath& path, int i, std::size_t k,
                         double deflection) const;
    /// The change of the pull.
    double follow_length(const Request& request, BeltState& state, const BeltStress& stress) const;
    std::size_t cell(int column, std::size_t row) const {
        return static_cast<std::size_t>(column) * rows_.size() + row;
    }
    /// mm along the normal at which the face meets the work, as the path's own turn has it.
    double reach_at(const Request& request, const BeltPath& path, int i, std::size_t k) const {
        return request.gap->reach(static_cast<Eigen::Index>(k), i) +
               shear_ * path.turn[static_cast<std::size_t>(i)];
    }
    double spring(const Request& request, const BeltColumns& columns, int i, std::size_t k) const {
        const double face = face_ / (1.0 + face_ * request.problem->recession);
        return face * request.gap->cover(static_cast<Eigen::Index>(k), i) * rows_[k].width *
               columns.width[static_cast<std::size_t>(i)];
    }

    AbrasiveBelt belt_;
    BeltRun run_;
    double face_;   // MPa/mm
    double shear_;  // mm2: of the face's deflection, by what the sheet is bent
    std::vector<BeltRow> rows_;
    BeltSpline spline_;
    BeltSheet plate_;
    std::vector<BeltSpline::Local> locals_;  // by row
    BlockBanded matrix_;
    std::vector<std::uint8_t> borne_;  // by cell: the backing bears
    Eigen::MatrixXd right_;            // loads, then deflections: as it lies; by a lift of 1 mm
};

}  // namespace beltgrinding

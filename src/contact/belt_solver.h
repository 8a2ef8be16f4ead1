#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "belt_across.h"
#include "belt_path.h"
#include "belt_spline.h"
#include "belt_stress.h"
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
    static bool yields(const ContactProblem& problem) {
        return problem.force_control || problem.robot_compliance > 0.0;
    }
    /// N/mm along a belt that is longer than the path by `elongated` mm.
    double pull_of(const BeltPath& path, double elongated) const;
    /// mm that a path's own turn, 1/mm, moves the face by from half a thickness off the middle
    /// surface.
    double face_moved_by(double turn) const { return shear_ * turn; }
    /// mm that the belt's face deflects by at the middles of rows and columns, of a state's
    /// deflection.
    Eigen::ArrayXXd face_deflection(const BeltColumns& columns,
                                    const Eigen::MatrixXd& coefficients) const {
        return finest_.face.deflection(columns, coefficients);
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
    BeltState solve_on(BeltPath path, Request& request);
    /// By row.
    std::vector<std::uint8_t> rows_touched(const std::vector<std::uint8_t>& touching) const;
    /// The splines' knots, mm; of the finest ones.
    void set_lines(const std::vector<double>& lines);
    /// By every other knot, to say where pressure is.
    BeltState solve_roughly(BeltPath path, Request& request);
    /// A deflection, the work's lift, what they strain.
    struct Iterate {
        Eigen::MatrixXd deflection;  // (splines, columns), mm
        Eigen::MatrixXd bent;        // N that bending resists it with
        Eigen::ArrayXXd cells;       // mm of the face, (rows, columns)
        double lift = 0.0;           // mm
        BeltModes strain, stress;
        BeltStress::Shape shape;
        Eigen::MatrixXd smooth;  // N on the splines of all but the contact
    };
    /// What the energy falls by where the belt and the work give way, and where it touches.
    struct Unbalanced {
        Eigen::MatrixXd belt;  // N, (splines, columns)
        double work = 0.0;     // N, along z
        double total = 0.0;    // N, sum of the contact's forces
        bool same = true;      // as before, where it touches
        bool borne = true;     // as before, where the backing bears
    };
    struct Step {
        Eigen::MatrixXd deflection;
        double lift = 0.0;
    };
    void start(const Request& request, BeltState& state, Iterate& at);
    /// How far the face reaches, its springs; which cells touch and bear to begin with.
    void set_contact(Request& request, const BeltPath& path, const Iterate& at);
    /// Strain, stress and what they and the bending push with, of the deflection and its shape.
    void strain(const BeltStress& stress, Iterate& at) const;
    /// `bonded`: springs pull as well, and only where it is said to touch.
    Unbalanced unbalanced(Request& request, const BeltPath& path, const Iterate& at, bool bonded);
    /// The factor of the energy's second derivatives, with so much of the stress, up to the share
    /// `most`, as leaves them positive.
    bool factorise(const Request& request, const BeltPath& path, const BeltStress& stress,
                   const Iterate& at, double most);
    /// The cells that touch the work and do not so in the factor, or the other way round.
    std::vector<std::size_t> switched(const Request& request) const;
    /// Solves for what a unit spring at these cells pushes the belt with, by the left half of the
    /// factor, where that is not yet known.
    void add_switched(const BeltPath& path, const std::vector<std::size_t>& cells);
    /// With the signs of the factor's rows, the lower ones of all columns.
    Eigen::MatrixXd signed_by_rows(Eigen::MatrixXd values) const;
    /// Newton's step by the factor; `again`: by that of a step before, but for its springs.
    Step step(const Request& request, const BeltPath& path, const BeltStress& stress,
              const Unbalanced& off, bool again);
    /// What the work's lift pushes the belt with, N/mm, and the work itself.
    Eigen::MatrixXd pushed_by_lift(const Request& request, const BeltPath& path, double& own) const;
    /// Goes along the step, up to its end, where the energy is least; the share of it. `off`: at
    /// the beginning, then where it leads.
    double go(Request& request, const BeltPath& path, const BeltStress& stress, const Step& step,
              bool whole, Iterate& at, Unbalanced& off);
    /// The share of the step at which the energy is least, which falls at its beginning and rises
    /// by `end` mm N at its end.
    double least_along(const Request& request, const BeltStress& stress, const Iterate& at,
                       const Iterate& change, double first, double end) const;
    /// Lifts the work until it touches the belt. False: there is none.
    bool touch(Iterate& at) const;
    /// N that the work is pressed with where it has been lifted by so much.
    static double commanded(const Request& request, double lift);
    std::size_t cell(int column, std::size_t row) const {
        return static_cast<std::size_t>(column) * rows_.size() + row;
    }

    AbrasiveBelt belt_;
    BeltRun run_;
    double face_;   // MPa/mm
    double shear_;  // mm2: of the face's deflection, by what the sheet is bent
    std::vector<BeltRow> rows_;
    BeltAcross finest_;
    // Where it is not the finest: as the contact is, and what it makes of the finest splines'
    // coefficients, and those of it.
    std::unique_ptr<BeltAcross> wider_;
    Eigen::MatrixXd to_wider_, from_wider_;
    const BeltAcross* across_ = &finest_;
    // Of these splines on the columns `prepared_for_`.
    BeltColumns prepared_for_;
    BeltBands bending_;
    BeltStress::Compliance compliance_;
    BeltBands bands_;
    Eigen::MatrixXd path_load_;  // (splines, columns), N
    BlockBanded matrix_;
    BeltStress::Coupling coupling_;  // in the factor
    // Beside the belt, the work's lift, the mean stress, what of it is linear across: what they
    // push the belt with, by the left half of the factor, and what is left of their own matrix.
    Eigen::MatrixXd borders_;
    Eigen::VectorXd border_own_;
    // By rows and columns: mm along the normal at which the face meets the work, as the path's own
    // turn has it; N/mm of the face and of the backing. By column: of the path's angle.
    Eigen::ArrayXXd reach_, springs_, backing_springs_;
    Eigen::ArrayXd cosine_;
    Eigen::ArrayXd backing_forces_;    // N, of a column
    Eigen::ArrayXXd forces_;           // N on the face, or the springs that are taken into a factor
    std::vector<std::uint8_t> borne_;  // by cell: the backing bears
    std::vector<std::uint8_t> touching_in_factor_;
    // Springs that were switched since: the same, and their products with the borders and among
    // each other.
    std::vector<std::size_t> switched_;
    Eigen::MatrixXd switched_borders_, products_;
};

}  // namespace beltgrinding

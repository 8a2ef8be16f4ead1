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
    /// mm that the belt's face deflects by at the middles of a row and a column of the path.
    double deflection_at(const BeltColumns& columns, const Eigen::MatrixXd& coefficients,
                         std::size_t row, int column) const;

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
    /// mm of the face at a place across, by `along` the weights of the columns beside.
    double face_of(const BeltSpline::Local& local, const std::array<double, 3>& along,
                   const Eigen::MatrixXd& coefficients, int column) const;
    /// The same at the middles of rows and columns, by the splines that there are now.
    Eigen::ArrayXXd face_at_cells(const BeltColumns& columns,
                                  const Eigen::MatrixXd& coefficients) const;
    /// A deflection, the work's lift, what they strain.
    struct Iterate {
        Eigen::MatrixXd deflection;  // (splines, columns), mm
        Eigen::MatrixXd bent;        // N that bending resists it with
        Eigen::ArrayXXd cells;       // mm at the middles of rows and columns
        double lift = 0.0;           // mm
        BeltModes strain, stress;
        BeltStress::Shape shape;
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
    void strain(const BeltStress& stress, Iterate& at) const;
    /// `bonded`: springs pull as well, and only where it is said to touch.
    Unbalanced unbalanced(Request& request, const BeltPath& path, const BeltStress& stress,
                          const BeltStress::Coupling& coupling, const Iterate& at, bool bonded);
    /// The factor of the energy's second derivatives, with so much of the stress, up to the share
    /// `most`, as leaves them positive.
    bool factorise(const Request& request, const BeltPath& path, const BeltStress& stress,
                   const BeltStress::Coupling& coupling, const Iterate& at, double most);
    /// The cells that touch the work and do not so in the factor, or the other way round.
    std::vector<std::size_t> switched(const Request& request) const;
    /// Solves for what a unit spring at these cells pushes the belt with, by the left half of the
    /// factor, where that is not yet known.
    void add_switched(const BeltPath& path, const std::vector<std::size_t>& cells);
    /// With the signs of the factor's rows, the lower ones of all columns.
    Eigen::MatrixXd signed_by_rows(Eigen::MatrixXd values) const;
    /// Newton's step by the factor; `again`: by that of a step before, but for its springs.
    Step step(const Request& request, const BeltPath& path, const BeltStress& stress,
              const BeltStress::Coupling& coupling, const Unbalanced& off, bool again);
    /// What the work's lift pushes the belt with, N/mm, and the work itself.
    Eigen::MatrixXd pushed_by_lift(const Request& request, const BeltPath& path, double& own) const;
    /// Goes along the step, up to its end, where the energy is least; the share of it.
    double go(const Request& request, const BeltPath& path, const BeltStress& stress,
              const Unbalanced& off, const Step& step, bool whole, Iterate& at) const;
    /// Lifts the work until it touches the belt. False: there is none.
    bool touch(Request& request, const BeltPath& path, Iterate& at) const;
    /// N that the work is pressed with where it has been lifted by so much.
    static double commanded(const Request& request, double lift);
    double backing_spring(const Request& request, const BeltColumns& columns, int i,
                          std::size_t k) const {
        return request.backing->stiffness() * rows_[k].width *
               columns.width[static_cast<std::size_t>(i)];
    }
    /// The face's deflection at a cell by the splines of the columns from `first` to `last`, of
    /// i - 1, i and i + 1.
    struct FaceForm {
        int first = 1, last = 1;
        std::array<std::array<double, BeltSpline::kLocal>, 3> values{};
    };
    FaceForm face_form(const BeltColumns& columns, std::size_t k, int i) const;
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
    BeltAcross finest_;
    // Where it is not the finest: as the contact is, and what it makes of the finest splines'
    // coefficients, and those of it.
    std::unique_ptr<BeltAcross> wider_;
    Eigen::MatrixXd to_wider_, from_wider_;
    const BeltAcross* across_ = &finest_;
    BeltBands bending_, bands_;
    Eigen::MatrixXd path_load_;  // (splines, columns), N
    BlockBanded matrix_;
    // Beside the belt, the work's lift, the mean stress, what of it is linear across: what they
    // push the belt with, by the left half of the factor, and what is left of their own matrix.
    Eigen::MatrixXd borders_;
    Eigen::VectorXd border_own_;
    std::vector<std::uint8_t> borne_;  // by cell: the backing bears
    std::vector<std::uint8_t> touching_in_factor_;
    // Springs that were switched since: the same, and their products with the borders and among
    // each other.
    std::vector<std::size_t> switched_;
    Eigen::MatrixXd switched_borders_, products_;
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "belt_path.h"
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

/// What bears the belt, cell by cell of its rows and a path's columns: the work, by springs of the
/// belt's face that are on where they touch; behind it the backing, where there is one.
class BeltSupport {
  public:
    struct Face {
        double stiffness;  ///< MPa/mm
        double thickness;  ///< mm, of the belt
        double shear;      ///< mm2, as of BeltFace
    };
    /// Keeps a reference to the rows.
    BeltSupport(const std::vector<BeltRow>& rows, const Face& face) : rows_(rows), face_(face) {}

    /// Where pressure is expected, row by row of each column; empty: nothing is known.
    void expect(std::vector<std::uint8_t> touching) { touching_ = std::move(touching); }
    /// How far the face reaches on a path's columns, its springs; which cells touch and bear to
    /// begin with. `recession`: mm/MPa. `deflection`: mm of the face; null: it is not known.
    void set(const BeltPath& path, const BeltGap& gap, double recession, BeltBacking* backing,
             const Eigen::ArrayXXd* deflection);

    const std::vector<BeltRow>& rows() const { return rows_; }
    const std::vector<std::uint8_t>& touching() const { return touching_; }
    bool touches() const;
    /// By row.
    std::vector<std::uint8_t> rows_touched() const;
    /// N/mm of a cell's spring, whether it touches or not; the cosine of its column's angle.
    double spring(std::size_t cell) const {
        return springs_(static_cast<Eigen::Index>(cell % rows_.size()), column(cell));
    }
    double cosine(std::size_t cell) const { return cosine_[column(cell)]; }
    int column(std::size_t cell) const { return static_cast<int>(cell / rows_.size()); }

    /// What the springs push with.
    struct Borne {
        double work = 0.0;    // N, along z: what the work is pressed with, less that on it
        double total = 0.0;   // N, sum of the contact's forces
        double behind = 0.0;  // N, that the backing bears
        bool same = true;     // as before, where it touches
        bool borne = true;    // as before, where the backing bears
    };
    /// For a deflection of the face, mm, and the work's lift, mm, which is pressed with `pressed`
    /// N; finds anew where they touch. `bonded`: springs pull as well, and only where it is said to
    /// touch.
    Borne bear(const Eigen::ArrayXXd& deflection, double lift, double pressed, bool bonded);
    /// N on the face, of the last call.
    const Eigen::ArrayXXd& forces() const { return forces_; }
    /// N/mm of the springs that are on.
    Eigen::ArrayXXd springs_on() const;
    /// N/mm that the work's lift pushes the face with; adds what the work is pushed with to `own`.
    Eigen::ArrayXXd pushed_by_lift(double& own) const;
    /// Adds to `slope`, mm N, what the springs' energy rises by along a change, `share` of it gone.
    double add_slope(double slope, const Eigen::ArrayXXd& deflection, double lift,
                     const Eigen::ArrayXXd& change, double change_lift, double share) const;
    /// mm that the work is to be lifted by until it touches; infinite: it never does.
    double short_of_touch(const Eigen::ArrayXXd& deflection, double lift) const;
    /// N a cell along the path's normal.
    Eigen::ArrayXXd load(const Eigen::ArrayXXd& deflection, double lift) const;
    /// Follows a deflection; as `BeltBacking::follow`.
    double follow(const Eigen::ArrayXXd& deflection) { return backing_->follow(deflection); }
    bool backed() const { return backing_ != nullptr; }

  private:
    std::size_t cell(Eigen::Index column, std::size_t row) const {
        return static_cast<std::size_t>(column) * rows_.size() + row;
    }
    /// Where the work may touch to begin with, as far as that is not expected.
    void set_touching(const BeltGap& gap);

    const std::vector<BeltRow>& rows_;
    Face face_;
    BeltBacking* backing_ = nullptr;
    // By rows and columns: mm along the normal at which the face meets the work, as the path's own
    // turn has it; N/mm of the face and of the backing. By column: of the path's angle.
    Eigen::ArrayXXd reach_, springs_, backing_springs_;
    Eigen::ArrayXd cosine_;
    Eigen::ArrayXXd forces_;              // N
    Eigen::ArrayXd backing_forces_;       // N, of a column
    std::vector<std::uint8_t> touching_;  // by cell: the face touches the work
    std::vector<std::uint8_t> borne_;     // by cell: the backing bears
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>
#include <vector>

#include "belt_path.h"
#include "belt_terms.h"
#include "block_banded.h"

namespace beltgrinding {

/// What a stress in the belt's plane is made of, or the strains that each of these does work on.
struct BeltModes {
    Eigen::MatrixXd function;  ///< of the stress function (kTerms, columns)
    double mean = 0.0;         ///< N/mm along the belt; or mm mm
    double lean = 0.0;         ///< N/mm more at the edge at +y; or mm mm
};

/// Stresses in the belt's plane by an Airy stress function, which is 0 with its slope at the side
/// edges: del^4 F = E t (w_xy^2 - w_xx w_yy). What does not vanish over the width, the mean and
/// what is linear across, comes from the belt's length between its rollers. What the sheet resists
/// with under them is the derivative of their work on the strains: all has an energy.
class BeltStress {
  public:
    static constexpr int kTerms = BeltTerms::kTerms;

    /// What the stress function gives way by on some columns, times E t, and its factor.
    struct Compliance {
        Compliance() = default;
        Compliance(const BeltTerms& terms, const BeltColumns& columns);
        BlockBanded matrix, factor;
    };

    /// `compliance`: on the path's columns; `resting`: N/mm along the path itself; `stretching`:
    /// N/mm more for each mm of the belt. All that is given has to outlive it.
    BeltStress(const AbrasiveBelt& belt, const BeltTerms& terms, const BeltPath& path,
               const Compliance& compliance, double resting, double stretching, double run_length);

    /// A deflection's derivatives at the spline's places: along the belt (x) and across (y), at the
    /// columns' borders and in the columns.
    struct Shape {
        Eigen::ArrayXXd x, xy, xx, yy;
    };
    Shape shape(const Eigen::MatrixXd& deflection) const;
    /// Strains that are bilinear in deflections: those of one are product(a, a) + turned.
    BeltModes product(const Shape& a, const Shape& b) const;
    /// Strains by the path's turns, linear in the deflection.
    BeltModes turned(const Eigen::MatrixXd& deflection) const;
    /// Stresses that strains add to those of the path itself.
    BeltModes stress(const BeltModes& strain) const;
    /// N/mm along the belt under that.
    double pull(const BeltModes& stress) const { return resting_ + stress.mean; }
    /// Adds what a share of a stress, and all of its mean, stiffen the sheet by, N/mm.
    void stiffen(const BeltModes& stress, double share, BeltBands& sheet) const;

    /// What strains change by with the deflection.
    struct Coupling {
        /// (kTerms padded, 3 * splines * columns): of column i's function, by the deflection of the
        /// columns i - 1, i, i + 1.
        BeltTerms::Terms function;
        Eigen::MatrixXd mean, lean;  ///< (splines, columns)
    };
    Coupling coupling(const Shape& shape) const;
    /// What stresses resist the deflection of that shape with, N: (splines, columns).
    Eigen::MatrixXd resistance(const Shape& shape, const BeltModes& stress) const;
    /// Adds the rows and columns of the stress function, which come first in each block, to the
    /// blocks in column i.
    void add_to(BlockBanded& matrix, int i, const Coupling& coupling) const;
    /// N/mm by mm mm.
    double mean_stiffness() const { return stretching_ / width_; }
    double lean_stiffness() const { return leaning_; }

  private:
    double membrane_, width_, resting_, stretching_, leaning_;
    const BeltTerms& terms_;
    const BeltSpline& spline_;
    const BeltPath& path_;
    const Compliance& compliance_;
};

}  // namespace beltgrinding

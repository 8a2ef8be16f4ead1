#pragma once

#include <Eigen/Core>

#include "belt_path.h"
#include "belt_spline.h"
#include "block_banded.h"

namespace beltgrinding {

/// Forces in the belt's plane, N/mm, at the spline's `places` (rows).
struct BeltForces {
    Eigen::ArrayXXd along;   ///< along the belt, at the columns' borders
    Eigen::ArrayXXd shear;   ///< at the columns' borders
    Eigen::ArrayXXd across;  ///< in the columns
};

/// The belt as a thin plate with large deflections (Foeppl and von Karman; Timoshenko,
/// Woinowsky-Krieger: Theory of Plates and Shells, section 100): what it deflects from a path,
/// along the path's normal, as splines across on columns along it. Its side edges are free, its
/// ends hinged.
class BeltSheet {
  public:
    BeltSheet(const AbrasiveBelt& belt, const BeltSpline& spline);

    const BeltSpline& spline() const { return spline_; }
    /// The stiffness of the belt under `forces`, N/mm.
    void stiffness(const BeltColumns& columns, const BeltForces& forces, BlockBanded& matrix) const;
    /// What the path's own turns load the belt with, N: column by column of the result.
    Eigen::MatrixXd path_load(const BeltPath& path, const BeltForces& forces) const;

  private:
    double bending_, ratio_;
    const BeltSpline& spline_;
};

/// Forces in the belt's plane by an Airy stress function, which is 0 with its slope at the side
/// edges: del^4 F = E t (w_xy^2 - w_xx w_yy). What does not vanish over the width, the mean and
/// what is linear across, comes from the belt's length between its rollers.
class BeltStress {
  public:
    static constexpr int kTerms = 6;  ///< polynomials across

    BeltStress(const AbrasiveBelt& belt, const BeltSpline& spline, const BeltPath& path);

    /// The stress function's coefficients (kTerms, columns) under a deflection.
    Eigen::MatrixXd function(const Eigen::MatrixXd& deflection) const;
    /// mm that the belt at each of the spline's places is longer than the path.
    Eigen::ArrayXd elongation(const Eigen::MatrixXd& deflection) const;
    /// `mean` and `lean`, N/mm: along the belt, and what is added from the middle to the edge at
    /// +y.
    BeltForces forces(const Eigen::MatrixXd& function, double mean, double lean) const;

  private:
    const AbrasiveBelt& belt_;
    const BeltSpline& spline_;
    const BeltPath& path_;
    Eigen::MatrixXd value_, slope_, curvature_;  // (places, kTerms), of the polynomials
    BlockBanded factor_;
};

}  // namespace beltgrinding

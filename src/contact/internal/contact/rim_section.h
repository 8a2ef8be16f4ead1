#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "contact/half_space.h"

namespace beltgrinding {

/// One rubber of a rim.
struct RimLayer {
    double thickness = 15.0;  ///< mm
    Elasticity elasticity;
};

/// The rubber rim of a wheel: of finite width with free side faces, bonded to a rigid core.
struct WheelRimDesign {
    double outer_radius = 100.0;   ///< mm
    double width = 50.0;           ///< mm
    std::vector<RimLayer> layers;  ///< from the core outwards, at least one

    double thickness() const;
    /// MPa/mm of the layers pressed one on the other, free to bulge: the softest that the rim can
    /// be. The layers must be valid.
    double softest() const;
    /// Throws InputError naming the layer and value that is none; Poisson's ratio up to 0.499.
    void validate() const;
};

/// Semi-analytical finite elements of a rim: displacements (U cos nt, V sin nt, W cos nt) around
/// the circumference, n = k R any real number, and quadratic elements with reduced integration
/// (which do not lock up to a Poisson's ratio of 0.499) over half of the cross-section, symmetric
/// or antisymmetric about the wheel's middle plane. Zienkiewicz, Taylor: The Finite Element Method,
/// chapter on semi-analytical processes.
class RimSection {
  public:
    /// `cells`: cells of equal width across the wheel. `finest`: mm, the smallest wavelength that
    /// matters; the elements under the surface are half as thick.
    RimSection(const WheelRimDesign& design, int cells, double finest);

    /// Numbers of even (symmetric) and odd combinations of the cells.
    int even() const { return (cells_ + 1) / 2; }
    int odd() const { return cells_ / 2; }
    /// Compliance between the cells for pressure cos(k s), mm/MPa: mean displacement into the wheel
    /// of cell i for unit pressure on cell j, in the orthonormal basis of even and odd
    /// combinations, counted from the middle plane outwards. Symmetric, positive definite.
    void compliance(double k, Eigen::MatrixXd& even, Eigen::MatrixXd& odd) const;

  private:
    struct Half {
        Eigen::SparseMatrix<double> k0, k1, k2;  // lower triangles of one pattern
        Eigen::MatrixXd loads;                   // scaled so that C = loads' K^-1 loads
    };
    void make_mesh(const WheelRimDesign& design, double finest);
    Half assemble(const WheelRimDesign& design, bool symmetric) const;
    static Eigen::MatrixXd solve(const Half& half, double n);

    double radius_;
    int cells_;
    std::vector<double> r_, y_;  // lines of the mesh, mm
    std::vector<int> layer_;     // of each row of elements
    std::vector<int> cell_;      // of each column of elements, from the middle plane
    std::vector<double> cell_width_;
    Half even_, odd_;
};

}  // namespace beltgrinding

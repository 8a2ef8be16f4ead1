#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "elastic/half_space.h"

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
    /// mm that the surface stands back and the outermost layer is thinner, at even steps from the
    /// middle plane to the side, the same on both; a tenth of the layer is left at least. Empty: a
    /// cylinder.
    std::vector<double> drop{};

    /// `drop` between its values, at the place y, mm.
    double drop_at(double y) const;
    double thickness() const;
    /// MPa/mm of the layers pressed one on the other, free to bulge: the softest that the rim can
    /// be. The layers must be valid.
    double softest() const;
    /// Throws InputError naming the layer and value that is none; Poisson's ratio up to 0.499.
    void validate() const;
};

/// How the rubber's outer surface moves along the wheel's axis beside the side faces, which bulge
/// under load: as exp(-d / l) of the distance d to both faces, l half the rim's thickness. The
/// rim's own decay is 0.2 of the thickness for short waves along the circumference, 0.8 for long
/// ones. Further inside what moves is as on a layer without sides; there its second-order effect
/// and the rubber's stiffening cancel each other, and neither is in the model.
class SideMode {
  public:
    /// `outwards`: both sides move outwards, as they do under what is symmetric about the wheel's
    /// middle plane; else both move towards +y. `width`, `thickness` in mm.
    SideMode(double width, double thickness, int cells, bool outwards);
    /// Displacement along y at the place y (mm), such that the squares over all cells sum up to 1;
    /// 0 everywhere if the cells cannot move so.
    double at(double y) const { return scale_ * form(y); }

  private:
    double form(double y) const;

    double half_width_, decay_, other_;
    double scale_ = 1.0;
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
    /// combinations, counted from the middle plane outwards. The last row and column are those of
    /// the axial load and displacement that go with `SideMode` (outwards in `even`). Symmetric,
    /// positive definite.
    void compliance(double k, Eigen::MatrixXd& even, Eigen::MatrixXd& odd) const;

  private:
    struct Half {
        Eigen::SparseMatrix<double> k0, k1, k2;  // lower triangles of one pattern
        Eigen::MatrixXd loads;  // scaled so that C = loads' K^-1 loads; the last is axial
    };
    void make_mesh(const WheelRimDesign& design, double finest);
    class Freedoms;
    Half assemble(const WheelRimDesign& design, bool symmetric) const;
    void add_stiffness(const WheelRimDesign& design, const Freedoms& freedoms, Half& half) const;
    void add_loads(const WheelRimDesign& design, const Freedoms& freedoms, bool symmetric,
                   Half& half) const;
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

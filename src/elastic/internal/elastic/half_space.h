#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "elastic/compliance.h"
#include "elastic/spectrum_cache.h"

namespace beltgrinding {

/// Young's modulus (MPa) and Poisson's ratio of a linear elastic, isotropic solid.
struct Elasticity {
    double youngs_modulus = 5.0;
    double poissons_ratio = 0.45;

    /// Throws InputError unless E > 0 and 0 <= nu <= `largest_ratio`.
    void validate(double largest_ratio) const;
    /// E / (1 - nu^2), MPa.
    double plane_strain_modulus() const;
};

/// Compliance that is one and the same influence function everywhere: u = K * p over the grid laid
/// flat, without periodic images (zero padding). Base of the half-space and the bonded layer.
class ConvolutionModel : public ElasticModel {
  public:
    /// Of the influence function, on a padded grid.
    struct Spectrum {
        std::vector<float> values;     ///< real, as the function is even
        std::vector<float> influence;  ///< mm/MPa, by distance: row by row, from 0 to half of each
    };

  private:
    std::unique_ptr<ComplianceOperator> make_operator(const ContactGrid& grid) const final;
    /// `influence`: mm/MPa at a distance of some cells along and across.
    static Spectrum build(int length, int rows, const std::function<float(int, int)>& influence);
    /// Displacement (mm/MPa) at the distance (x, y) from the middle of a cell of `grid` under unit
    /// pressure.
    virtual double influence(const ContactGrid& grid, double x, double y) const = 0;

    std::shared_ptr<SpectrumCache<Spectrum>> spectra_ = std::make_shared<SpectrumCache<Spectrum>>();
};

/// Elastic half-space (Boussinesq): u(q) = 2 p(q) / (E* q); uniform pressure on a rectangle by
/// Love's formula (Johnson: Contact Mechanics, eq. 3.25). Valid for contacts that are small against
/// the rim's thickness and width.
class HalfSpace final : public ConvolutionModel {
  public:
    /// Throws InputError for a modulus or ratio that is none.
    explicit HalfSpace(Elasticity elasticity);
    std::string describe() const override;

  private:
    double influence(const ContactGrid& grid, double x, double y) const override;

    Elasticity elasticity_;
};

/// Elastic layer of constant thickness bonded to a rigid base, without friction on top, of infinite
/// width: u(q) = 2 S(q h) p(q) / (E* q) with S after Johnson: Contact Mechanics, section 5.8. Valid
/// for contacts that stay a rim's thickness away from the wheel's side faces.
class BondedLayer final : public ConvolutionModel {
  public:
    /// `thickness` in mm. Throws InputError for values that are none.
    BondedLayer(Elasticity elasticity, double thickness);
    std::string describe() const override;
    double thickness() const override { return thickness_; }

    /// S(x) for x = q h >= 0; goes to 1 for large x.
    static double shape(double x, double poissons_ratio);

  private:
    double influence(const ContactGrid& grid, double x, double y) const override;
    /// mm/MPa per mm2 at distance r: what the layer gives beyond the half-space (negative).
    double correction(double r) const;

    Elasticity elasticity_;
    double thickness_;
    std::vector<double> table_;  // of `correction`, by distance
    double table_step_ = 1.0;
};

}  // namespace beltgrinding

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "elastic/compliance.h"
#include "elastic/rim_cache.h"
#include "elastic/rim_section.h"
#include "elastic/spectrum_cache.h"

namespace beltgrinding {

/// The abrasive belt on the rim: a thin plate under tension, which adds the surface stiffness
/// T k^2 + D k^4. Its bending across the wheel has free edges.
struct BeltPlate {
    double tension = 0.0;  ///< N per mm of width; 0: none
    double bending = 0.0;  ///< bending stiffness D, N mm; 0: none
};

/// Compliance of the real wheel: finite width, free side faces, rubber rim on a rigid core, belt.
///
/// The section's compliance is solved at some wavenumbers, splined between them, and summed over
/// the wheel's whole circumference into an influence function along it, with the means over
/// loaded and displaced cells; the operator convolves without periodic images (zero padding) by
/// Fourier transforms, with one dense product a wavenumber for each symmetry.
///
/// Beside the side faces the rubber also moves along the axis (`SideMode`), and meets what the
/// surface is there: on a slope of the gap that is nearer or further, and the pressure, normal to
/// the surface, has an axial share. Both together leave the operator symmetric.
class WheelRim final : public ElasticModel {
  public:
    /// `cache`: where the section's compliance is read from and kept; none: nowhere, it is computed
    /// for every object and size of cells. Throws InputError for a design that is none.
    explicit WheelRim(WheelRimDesign design, BeltPlate belt = {},
                      std::shared_ptr<RimCache> cache = nullptr);

    /// What the operator of a grid says also names the cache's entry.
    std::string describe() const override;
    double thickness() const override;
    double beside() const override;

    /// The section's compliance for some cells.
    struct Samples {
        std::vector<double> waves;  ///< sampled wavenumbers, 1/mm
        RimSamples compliance;      ///< mm/MPa, there
        std::string description;    ///< of the rim, and of the cache's entry
    };
    /// What belongs to one padded length: for each wavenumber both matrices, one after the other.
    struct Spectrum {
        std::vector<float> matrices;
        double diagonal = 1.0;  ///< mm/MPa, mean over the cells
    };

  private:
    std::unique_ptr<ComplianceOperator> make_operator(const ContactGrid& grid) const override;
    bool has_belt() const { return belt_.tension > 0.0 || belt_.bending > 0.0; }
    std::string describe_design(int digits) const;
    /// The samples for a grid's cells: from the cache, or computed and put there.
    Samples sample(const ContactGrid& grid) const;
    RimSamples compute(const ContactGrid& grid, const std::vector<double>& waves) const;
    bool holds(const ContactGrid& grid, const std::vector<double>& waves,
               const RimSamples& kept) const;
    static Spectrum build(const WheelRimDesign& design, const ContactGrid& grid,
                          const Samples& samples, int length);

    WheelRimDesign design_;
    BeltPlate belt_;
    std::shared_ptr<RimCache> cache_;
    mutable SpectrumCache<Samples> samples_;  // for any length
    std::shared_ptr<SpectrumCache<Spectrum>> spectra_ = std::make_shared<SpectrumCache<Spectrum>>();
};

}  // namespace beltgrinding

#pragma once

#include <complex>
#include <map>
#include <vector>

#include "contact/convolution.h"
#include "contact/rim_cache.h"
#include "contact/rim_section.h"

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
/// loaded and displaced cells; apply() convolves without periodic images (zero padding) by Fourier
/// transforms, with one dense product a wavenumber for each symmetry.
class WheelRim final : public ComplianceOperator {
  public:
    /// Throws InputError for a design that is none.
    explicit WheelRim(WheelRimDesign design, BeltPlate belt = {});

    void set_grid(const ContactGrid& grid) override;
    void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
               Eigen::ArrayXd& displacement) const override;
    double diagonal() const override { return current_ ? current_->diagonal : 1.0; }
    /// Also names the cache's entry, once a grid is set.
    std::string describe() const override;

  private:
    std::string describe_design(int digits) const;
    /// What belongs to one padded length: for each wavenumber both matrices, one after the other.
    struct Spectrum {
        std::vector<float> matrices;
        double diagonal = 1.0;  // mm/MPa, mean over the cells
    };
    /// The samples for a grid's cells: from the user's cache, or computed and put there.
    void sample(const ContactGrid& grid);
    void compute(const ContactGrid& grid);
    Spectrum build(int length) const;

    WheelRimDesign design_;
    BeltPlate belt_;
    ContactGrid grid_;
    std::vector<double> waves_;          // sampled wavenumbers, 1/mm
    RimSamples samples_;                 // compliance there
    std::string key_;                    // of the samples in the cache
    std::map<int, Spectrum> spectra_;    // by padded length
    const Spectrum* current_ = nullptr;  // one of them
    mutable RowTransform transform_;
    mutable std::vector<float> values_;
    mutable std::vector<std::complex<float>> spectrum_, image_;
};

}  // namespace beltgrinding

#pragma once

#include <string>

#include "beltgrinding/curve.h"

namespace beltgrinding {

/// What a belt has done so far.
struct BeltState {
    double work = 0.0;     ///< J, normal force times belt speed, over time
    double volume = 0.0;   ///< mm3, removed
    double time = 0.0;     ///< s, in contact
    double loading = 0.0;  ///< share of the loading that there may be, [0, 1]

    /// Throws InputError unless all are zero or positive, and the loading at most 1.
    void validate() const;
};

/// How a belt's cut falls with use: k_t, the share of a fresh belt's cut that remains, by the work
/// or the volume W. It is exponential in them, faster at first (see docs/methods.md for sources).
///
/// Chips that load the belt take a further share of the cut, k_t (1 - loading_share l). In contact
/// dl/dW = (1 - l) / loading_scale; while the belt runs free dl/dt = -l / loading_recovery.
class BeltWear {
  public:
    /// How the cut falls.
    enum class Model { kNone, kExponential, kTwoStage, kPower, kCurve };
    /// With what it falls.
    enum class Variable { kWork, kVolume };
    /// What makes up a belt's wear; which are used depends on the model.
    struct Parameters {
        Model model = Model::kNone;           ///< how the cut falls
        Variable variable = Variable::kWork;  ///< with what
        double scale = 1e6;  ///< J or mm3 in which the wearing share falls to 1/e; of a power, W
                             ///< from which it falls
        double rest = 0.0;   ///< share of the cut that stays
        double first_share = 0.0;       ///< two-stage: share that goes at first
        double first_scale = 1e5;       ///< J or mm3, of it
        double exponent = 0.2;          ///< power: m
        double loading_share = 0.0;     ///< of the cut, that a loaded belt lacks; 0: none loads
        double loading_scale = 1e4;     ///< J or mm3 in which 1 - l falls to 1/e
        double loading_recovery = 0.0;  ///< s of running free in which l falls to 1/e; 0: it stays
        Curve curve;                    ///< share over J or mm3
    };

    /// By its name: none, exponential, two_stage, power or curve. Throws InputError for another.
    static Model model_named(const std::string& name);
    /// By its name: work or volume. Throws InputError for another.
    static Variable variable_named(const std::string& name);

    BeltWear() = default;
    /// Throws InputError for invalid parameters.
    explicit BeltWear(Parameters parameters);

    /// k_t of a belt in the state. Exponential: rest + (1 - rest) exp(-W/scale); two-stage: rest +
    /// first_share exp(-W/first_scale) + (1 - rest - first_share) exp(-W/scale); power: (1 +
    /// W/scale)^-exponent, the form of Arps's decline curves (Trans. AIME 160, 1945). All times
    /// 1 - loading_share l.
    double remaining(const BeltState& state) const;
    /// Whether the belt loads.
    bool loads() const { return parameters_.loading_share > 0.0; }
    /// The loading after a contact of so much work (J) in which the belt removed `volume` (mm3).
    double loaded(double loading, double work, double volume) const;
    /// The loading whose cut is the mean over a contact at constant pressure: of `work` (J), in
    /// which an unloaded belt as worn would remove `volume` (mm3).
    double mean_loading(double loading, double work, double volume) const;
    /// The loading after the belt has run free for so many seconds.
    double recovered(double loading, double seconds) const;
    /// False where the belt has done more than a curve's measurements.
    bool measured(const BeltState& state) const;
    /// Model and parameters, for the report.
    std::string describe() const;

  private:
    double variable(const BeltState& state) const;
    double worn(const BeltState& state) const;
    Parameters parameters_;
};

}  // namespace beltgrinding

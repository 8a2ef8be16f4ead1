#pragma once

#include <array>

namespace beltgrinding {

/// How heat that enters a surface goes into the depth, as a sum of exponentials in time:
///
///     T(t) = q / (rho c) integral of K(alpha t'),  K(tau) = sum of w_j exp(-s_j tau) + D
///     delta(tau)
///
/// K of a half-space is 1 / sqrt(pi tau) = (2 / pi) integral of exp(-z^2 tau) dz, by the
/// trapezoidal rule in ln z; of a plate with an insulated back, (1 + 2 sum of exp(-n^2 pi^2 tau /
/// d^2)) / d, by a fit to the same rates, whatever the thickness, so that neighbours of other
/// thicknesses can exchange. D stands for what is faster than all rates. The temperature after a
/// time of constant flux is within 0.5 % for tau from 0.01 to 1000 mm2 (tests/core/heat). These are
/// the lengths of heat in steel; of what conducts better or worse by far, all lengths are `longer`.
class DepthModes {
  public:
    static constexpr int kModes = 16;
    using Row = std::array<float, kModes>;

    /// How much longer ways are than those of steel: 1 for 1 to 20 mm2/s, else by the root; but
    /// contacts are no larger for it, which are some `spacing` mm.
    static double longer(double diffusivity, double spacing);
    /// s_j, 1/mm2; the first is 0. Of ways that are not longer: those of others are less by the
    /// square.
    static const std::array<double, kModes>& rates();
    /// What a heat flux does.
    struct Weights {
        Row modes{};          ///< 1/mm
        float direct = 0.0f;  ///< D, mm
    };
    /// At the surface where it enters, of a plate of `thickness` mm; NaN or above `kThick`: of a
    /// half-space.
    static Weights own(double thickness, double longer = 1.0);
    /// At a plate's other surface.
    static Weights opposite(double thickness, double longer = 1.0);

    /// mm, of ways that are not longer: a half-space, in the times of grinding; and what is as hot
    /// on both sides at once, but for a difference in proportion to the flux.
    static constexpr double kThick = 150.0;
    static constexpr double kThin = 0.05;
};

}  // namespace beltgrinding

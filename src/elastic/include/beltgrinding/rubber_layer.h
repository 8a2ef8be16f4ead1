#pragma once

namespace beltgrinding {

/// One rubber of a wheel's rim, or of what lies on a platen.
struct RubberLayer {
    double thickness = 15.0;       ///< mm
    double youngs_modulus = 5.0;   ///< MPa
    double poissons_ratio = 0.45;  ///< up to 0.499
};

}  // namespace beltgrinding

#pragma once

namespace beltgrinding::testing {

/// r of Hammann's law, mm: K (mm2/N), V_b and V_w (mm/s), F_A (N), l_w (mm).
inline double hammann_depth(double coefficient, double wear, double belt_speed, double force,
                            double feed, double contact_width) {
    return coefficient * wear * belt_speed * force / (feed * contact_width);
}

}  // namespace beltgrinding::testing

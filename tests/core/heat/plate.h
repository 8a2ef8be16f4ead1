#pragma once

#include <cmath>
#include <cstdint>

#include "beltgrinding/heat.h"
#include "heat/conduction.h"

namespace beltgrinding {

/// Steel X5CrNi18-10 or the like, with round figures.
inline HeatMaterial steel() {
    return {16.0, 500.0, 8000.0};
}

/// Samples on z = 0, normal up, `along` by `across` of them, `spacing` mm apart from the origin on,
/// each with what is nearest to it of the rectangle between the outermost ones.
inline HeightField plate(int along, int across, double spacing) {
    HeightField field;
    field.spacing = spacing / 2.0;  // each sample may be a node
    field.resize(static_cast<std::size_t>(along) * static_cast<std::size_t>(across));
    std::size_t s = 0;
    for (int j = 0; j < across; ++j) {
        for (int i = 0; i < along; ++i, ++s) {
            field.point[s] = {i * spacing, j * spacing, 0.0};
            const double x = i == 0 || i == along - 1 ? 0.5 : 1.0;
            const double y = j == 0 || j == across - 1 ? 0.5 : 1.0;
            field.area[s] = static_cast<float>(x * y * spacing * spacing);
        }
    }
    return field;
}

/// K, of a node in a settled state.
inline double rise(const HeatState& state, std::size_t node) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 16; ++j) sum += state.modes[16 * node + j];
    return sum;
}

}  // namespace beltgrinding

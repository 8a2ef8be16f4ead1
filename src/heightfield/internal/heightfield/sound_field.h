#pragma once

#include <cstddef>
#include <optional>

#include "beltgrinding/fact.h"
#include "beltgrinding/height_field.h"

namespace beltgrinding {

/// The first fault of a field, with the array's name: an array of another length, a value that is
/// not finite or beyond what there is, a normal that is not of length 1, a trace that contradicts
/// itself. None: it is sound. On all threads, 10 ms for a million samples.
std::optional<Fact> fault_of(const HeightField& field);

/// Throws std::logic_error with the fault of a field that is about to be written: who computed it
/// is to blame, not the user.
void check_sound(const HeightField& field);

/// mm that were ground off sample i, 0 or more. The height before is known in single precision:
/// what is less than its rounding was not ground.
inline double removed_from(const HeightField& field, std::size_t i) {
    const double height = field.height[i];
    const float before = field.stock_height[i];
    return static_cast<float>(height) < before ? before - height : 0.0;
}

}  // namespace beltgrinding

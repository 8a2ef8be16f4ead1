#pragma once

#include <cstdint>

namespace beltgrinding {

/// Springs that push where they are pressed in, and are off elsewhere: `count` of them, pressed in
/// by `from` + `raised` - `to`, mm. Forces are N by stiffnesses of N/mm; `on` becomes 1 where there
/// is one, else 0. True if all of `on` were so before.
bool press_springs(int count, const double* from, double raised, const double* to,
                   const double* stiffness, double* forces, std::uint8_t* on);

/// The sum of some numbers: eight apart, then these, so that all processors give the same bits.
double sum_apart(int count, const double* values);

}  // namespace beltgrinding

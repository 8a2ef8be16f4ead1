#pragma once

#include <Eigen/Core>

namespace beltgrinding {

/// Gives `array` n values, not set where it had another number of them. Eigen's own `resize` and
/// assignment free the old values first and keep their address where memory does not suffice for
/// the new ones, which are then freed once more.
template <class Array>
void fit(Array& array, Eigen::Index n) {
    if (array.size() != n) array = Array(n);
}

}  // namespace beltgrinding

#pragma once

#include <array>
#include <cstddef>

#include "belt_path.h"

namespace beltgrinding {

/// A form of the second derivative k along the belt and of the value c itself: 1/2 k' A k + k' B c,
/// of splines' bands or of whole blocks.
template <class Block>
struct CurvedForm {
    Block a, b, b_transposed;
};

/// Adds the form in one column to the blocks of a matrix, which has block(row, below).
template <class Block, class Matrix>
void add_curved(const BeltColumns& columns, int i, const CurvedForm<Block>& form, Matrix& matrix) {
    const std::array<double, 3> k = columns.curvature(i);
    if (k[1] == 0.0) return;
    const double h = columns.apart(i);
    for (int q = 0; q < 3; ++q) {
        for (int p = q; p < 3; ++p) {
            auto to = matrix.block(i - 1 + q, p - q);
            const double kp = k[static_cast<std::size_t>(p)];
            const double kq = k[static_cast<std::size_t>(q)];
            to += h * kp * kq * form.a;
            if (q == 1) to += h * kp * form.b;
            if (p == 1) to += h * kq * form.b_transposed;
        }
    }
}

}  // namespace beltgrinding

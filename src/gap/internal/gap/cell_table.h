#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "gap/footprint.h"
#include "gap/placed_block.h"

namespace beltgrinding {

/// Values of a grid's cells, as `interpolate` reads them.
class CellTable {
  public:
    /// The table of `values` (one per cell), times `factor`; until the next call.
    const Bilinear* fill(const ContactGrid& grid, const Eigen::ArrayXd& values, double factor) {
        const int above = row_step(grid);
        table_.resize(static_cast<std::size_t>(grid.cells()));
        for (int cell = 0; cell + above + 1 < grid.cells(); ++cell) {
            const double a = factor * values[cell], b = factor * values[cell + 1];
            const double c = factor * values[cell + above], d = factor * values[cell + above + 1];
            table_[static_cast<std::size_t>(cell)] = {
                static_cast<float>(a), static_cast<float>(b - a), static_cast<float>(c - a),
                static_cast<float>((a - b) + (d - c))};
        }
        return table_.data();
    }

  private:
    std::vector<Bilinear> table_;
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// The greatest mean pressure, MPa, over a square of 1 mm (of a cell, where that is longer).
/// Squares are tried round the middles of all cells, and up to the workpiece's
/// edges: a point's pressure there has no limit as cells become finer, this has. `pressure` in MPa,
/// `coverage` as in `Coverage::share`, one value per cell.
double peak_pressure(const ContactGrid& grid, const Eigen::ArrayXd& pressure,
                     const Eigen::ArrayXd& coverage);

}  // namespace beltgrinding

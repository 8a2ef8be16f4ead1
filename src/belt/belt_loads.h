#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "belt_solver.h"

namespace beltgrinding {

/// MPa by cell of the grid, a force along z on the projected area: the loads of a belt's columns,
/// those that no cell has as its own shared by the cells that the face lies over. `thickness`: of
/// the belt, mm.
Eigen::ArrayXd pressure_on_grid(const BeltSolver& solver, const ContactGrid& grid,
                                const Eigen::ArrayXd& coverage, double thickness,
                                const BeltState& state);

/// Row by row of each of the path's columns: where `start`, MPa by cell of the grid, has pressure
/// over the column's middle. Empty: nowhere.
std::vector<std::uint8_t> pressed_columns(const BeltSolver& solver, const ContactGrid& grid,
                                          const BeltPath& path, const Eigen::ArrayXd& start);

}  // namespace beltgrinding

#include "belt_loads.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {

Eigen::ArrayXd pressure_on_grid(const BeltSolver& solver, const ContactGrid& grid,
                                const Eigen::ArrayXd& coverage, double thickness,
                                const BeltState& state) {
    const BeltPath& path = state.path;
    const int n = path.columns.count(), nx = grid.nx;
    Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(grid.cells());
    const double area = grid.cell_area();
    // x of the belt's face, in columns of the grid, where columns that bear are not the grid's own.
    Eigen::ArrayXXd places;
    bool needed = false;
    for (int i = 0; i < n && !needed; ++i)
        needed = path.cell[static_cast<std::size_t>(i)] < 0 && (state.load.col(i) > 0.0).any();
    if (needed) {
        places = solver.face_deflection(path.columns, state.deflection);
        for (int i = 0; i < n; ++i) {
            const auto c = static_cast<std::size_t>(i);
            const double sine = std::sin(path.angle[c]);
            places.col(i) =
                (path.x[c] + (0.5 * thickness - places.col(i)) * sine) / grid.ds + 0.5 * nx;
        }
    }
    for (int i = 0; i < n; ++i) {
        const double cosine = std::cos(path.angle[static_cast<std::size_t>(i)]);
        for (std::size_t k = 0; k < solver.rows().size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            if (!(state.load(row, i) > 0.0)) continue;
            // The force along z, shared by the columns of the grid that it lies on.
            const double force = state.load(row, i) * cosine;
            if (const int own = path.cell[static_cast<std::size_t>(i)]; own >= 0) {
                const int cell = solver.rows()[k].row * nx + own;
                if (coverage[cell] > 0.0) pressure[cell] += force / (area * coverage[cell]);
                continue;
            }
            const double here = places(row, i);
            double from = i > 0 ? 0.5 * (places(row, i - 1) + here) : here;
            double to = i + 1 < n ? 0.5 * (places(row, i + 1) + here) : here;
            from = std::clamp(from, 0.0, nx - 1e-9);
            to = std::clamp(to, from + 1e-9, static_cast<double>(nx));
            for (int c = static_cast<int>(from); c < nx && c < to; ++c) {
                const double share = std::min(to, c + 1.0) - std::max(from, static_cast<double>(c));
                const int cell = solver.rows()[k].row * nx + c;
                if (coverage[cell] > 0.0)
                    pressure[cell] += force * share / (to - from) / (area * coverage[cell]);
            }
        }
    }
    return pressure;
}

std::vector<std::uint8_t> pressed_columns(const BeltSolver& solver, const ContactGrid& grid,
                                          const BeltPath& path, const Eigen::ArrayXd& start) {
    const std::size_t rows = solver.rows().size();
    std::vector<std::uint8_t> result(rows * path.x.size(), 0);
    bool any = false;
    for (std::size_t i = 0; i < path.x.size(); ++i) {
        const auto column = std::lround(path.x[i] / grid.ds + 0.5 * (grid.nx - 1));
        if (column < 0 || column >= grid.nx) continue;
        for (std::size_t k = 0; k < rows; ++k) {
            const bool here = start[solver.rows()[k].row * grid.nx + column] > 0.0;
            result[i * rows + k] = here ? 1 : 0;
            any = any || here;
        }
    }
    if (!any) result.clear();
    return result;
}

}  // namespace beltgrinding

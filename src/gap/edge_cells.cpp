#include "gap/edge_cells.h"

#include <cmath>

namespace beltgrinding {
namespace {

constexpr int kEdgeMatters = 2;  // cells from what may bear pressure

}  // namespace

void EdgeCells::find_near_pressable(const ContactGrid& grid) {
    const int nx = grid.nx, ny = grid.ny;
    // Along, then across.
    wider_.assign(pressable_.size(), 0);
    for (int j = 0; j < ny; ++j) {
        const std::uint8_t* from = &pressable_[static_cast<std::size_t>(j * nx)];
        std::uint8_t* to = &wider_[static_cast<std::size_t>(j * nx)];
        for (int by = -kEdgeMatters; by <= kEdgeMatters; ++by)
            for (int i = std::max(0, -by); i < std::min(nx, nx - by); ++i) to[i] |= from[i + by];
    }
    std::fill(matters_.begin(), matters_.end(), std::uint8_t{0});
    for (int j = 0; j < ny; ++j) {
        std::uint8_t* to = &matters_[static_cast<std::size_t>(j * nx)];
        for (int b = std::max(0, j - kEdgeMatters); b <= std::min(ny - 1, j + kEdgeMatters); ++b) {
            const std::uint8_t* from = &wider_[static_cast<std::size_t>(b * nx)];
            for (int i = 0; i < nx; ++i) to[i] |= from[i];
        }
    }
}

template <class Is>
void EdgeCells::spread(const ContactGrid& grid, Is is, std::uint8_t kind, int steps) {
    const int nx = grid.nx, ny = grid.ny;
    wider_ = kind_;
    for (int cell = 0; cell < nx * ny; ++cell) {
        if (!is(cell)) continue;
        const int i = cell % nx, j = cell / nx;
        for (int b = std::max(0, j - steps); b <= std::min(ny - 1, j + steps); ++b)
            for (int a = std::max(0, i - steps); a <= std::min(nx - 1, i + steps); ++a)
                wider_[static_cast<std::size_t>(b * nx + a)] =
                    std::max(wider_[static_cast<std::size_t>(b * nx + a)], kind);
    }
    kind_ = wider_;
}

void EdgeCells::mark(const ContactGrid& grid, const std::vector<double>& nearest,
                     const std::vector<double>& farthest, double layer, double pressable) {
    const int nx = grid.nx, cells = grid.cells();
    clear(nearest.size());
    find_pressable(grid, nearest.data(), pressable);
    constexpr double kNothing = std::numeric_limits<double>::infinity();
    bool any = false;
    spread(
        grid,
        [&](int cell) {
            const auto k = static_cast<std::size_t>(cell);
            // A step between this cell's layer and the next one's.
            const auto steps = [&](std::size_t next) {
                return nearest[next] != kNothing && std::abs(nearest[next] - nearest[k]) > layer;
            };
            const bool edge = nearest[k] == kNothing || farthest[k] - nearest[k] > layer ||
                              (cell % nx + 1 < nx && steps(k + 1)) ||
                              (cell + nx < cells && steps(k + static_cast<std::size_t>(nx)));
            if (!edge || matters_[k] == 0) return false;
            any = true;
            return true;
        },
        kEdge, 1);
    if (!any) return;
    spread(
        grid, [&](int cell) { return edge(static_cast<std::size_t>(cell)); }, kNearEdge, 2);
}

bool EdgeCells::holds_for(const Eigen::ArrayXd& pressure) const {
    for (std::size_t k = 0; k < pressable_.size(); ++k)
        if (pressable_[k] == 0 && pressure[static_cast<Eigen::Index>(k)] > 0.0) return false;
    return true;
}

}  // namespace beltgrinding

#include "contact/wheel_grid.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {

Eigen::ArrayXd recentre(const Eigen::ArrayXd& values, const ContactGrid& from,
                        const ContactGrid& to) {
    if (from == to) return values;
    Eigen::ArrayXd result = Eigen::ArrayXd::Zero(to.cells());
    if (values.size() != from.cells() || from.ny != to.ny) return result;
    const int shift = (to.nx - from.nx) / 2;
    for (int j = 0; j < to.ny; ++j) {
        for (int i = std::max(0, shift); i < std::min(to.nx, from.nx + shift); ++i) {
            result[j * to.nx + i] = values[j * from.nx + i - shift];
        }
    }
    return result;
}

Eigen::ArrayXd tilt_by_approach(const ContactWheel& wheel, const ContactGrid& grid,
                                const Eigen::ArrayXd& gap) {
    Eigen::ArrayXd tilt = Eigen::ArrayXd::Zero(grid.cells());
    for (int i = 0; i < grid.nx; ++i) {
        const double angle = grid.s(i) / wheel.radius;
        const double sine = std::sin(angle), less = 1.0 - std::cos(angle);
        for (int j = 0; j < grid.ny; ++j) {
            const int cell = j * grid.nx + i;
            if (!std::isfinite(gap[cell])) continue;
            const bool left = i > 0 && std::isfinite(gap[cell - 1]);
            const bool right = i + 1 < grid.nx && std::isfinite(gap[cell + 1]);
            const double rise =
                (right ? gap[cell + 1] : gap[cell]) - (left ? gap[cell - 1] : gap[cell]);
            const int steps = (left ? 1 : 0) + (right ? 1 : 0);
            tilt[cell] = less - (steps > 0 ? sine * rise / (steps * grid.ds) : 0.0);
        }
    }
    return tilt;
}

Eigen::ArrayXd profile_drop(const ContactWheel& wheel, const ContactGrid& grid) {
    Eigen::ArrayXd drop(grid.ny);
    for (int j = 0; j < grid.ny; ++j) drop[j] = wheel.drop(grid.y(j));
    if ((drop == drop[0]).all()) drop.resize(0);
    return drop;
}

}  // namespace beltgrinding

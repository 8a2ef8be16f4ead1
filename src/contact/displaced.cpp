#include "contact/displaced.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beltgrinding {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

}  // namespace

DisplacedPressure displaced(const ContactGrid& grid, const ContactSolution& solution,
                            const Eigen::ArrayXd& coverage, double most) {
    DisplacedPressure result;
    result.pressure = solution.pressure;
    const int nx = grid.nx, ny = grid.ny;
    if (solution.axial.rows() != nx || solution.axial.cols() != ny + 1) return result;
    result.beside.setZero(2 * nx);
    result.reach.setZero(2 * nx);
    Eigen::ArrayXd border(ny + 1), force(ny);  // mm from the side at -y; N per mm along the rim
    for (int i = 0; i < nx; ++i) {
        const auto covered = [&](int j) { return j < 0 || j >= ny || coverage[j * nx + i] == 1.0; };
        bool pressed = false;
        for (int j = 0; j < ny; ++j) pressed = pressed || solution.pressure[j * nx + i] > 0.0;
        if (!pressed) continue;
        const double width = ny * grid.dy;
        // No border passes one that stays: behind an edge there is no work to press on.
        const auto stays = [&](int j) { return !covered(j - 1) || !covered(j); };
        double low = -kAnywhere, high = kAnywhere;
        for (int j = 0; j <= ny; ++j) {
            border[j] = j * grid.dy;
            if (stays(j))
                low = border[j];
            else
                border[j] = std::max(border[j] + solution.axial(i, j), low);
        }
        for (int j = ny; j >= 0; --j) {
            if (stays(j))
                high = border[j];
            else
                border[j] = std::min(border[j], high);
        }
        double below = 0.0, above = 0.0;
        force.setZero();
        for (int j = 0; j < ny; ++j) {
            const int cell = j * nx + i;
            const double load = solution.pressure[cell] * coverage[cell] * grid.dy;
            if (load <= 0.0) continue;
            const double from = border[j], to = border[j + 1];
            if (!(to > from) || (from == j * grid.dy && to == (j + 1) * grid.dy)) {
                force[j] += load;
                continue;
            }
            const double dense = load / (to - from);
            below += dense * std::max(std::min(to, 0.0) - from, 0.0);
            above += dense * std::max(to - std::max(from, width), 0.0);
            const int first = std::clamp(static_cast<int>(from / grid.dy), 0, ny - 1);
            const int last = std::clamp(static_cast<int>(to / grid.dy), 0, ny - 1);
            for (int k = first; k <= last; ++k) {
                const double within = std::min(to, (k + 1) * grid.dy) - std::max(from, k * grid.dy);
                force[k] += dense * std::max(within, 0.0);
            }
        }
        for (int j = 0; j < ny; ++j) {
            const int cell = j * nx + i;
            result.pressure[cell] = force[j] > 0.0 ? force[j] / (coverage[cell] * grid.dy) : 0.0;
        }
        const auto put = [&](int at, double load, double reach) {
            if (!(load > 0.0)) return;
            result.reach[at] = std::min(reach, most);
            result.beside[at] = load / result.reach[at];
        };
        put(i, below, -border[0]);
        put(nx + i, above, border[ny] - width);
    }
    return result;
}

}  // namespace beltgrinding

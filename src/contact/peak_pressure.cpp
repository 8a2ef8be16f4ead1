#include "contact/peak_pressure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/coverage.h"

namespace beltgrinding {
namespace {

constexpr double kSide = 1.0;  // mm

/// Along one axis: the cells from a middle one on, and what of their load lies within the square.
class Line {
  public:
    /// `open`: the side on which the workpiece ends, or 0; `length`: of the middle cell's covered
    /// part, `cell`: its side, both mm.
    Line(double side, double cell, int open, double length)
        : reach_(static_cast<int>(std::ceil(side / cell))),
          shares_(static_cast<std::size_t>(2 * reach_ + 1)) {
        if (open == 0) length = cell;
        const double low = open != 0 ? length - side - 0.5 * cell : -0.5 * side;
        for (int k = -reach_; k <= reach_; ++k) {
            const double at = (open != 0 ? open * k : k) * cell - 0.5 * cell;
            const double size = k == 0 ? length : cell;
            const double within =
                std::max(std::min(at + size, low + side) - std::max(at, low), 0.0);
            // At an edge the pressure goes with one over the root of the distance.
            shares_[static_cast<std::size_t>(k + reach_)] =
                k == 0 && open != 0 ? std::sqrt(within / size) : within / size;
        }
    }
    double share(int k) const { return shares_[static_cast<std::size_t>(k + reach_)]; }
    /// The cells from the middle one at `at`, of `count`, that have a share.
    int first(int at) const {
        int k = -reach_;
        while (k < 0 && share(k) <= 0.0) ++k;
        return std::max(0, at + k);
    }
    int last(int at, int count) const {
        int k = reach_;
        while (k > 0 && share(k) <= 0.0) --k;
        return std::min(count - 1, at + k);
    }

  private:
    int reach_;
    std::vector<double> shares_;
};

}  // namespace

double peak_pressure(const ContactGrid& grid, const Eigen::ArrayXd& pressure,
                     const Eigen::ArrayXd& coverage) {
    const double side_s = std::max(kSide, grid.ds), side_y = std::max(kSide, grid.dy);
    const Line whole_s(side_s, grid.ds, 0, grid.ds), whole_y(side_y, grid.dy, 0, grid.dy);
    const Eigen::ArrayXd load = pressure * coverage;
    double peak = 0.0;
    const auto look = [&](int i, int j, const Line& along, const Line& across) {
        double force = 0.0;
        const int left = along.first(i), right = along.last(i, grid.nx);
        for (int b = across.first(j), top = across.last(j, grid.ny); b <= top; ++b) {
            double row = 0.0;
            for (int a = left; a <= right; ++a) row += along.share(a - i) * load[b * grid.nx + a];
            force += across.share(b - j) * row;
        }
        peak = std::max(peak, force * grid.cell_area() / (side_s * side_y));
    };
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const int cell = j * grid.nx + i;
            if (!(pressure[cell] > 0.0)) continue;
            const OpenSides open = open_sides(grid, coverage, i, j);
            if (open.along == 0 && open.across == 0) {
                look(i, j, whole_s, whole_y);
                continue;
            }
            const bool corner = open.along != 0 && open.across != 0;
            const double share = corner ? std::sqrt(coverage[cell]) : coverage[cell];
            look(i, j, Line(side_s, grid.ds, open.along, share * grid.ds),
                 Line(side_y, grid.dy, open.across, share * grid.dy));
        }
    }
    return peak;
}

}  // namespace beltgrinding

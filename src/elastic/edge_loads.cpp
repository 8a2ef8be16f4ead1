#include "elastic/edge_loads.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/fit.h"

namespace beltgrinding {
namespace {

// Of a cell: where the load of a strip lies, whose pressure rises with one over the root of the
// distance to its edge.
constexpr double kSingular = 2.0 / 3.0;
// Mean of -ln |x - t| over a strip of width 1 under that load, less that under an even one.
const double kSteeper = 1.5 - 2.0 * std::numbers::ln2;

}  // namespace

void EdgeLoads::find(const ContactGrid& grid, const Eigen::ArrayXd& share) {
    if (grid_ == grid && share_.size() == share.size() && (share_ == share).all()) return;
    grid_ = grid;
    parts_.clear();
    fit(share_, share.size());
    share_ = share;
    if ((share == 1.0).all()) return;
    const int nx = grid_.nx, ny = grid_.ny;
    for (int j = 0; j < ny; ++j) {
        const double* row = share.data() + static_cast<std::ptrdiff_t>(j) * nx;
        const double* before = j > 0 ? row - nx : row;
        const double* after = j + 1 < ny ? row + nx : row;
        for (int i = 0; i < nx; ++i) {
            const double w = row[i];
            if (!(w > 0.0)) continue;
            const bool inside = row[std::max(i - 1, 0)] > 0.0 &&
                                row[std::min(i + 1, nx - 1)] > 0.0 && before[i] > 0.0 &&
                                after[i] > 0.0;
            if (inside && w == 1.0) continue;
            const OpenSides open = open_sides(grid_, share, i, j);
            if (w == 1.0 && open.along == 0 && open.across == 0) continue;
            parts_.push_back(part_at(i, j, w, open));
        }
    }
}

EdgeLoads::Part EdgeLoads::part_at(int i, int j, double w, const OpenSides& open) const {
    const int nx = grid_.nx, ny = grid_.ny, cell = j * nx + i;
    const auto [side_s, side_y] = open;
    // To the outer neighbour, or to the inner one.
    const double off = kSingular * w - 0.5;
    const double lean = std::min(std::abs(off), 1.0);
    const int outwards = off > 0.0 ? 1 : -1;
    const int di = outwards * side_s, dj = outwards * side_y;
    const double u = di != 0 && i + di >= 0 && i + di < nx ? lean : 0.0;
    const double v = dj != 0 && j + dj >= 0 && j + dj < ny ? lean : 0.0;
    const int to_s = u > 0.0 ? di : 0, to_y = v > 0.0 ? dj * nx : 0;
    const double kappa = (side_s != 0) == (side_y != 0) ? 0.5 * (softness_.along + softness_.across)
                         : side_y != 0                  ? softness_.along
                                                        : softness_.across;
    const double steeper = side_s != 0 || side_y != 0 ? kSteeper : 0.0;
    // What the load yields less by lying on two cells.
    const double apart = 2.0 * kLineOverBeside *
                         (u * (1.0 - u) * softness_.across + v * (1.0 - v) * softness_.along);
    return {cell,
            {cell, cell + to_s, cell + to_y, cell + to_s + to_y},
            {(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v},
            kappa * (steeper - std::log(w)) + apart};
}

void EdgeLoads::place(Eigen::ArrayXd& load) {
    loads_.resize(parts_.size());
    for (std::size_t k = 0; k < parts_.size(); ++k) loads_[k] = load[parts_[k].cell];
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        if (loads_[k] == 0.0) continue;
        const Part& part = parts_[k];
        load[part.cell] -= loads_[k];
        for (std::size_t n = 0; n < 4; ++n) load[part.cells[n]] += part.shares[n] * loads_[k];
    }
}

void EdgeLoads::sink(Eigen::ArrayXd& displacement) const {
    sinking_.resize(parts_.size());
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        const Part& part = parts_[k];
        double sum = part.softness * loads_[k];
        for (std::size_t n = 0; n < 4; ++n) sum += part.shares[n] * displacement[part.cells[n]];
        sinking_[k] = sum;
    }
    for (std::size_t k = 0; k < parts_.size(); ++k) displacement[parts_[k].cell] = sinking_[k];
}

}  // namespace beltgrinding

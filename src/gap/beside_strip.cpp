#include "gap/beside_strip.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {

void BesideStrip::clear() {
    patches_.clear();
    reach_.resize(0);
}

void BesideStrip::note(const Patch& patch, std::size_t footprint) {
    const double low = std::abs(patch.y) - patch.half_y - half_width_;
    const double high = low + 2.0 * patch.half_y;
    if (!(high > 0.0) || low >= most_) return;
    patches_.push_back(
        {footprint, patch.y > 0.0 ? 1 : 0, std::max(low, 0.0), high, 2.0 * patch.half_y, 0.0});
}

void BesideStrip::reach(const DisplacedPressure& pressure, const ContactGrid& grid,
                        std::span<const Footprint> footprints, const Eigen::ArrayXd& coverage,
                        const Eigen::ArrayXd& gap, double layer) {
    reach_ = pressure.reach;
    if (reach_.size() != 2 * grid.nx || !(reach_.maxCoeff() > 0.0)) reach_.resize(0);
    for (Beside& one : patches_) {
        one.share = 0.0;
        if (reach_.size() == 0) continue;
        const double within = std::min(at(grid, footprints, one, reach_), one.to) - one.from;
        const Footprint& f = footprints[one.footprint];
        // Where the surface steps away beside the wheel nothing is pressed.
        const int row = one.side == 1 ? grid.ny - 1 : 0;
        const int column = f.cell % grid.nx, cell = row * grid.nx + column;
        const int rows = row - f.cell / grid.nx;
        const double carried = f.gap + static_cast<double>(f.slope_y) * rows;
        const bool same = coverage[cell] > 0.0 && std::abs(carried - gap[cell]) <= layer;
        if (same) one.share = std::max(within, 0.0) / one.whole;
    }
}

double BesideStrip::volume_rate(const ContactGrid& grid, const Eigen::ArrayXd& rates) const {
    return has(rates) ? (rates * reach_).sum() * grid.ds : 0.0;
}

}  // namespace beltgrinding

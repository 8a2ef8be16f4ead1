// Samples beyond the wheel's side faces, on which the rubber presses that has bulged out.

#include <algorithm>
#include <cmath>

#include "contact/gap_map.h"

namespace beltgrinding {

void GapMap::note_beside(const Patch& patch) {
    const double half = 0.5 * wheel_.width;
    const double low = std::abs(patch.y) - patch.half_y - half;
    const double high = low + 2.0 * patch.half_y;
    if (!(high > 0.0) || low >= beside_) return;
    beside_patches_.push_back({footprints_.size(), patch.y > 0.0 ? 1 : 0, std::max(low, 0.0), high,
                               2.0 * patch.half_y, 0.0});
}

void GapMap::reach_beside(const DisplacedPressure& pressure) {
    reach_ = pressure.reach;
    if (reach_.size() != 2 * grid_.nx || !(reach_.maxCoeff() > 0.0)) reach_.resize(0);
    for (BesidePatch& patch : beside_patches_) {
        patch.share = 0.0;
        if (reach_.size() == 0) continue;
        const double within = std::min(beside_at(patch, reach_), patch.to) - patch.from;
        const Footprint& f = footprints_[patch.footprint];
        // Where the surface steps away beside the wheel nothing is pressed.
        const int row = patch.side == 1 ? grid_.ny - 1 : 0;
        const int column = f.cell % grid_.nx, cell = row * grid_.nx + column;
        const int rows = row - f.cell / grid_.nx;
        const double carried = f.gap + static_cast<double>(f.slope_y) * rows;
        const bool same = coverage_.share[cell] > 0.0 && std::abs(carried - gap_[cell]) <= layer_;
        if (same) patch.share = std::max(within, 0.0) / patch.whole;
    }
}

double GapMap::beside_at(const BesidePatch& patch, const Eigen::ArrayXd& values) const {
    const Footprint& f = footprints_[patch.footprint];
    const int first = patch.side * grid_.nx + f.cell % grid_.nx;
    return (1.0f - f.u) * values[first] + f.u * values[first + 1];
}

double GapMap::volume_rate(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside) const {
    if (run_) return (rate * coverage_.share * stretch_).sum() * grid_.cell_area();
    const double within = (rate * coverage_.share).sum() * grid_.cell_area();
    if (reach_.size() == 0 || beside.size() != reach_.size()) return within;
    return within + (beside * reach_).sum() * grid_.ds;
}

}  // namespace beltgrinding

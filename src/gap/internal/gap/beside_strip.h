#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "contact/displaced.h"
#include "gap/footprint.h"

namespace beltgrinding {

/// Samples whose patches reach beyond the wheel's side faces, on which rubber presses that bulges
/// out.
class BesideStrip {
  public:
    /// `half_width`: of the wheel, mm; `most`: mm beyond its side faces up to which it may bulge.
    BesideStrip(double half_width, double most) : half_width_(half_width), most_(most) {}

    double most() const { return most_; }
    void clear();
    /// Keeps the patch of footprint number `footprint` if it reaches beyond the side faces.
    void note(const Patch& patch, std::size_t footprint);
    /// How far rubber bulges from now on. It presses what is of the layer of the outermost cells.
    void reach(const DisplacedPressure& pressure, const ContactGrid& grid,
               std::span<const Footprint> footprints, const Eigen::ArrayXd& coverage,
               const Eigen::ArrayXd& gap, double layer);
    /// mm3/s of `rates`, mm/s as `DisplacedPressure::beside`.
    double volume_rate(const ContactGrid& grid, const Eigen::ArrayXd& rates) const;
    /// `values`, two per column, are those of what bulges now.
    bool has(const Eigen::ArrayXd& values) const {
        return reach_.size() > 0 && values.size() == reach_.size();
    }
    /// Calls visit(footprint, share of its patch that is reached, value there) for those reached.
    template <class Visit>
    void for_reached(const ContactGrid& grid, std::span<const Footprint> footprints,
                     const Eigen::ArrayXd& values, Visit visit) const {
        for (const Beside& one : patches_)
            if (one.share > 0.0) visit(one.footprint, one.share, at(grid, footprints, one, values));
    }

  private:
    /// From a side face outwards, mm.
    struct Beside {
        std::size_t footprint;
        int side;         // 0: at -y, 1: at +y
        double from, to;  // of the patch
        double whole;     // its side along y
        double share;     // of the patch that is reached
    };
    static double at(const ContactGrid& grid, std::span<const Footprint> footprints,
                     const Beside& one, const Eigen::ArrayXd& values) {
        const Footprint& f = footprints[one.footprint];
        const int first = one.side * grid.nx + f.cell % grid.nx;
        return (1.0f - f.u) * values[first] + f.u * values[first + 1];
    }

    double half_width_, most_;
    std::vector<Beside> patches_;
    Eigen::ArrayXd reach_;  // mm, of what bulges; empty: nothing does
};

}  // namespace beltgrinding

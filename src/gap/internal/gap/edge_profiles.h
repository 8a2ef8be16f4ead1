#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "contact/coverage.h"
#include "gap/edge_patches.h"
#include "gap/footprint.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// How the pressure goes within the two outermost cells at an edge of the workpiece. A cell has one
/// pressure; towards a sharp edge it rises with one over the root of the distance, until the edge
/// is worn round. So the cells' loads are shared out over strips, four to a cell, which press on
/// one another as lines do (Johnson, Contact Mechanics, 1985, section 2.3) and follow the samples'
/// own gaps. The load of each cell stays.
class EdgeProfiles {
  public:
    static constexpr int kStrips = 4;  // of a cell

    /// Scales the shares of the samples near edges, so that `value_at` gives what their patches
    /// bear. `share`: of each cell that is covered; `pressure`, MPa by cell. Where the surface
    /// falls off and does not end, nothing changes. Where it was called before on the same
    /// footprints, from their shares before that.
    void sharpen(const ContactGrid& grid, const Eigen::ArrayXd& share,
                 const Eigen::ArrayXd& pressure, const EdgeSoftness& softness,
                 const SampleBlocks& blocks, const EdgePatches& patches,
                 std::span<Footprint> footprints);
    /// The footprints are others from now on.
    void clear() { before_.clear(); }

  private:
    /// An edge across one row of cells; distances from it inwards, in cells.
    struct Profile {
        int cell;        // the outermost
        bool across;     // the edge lies across y, else across s
        int side;        // 1: outwards is towards higher places
        double covered;  // of the outermost cell
        double edge;     // its place, in cells from the middle of the first one
        bool ends;       // a border of the surface lies there
        bool solved;     // else its cells keep an even pressure
        std::array<double, 2 * kStrips> gap, weight, pressure;

        double width(int strip) const { return (strip < kStrips ? covered : 1.0) / kStrips; }
        double middle(int strip) const {
            const int within = strip % kStrips;
            return strip < kStrips ? (within + 0.5) * width(strip)
                                   : covered + (within + 0.5) * width(strip);
        }
        /// MPa, the mean from one place to another; `further`: behind the second cell.
        double mean(double from, double to, double further) const;
    };
    using Numbers = std::vector<int>;  // of the profile by cell; -1: none

    void find(const ContactGrid& grid, const Eigen::ArrayXd& share, const Eigen::ArrayXd& pressure);
    void gather(const ContactGrid& grid, const SampleBlocks& blocks, const EdgePatches& patches,
                std::span<const Footprint> footprints);
    /// False where samples are too few, or there is no border.
    static bool solve(const ContactGrid& grid, const Eigen::ArrayXd& share,
                      const Eigen::ArrayXd& pressure, double softness, Profile& profile);
    /// What the sample's pressure is by the profiles across one axis, over what it is without.
    double factor(const ContactGrid& grid, const Eigen::ArrayXd& pressure, const Footprint& f,
                  const Patch& patch, bool across) const;
    void restore(std::span<Footprint> footprints);

    struct Before {
        std::size_t footprint;
        std::array<float, 4> shares;
    };
    std::vector<Profile> profiles_;
    std::array<Numbers, 2> numbers_;  // of edges across s, across y
    std::vector<Before> before_;
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>
#include <array>

#include "belt_bands.h"
#include "belt_path.h"
#include "belt_spline.h"

namespace beltgrinding {

/// The belt as a thin plate with large deflections (Foeppl and von Karman; Timoshenko,
/// Woinowsky-Krieger: Theory of Plates and Shells, section 100): what it deflects from a path,
/// along the path's normal, as splines across on columns along it. Its side edges are free, its
/// ends hinged.
class BeltSheet {
  public:
    BeltSheet(const AbrasiveBelt& belt, const BeltSpline& spline);

    /// What bending resists with, N/mm.
    BeltBands bending(const BeltColumns& columns) const;
    /// What the path's own turns load the belt with, as it is bent: N, (splines, columns).
    Eigen::MatrixXd path_load(const BeltPath& path) const;

  private:
    double bending_, ratio_;
    const BeltSpline& spline_;
    // Of two splines: their values; the first one's value and the second one's curvature, and the
    // other way round; their curvatures; their slopes.
    std::array<BeltBands::Band, BeltBands::kShares> bands_;
};

}  // namespace beltgrinding

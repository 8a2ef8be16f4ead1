#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "belt_face.h"
#include "belt_sheet.h"
#include "belt_spline.h"
#include "belt_terms.h"
#include "beltgrinding/belt_machine.h"
#include "surface_under_belt.h"

namespace beltgrinding {

/// Splines across a belt and what its energy needs of them.
struct BeltAcross {
    /// `shear`: as of BeltFace.
    BeltAcross(const AbrasiveBelt& belt, const std::vector<BeltRow>& rows, double shear,
               BeltSpline given);
    // Its parts refer to the spline.
    BeltAcross(const BeltAcross&) = delete;
    BeltAcross& operator=(const BeltAcross&) = delete;

    const BeltSpline spline;
    const BeltSheet sheet;
    const BeltTerms terms;
    const BeltFace face;
};

/// What is left of a spline's knots where some rows bear pressure and others do not: as close as
/// they are beside the former, wider away from them, since a cubic is what a plate without a load
/// bends to.
class BeltKnots {
  public:
    /// `touched`: by row.
    BeltKnots(const BeltSpline& finest, const std::vector<BeltRow>& rows,
              const std::vector<std::uint8_t>& touched);

    const std::vector<double>& lines() const { return lines_; }
    /// Rows may bear pressure that lie between knots as close as those of the finest spline.
    bool covers(const std::vector<BeltRow>& rows, const std::vector<std::uint8_t>& touched) const;
    bool operator==(const BeltKnots& other) const { return lines_ == other.lines_; }

  private:
    std::vector<double> lines_;       // mm
    std::vector<std::uint8_t> fine_;  // by interval: as in the finest spline
};

}  // namespace beltgrinding

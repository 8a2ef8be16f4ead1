#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "belt_across.h"
#include "belt_bands.h"
#include "belt_path.h"
#include "belt_stress.h"

namespace beltgrinding {

/// The splines across a belt that a contact is solved with: the finest, or wider ones where no
/// pressure is expected; and what they make of a path's columns.
class BeltBasis {
  public:
    /// `shear`: as of BeltFace. Keeps a reference to the rows.
    BeltBasis(const AbrasiveBelt& belt, const std::vector<BeltRow>& rows, double shear,
              BeltSpline finest)
        : belt_(belt), rows_(rows), shear_(shear), finest_(belt, rows, shear, std::move(finest)) {}

    const BeltAcross& finest() const { return finest_; }
    /// Those in use.
    const BeltAcross& across() const { return wider_ ? *wider_ : finest_; }
    /// Uses splines with these knots, mm; some of the finest ones'.
    void use(const std::vector<double>& lines);
    /// Computes what follows, unless it is that of the last call.
    void prepare(const BeltColumns& columns);
    const BeltBands& bending() const { return bending_; }
    const BeltStress::Compliance& compliance() const { return compliance_; }
    /// Coefficients of the splines in use, of those of the finest, and the other way round.
    Eigen::MatrixXd from_finest(Eigen::MatrixXd coefficients) const;
    Eigen::MatrixXd to_finest(Eigen::MatrixXd coefficients) const;

  private:
    AbrasiveBelt belt_;
    const std::vector<BeltRow>& rows_;
    double shear_;
    BeltAcross finest_;
    std::unique_ptr<BeltAcross> wider_;  // in use where it is there
    Eigen::MatrixXd to_wider_, from_wider_;
    BeltColumns prepared_for_;
    BeltBands bending_;
    BeltStress::Compliance compliance_;
};

}  // namespace beltgrinding

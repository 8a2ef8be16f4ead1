#include "belt_basis.h"

namespace beltgrinding {

void BeltBasis::use(const std::vector<double>& lines) {
    if (lines == across().spline.lines()) return;
    wider_.reset();
    prepared_for_ = {};
    if (lines == finest_.spline.lines()) return;
    wider_ = std::make_unique<BeltAcross>(belt_, rows_, shear_, BeltSpline(lines));
    to_wider_ = wider_->spline.from(finest_.spline);
    from_wider_ = finest_.spline.from(wider_->spline);
}

void BeltBasis::prepare(const BeltColumns& columns) {
    if (columns == prepared_for_) return;
    bending_ = across().sheet.bending(columns);
    compliance_ = BeltStress::Compliance(across().terms, columns);
    prepared_for_ = columns;
}

Eigen::MatrixXd BeltBasis::from_finest(Eigen::MatrixXd coefficients) const {
    if (wider_) coefficients = to_wider_ * coefficients;
    return coefficients;
}

Eigen::MatrixXd BeltBasis::to_finest(Eigen::MatrixXd coefficients) const {
    if (wider_) coefficients = from_wider_ * coefficients;
    return coefficients;
}

}  // namespace beltgrinding

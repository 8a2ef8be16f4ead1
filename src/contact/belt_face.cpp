// What the belt's face deflects by, where its sheet is bent.
#include <array>

#include "belt_solver.h"

namespace beltgrinding {

double BeltSolver::deflection_at(const BeltColumns& columns, const Eigen::MatrixXd& coefficients,
                                 std::size_t row, int column) const {
    return face_of(finest_.locals[row], columns.curvature(column), coefficients, column);
}

double BeltSolver::face_of(const BeltSpline::Local& b, const std::array<double, 3>& along,
                           const Eigen::MatrixXd& coefficients, int column) const {
    double sum = 0.0;
    for (std::size_t r = 0; r < BeltSpline::kLocal; ++r) {
        const int at = b.first + static_cast<int>(r);
        double curved = along[1] * coefficients(at, column);
        if (along[1] != 0.0)
            curved +=
                along[0] * coefficients(at, column - 1) + along[2] * coefficients(at, column + 1);
        sum += (b.value[r] - shear_ * b.curvature[r]) * coefficients(at, column) -
               shear_ * b.value[r] * curved;
    }
    return sum;
}

Eigen::ArrayXXd BeltSolver::face_at_cells(const BeltColumns& columns,
                                          const Eigen::MatrixXd& coefficients) const {
    Eigen::ArrayXXd cells(static_cast<Eigen::Index>(rows_.size()), columns.count());
    for (int i = 0; i < columns.count(); ++i) {
        const std::array<double, 3> along = columns.curvature(i);
        for (std::size_t k = 0; k < rows_.size(); ++k)
            cells(static_cast<Eigen::Index>(k), i) =
                face_of(across_->locals[k], along, coefficients, i);
    }
    return cells;
}

BeltSolver::FaceForm BeltSolver::face_form(const BeltColumns& columns, std::size_t k, int i) const {
    const BeltSpline::Local& b = across_->locals[k];
    FaceForm form;
    const std::array<double, 3> along = columns.curvature(i);
    if (shear_ > 0.0 && along[1] != 0.0) form.first = 0, form.last = 2;
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t r = 0; r < BeltSpline::kLocal; ++r)
            form.values[p][r] = (p == 1 ? b.value[r] - shear_ * b.curvature[r] : 0.0) -
                                shear_ * along[p] * b.value[r];
    return form;
}

}  // namespace beltgrinding

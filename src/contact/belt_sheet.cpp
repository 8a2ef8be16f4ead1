#include "belt_sheet.h"

#include <array>

#include "belt_curved.h"

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;
using Band = BeltBands::Band;

/// Adds 1/2 s' P s, s the slope along the belt, at a border. At the ends the belt is held.
void add_sloped(const BeltColumns& columns, int border, const Band& p, BeltBands& matrix) {
    const double square = 1.0 / columns.between[static_cast<std::size_t>(border)];
    const bool first = border == 0, last = border == columns.count();
    if (!last) matrix.block(border, 0) += square * p;
    if (first) return;
    matrix.block(border - 1, 0) += square * p;
    // Row: the column behind the border; column: that before it.
    if (!last) matrix.block(border - 1, 1) -= square * p;
}

}  // namespace

BeltSheet::BeltSheet(const AbrasiveBelt& belt, const BeltSpline& spline)
    : bending_(belt.bending()), ratio_(belt.poissons_ratio), spline_(spline) {}

BeltBands BeltSheet::bending(const BeltColumns& columns) const {
    const int n = columns.count(), m = spline_.count();
    BeltBands matrix(n, m);
    const Matrix mixed = ratio_ * bending_ * spline_.value_curvature();
    const CurvedForm<Band> form = {BeltBands::band_of(bending_ * spline_.values()),
                                   BeltBands::band_of(mixed),
                                   BeltBands::band_of(mixed.transpose())};
    const Band c = BeltBands::band_of(bending_ * spline_.curvatures());
    const Band twist = BeltBands::band_of(2.0 * (1.0 - ratio_) * bending_ * spline_.slopes());
    for (int i = 0; i < n; ++i) {
        matrix.block(i, 0) += columns.width[static_cast<std::size_t>(i)] * c;
        add_curved(columns, i, form, matrix);
    }
    for (int border = 0; border <= n; ++border) add_sloped(columns, border, twist, matrix);
    return matrix;
}

Eigen::MatrixXd BeltSheet::path_load(const BeltPath& path) const {
    const BeltColumns& columns = path.columns;
    const int n = columns.count(), m = spline_.count();
    Matrix load = Matrix::Zero(m, n);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(m);
    const Eigen::VectorXd even = bending_ * spline_.values() * ones;
    const Eigen::VectorXd across = ratio_ * bending_ * spline_.value_curvature().transpose() * ones;
    for (int i = 0; i < n; ++i) {
        const std::array<double, 3> weights = columns.curvature(i);
        if (weights[1] == 0.0) continue;
        const double bent = columns.apart(i) * path.turn[static_cast<std::size_t>(i)];
        for (int p = 0; p < 3; ++p)
            load.col(i - 1 + p) -= bent * weights[static_cast<std::size_t>(p)] * even;
        load.col(i) -= bent * across;
    }
    return load;
}

}  // namespace beltgrinding

#include "belt_sheet.h"

#include <algorithm>
#include <array>
#include <vector>

namespace beltgrinding {
namespace {

using Matrix = Eigen::MatrixXd;

}  // namespace

BeltSheet::BeltSheet(const AbrasiveBelt& belt, const BeltSpline& spline)
    : bending_(belt.bending()), ratio_(belt.poissons_ratio), spline_(spline) {
    const Matrix mixed = ratio_ * bending_ * spline_.value_curvature();
    bands_ = {BeltBands::band_of(bending_ * spline_.values()), BeltBands::band_of(mixed),
              BeltBands::band_of(mixed.transpose()),
              BeltBands::band_of(bending_ * spline_.curvatures()),
              BeltBands::band_of(2.0 * (1.0 - ratio_) * bending_ * spline_.slopes())};
}

BeltBands BeltSheet::bending(const BeltColumns& columns) const {
    enum : std::size_t { kCurved, kMixed, kTransposed, kAcross, kTwisted };
    const int n = columns.count();
    // By column and what is below it, how much there is of each band.
    std::vector<std::array<BeltBands::Shares, 3>> shares(static_cast<std::size_t>(n));
    const auto of = [&](int i, int below) -> BeltBands::Shares& {
        return shares[static_cast<std::size_t>(i)][static_cast<std::size_t>(below)];
    };
    for (int i = 0; i < n; ++i) {
        of(i, 0)[kAcross] += columns.width[static_cast<std::size_t>(i)];
        // 1/2 k' A k + k' B c, k the second derivative along the belt of the value c.
        const std::array<double, 3> k = columns.curvature(i);
        if (k[1] == 0.0) continue;
        const double h = columns.apart(i);
        for (int q = 0; q < 3; ++q) {
            for (int p = q; p < 3; ++p) {
                BeltBands::Shares& to = of(i - 1 + q, p - q);
                const double kp = k[static_cast<std::size_t>(p)];
                const double kq = k[static_cast<std::size_t>(q)];
                to[kCurved] += h * kp * kq;
                if (q == 1) to[kMixed] += h * kp;
                if (p == 1) to[kTransposed] += h * kq;
            }
        }
    }
    // 1/2 s' P s, s the slope along the belt, at each border. At the ends the belt is held.
    for (int border = 0; border <= n; ++border) {
        const double square = 1.0 / columns.between[static_cast<std::size_t>(border)];
        if (border < n) of(border, 0)[kTwisted] += square;
        if (border > 0) of(border - 1, 0)[kTwisted] += square;
        // Row: the column behind the border; column: that before it.
        if (border > 0 && border < n) of(border - 1, 1)[kTwisted] -= square;
    }
    BeltBands matrix(n, spline_.count());
    for (int i = 0; i < n; ++i)
        for (int below = 0; below < std::min(3, n - i); ++below)
            matrix.set(i, below, of(i, below), bands_);
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

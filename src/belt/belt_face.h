#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "belt_bands.h"
#include "belt_path.h"
#include "belt_spline.h"
#include "surface_under_belt.h"

namespace beltgrinding {

/// What the belt's face deflects by at the middles of rows and columns: the middle surface's
/// deflection, and where the sheet is bent, less by `shear` times its curvatures along and across.
class BeltFace {
  public:
    static constexpr int kLocal = BeltSpline::kLocal;

    /// `shear`: mm2.
    BeltFace(const BeltSpline& spline, const std::vector<BeltRow>& rows, double shear);

    /// mm, (rows, columns), by (splines, columns).
    Eigen::ArrayXXd deflection(const BeltColumns& columns,
                               const Eigen::MatrixXd& coefficients) const;
    /// Adds what forces on the face, N (rows, columns), push the splines with.
    void push(const BeltColumns& columns, const Eigen::ArrayXXd& forces, Eigen::MatrixXd& to) const;
    /// Adds springs against the face, N/mm (rows, columns).
    void stiffen(const BeltColumns& columns, const Eigen::ArrayXXd& springs, BeltBands& to) const;

    /// One cell's deflection, by the splines from `spline` on of the columns from `first` to `last`
    /// of i - 1, i and i + 1.
    struct Form {
        int spline = 0, first = 1, last = 1;
        std::array<std::array<double, kLocal>, 3> values{};
    };
    Form form(const BeltColumns& columns, std::size_t row, int i) const;

  private:
    /// Rows between the same two knots.
    struct Group {
        int spline, begin, end;
    };
    int splines_ = 0, rows_ = 0;
    std::vector<Group> groups_;
    // What a spline of a group, and its curvature along, add to the rows: by spline and row, and by
    // row and spline.
    Eigen::ArrayXXd own_, along_;
    Eigen::Array<double, kLocal, Eigen::Dynamic> own_by_row_, along_by_row_;
};

}  // namespace beltgrinding

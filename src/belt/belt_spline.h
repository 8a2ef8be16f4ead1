#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace beltgrinding {

/// Cubic B-splines across the belt, from -width/2 to width/2, whose knots lie closer at the side
/// edges, where the belt curls. All ones is the constant 1 (de Boor: A Practical Guide to Splines).
class BeltSpline {
  public:
    static constexpr int kLocal = 4;   // splines that are not 0 at a place
    static constexpr int kPlaces = 3;  // of Gauss's rule in an interval of the knots

    /// `interval`: mm, largest distance of the knots; `finest`: at the side edges.
    BeltSpline(double width, double interval, double finest);
    /// `lines`: mm, from side edge to side edge, ascending; knots lie there.
    explicit BeltSpline(std::vector<double> lines);

    int count() const { return static_cast<int>(knots_.size()) - 4; }

    /// The splines `first` to `first + 3`, their first and second derivatives, at one place.
    struct Local {
        int first = 0;
        std::array<double, kLocal> value{}, slope{}, curvature{};
    };
    /// At y, mm from the belt's middle.
    Local at(double y) const;

    /// mm, from side edge to side edge: where the knots lie.
    const std::vector<double>& lines() const { return lines_; }
    /// The coefficients nearest to those of another spline by least squares; the same function
    /// where all knots of the other one are among these, or where it is one of these splines.
    Eigen::MatrixXd from(const BeltSpline& other) const;

    /// Places (mm) and weights of Gauss's rule: the first of each interval of the knots, the
    /// second, the third.
    const std::vector<double>& places() const { return places_; }
    const std::vector<double>& weights() const { return weights_; }
    /// The splines at `places`.
    const std::vector<Local>& locals() const { return locals_; }

    /// Integrals over the width of products: value value, slope slope, curvature curvature, value
    /// (row) curvature (column).
    const Eigen::MatrixXd& values() const { return values_; }
    const Eigen::MatrixXd& slopes() const { return slopes_; }
    const Eigen::MatrixXd& curvatures() const { return curvatures_; }
    const Eigen::MatrixXd& value_curvature() const { return value_curvature_; }

  private:
    std::vector<double> lines_, knots_;  // mm
    std::vector<double> places_, weights_;
    std::vector<Local> locals_;
    Eigen::MatrixXd values_, slopes_, curvatures_, value_curvature_;
};

}  // namespace beltgrinding

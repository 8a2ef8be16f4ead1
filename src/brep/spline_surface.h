#pragma once

// Private to this room: points of B-spline surfaces, row by row.

#include <Geom_Surface.hxx>
#include <array>
#include <memory>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// A knot vector with what it takes to evaluate its B-splines without a division.
class SplineBasis {
  public:
    SplineBasis() = default;
    /// `knots`: each as often as it counts; the range of use has `degree` of them on either side.
    /// `period`: of the parameter, 0 where it does not come round.
    SplineBasis(std::vector<double> knots, int degree, double period);

    static constexpr int kMostDegree = 25;  ///< OpenCASCADE's own limit
    using Values = std::array<double, kMostDegree + 1>;

    int degree() const { return degree_; }
    /// Takes `parameter` into the first period, and gives the span in which it lies: the number of
    /// its lower knot. `near`: the span of a neighbour, looked at first. At a knot the span above.
    std::size_t span(double& parameter, std::size_t near) const;
    /// The degree + 1 splines that are not zero in the span, the first with number span - degree,
    /// and their derivatives (Cox 1972, de Boor 1972).
    void evaluate(std::size_t span, double parameter, Values& value, Values& slope) const;

  private:
    std::vector<double> knots_;
    std::vector<double> inverse_;  ///< [order - 1][i]: 1 / (knot i + order - knot i), 0 for 1 / 0
    int degree_ = 0;
    double period_ = 0;
};

/// A B-spline or Bezier surface. Immutable: any number of threads may ask. Where OpenCASCADE builds
/// the polynomial of each span that it comes to, this sums up the poles across a row once.
class SplineSurface {
  public:
    struct Point {
        Vec3 point, u, v;  ///< the point, mm, and its derivatives
    };
    /// Null for surfaces of other kinds, which OpenCASCADE evaluates quickly or alone.
    static std::shared_ptr<const SplineSurface> of(const Handle(Geom_Surface) & surface);

    /// The curve of constant v, or constant u, as a spline in the other parameter: its poles and
    /// their derivatives across, for one thread.
    class Row {
      public:
        /// The point at `u` (or `v`) of the row.
        Point at(double parameter);

      private:
        friend class SplineSurface;
        const SplineSurface* surface_ = nullptr;
        bool along_u_ = true;
        std::size_t near_ = 0;
        std::vector<double> poles_;  ///< 3 (4 if rational) coordinates, then their derivatives
    };
    Row row(bool along_u, double across) const;

    Point at(double u, double v) const;

  private:
    SplineSurface() = default;
    Point projected(const double* sums) const;

    SplineBasis u_, v_;
    std::size_t rows_ = 0, columns_ = 0;  ///< poles along u, along v
    std::size_t size_ = 3;                ///< coordinates of a pole; 4 if rational: times weight
    std::vector<double> poles_;           ///< [u][v][coordinate]
};

}  // namespace beltgrinding

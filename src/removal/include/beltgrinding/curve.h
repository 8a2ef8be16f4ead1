#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace beltgrinding {

/// A measured function curve: monotone piecewise cubic through points (Fritsch and Carlson,
/// Monotone piecewise cubic interpolation, SIAM J. Numerical Analysis 17, 1980, with the slopes of
/// Fritsch and Butland, 1984). Between two points it never leaves their values. Beyond the measured
/// range it keeps the value at its end.
class Curve {
  public:
    Curve() = default;
    /// `points` (x, value), x ascending, values zero or positive, at least two; none: an empty
    /// curve. `name` stands for it in messages. Throws InputError.
    Curve(std::vector<Eigen::Vector2d> points, const std::string& name);

    /// It has no points.
    bool empty() const { return points_.empty(); }
    /// Its value at x; it must not be empty.
    double operator()(double x) const;
    double lower() const { return points_.front().x(); }  ///< end of the measured range
    double upper() const { return points_.back().x(); }   ///< the other end
    /// x lies in the measured range.
    bool measured(double x) const { return x >= lower() && x <= upper(); }

  private:
    std::vector<Eigen::Vector2d> points_;
    std::vector<double> slopes_;
};

}  // namespace beltgrinding

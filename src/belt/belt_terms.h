#pragma once

#include <Eigen/Core>
#include <array>

#include "belt_bands.h"
#include "belt_spline.h"

namespace beltgrinding {

/// Polynomials across the belt, which are 0 with their slope at the side edges, and what they make
/// of the splines.
struct BeltTerms {
    static constexpr int kTerms = 6;
    static constexpr int kEven = kTerms, kOdd = kTerms + 1;  ///< rows beside the polynomials
    static constexpr int kPadded = 8;
    using Terms = Eigen::Matrix<double, kPadded, Eigen::Dynamic>;

    BeltTerms(double width, const BeltSpline& spline);

    /// The integrals of the rows of `weighted` times the splines' values or derivatives times
    /// `factors`, which are given at the rule's places: kPadded numbers a spline.
    enum class Of { kValue, kSlope, kCurvature };
    void moments(Of part, const double* factors, double* to) const;
    /// The same at the places, (places, columns), of what has the coefficients in the columns.
    void at_places(Of part, const Eigen::MatrixXd& coefficients, Eigen::ArrayXXd& to) const;
    /// Adds the sums of the splines' values or derivatives at the places times `factors`, by
    /// spline.
    void add_moments(Of part, const double* factors, double* to) const;
    /// The sum of what there is by term (columns) times the terms' coefficients.
    static void sum(const Eigen::MatrixXd& by_term, const Eigen::Ref<const Eigen::VectorXd>& terms,
                    double* to);

    const BeltSpline& spline;
    /// At the spline's places, times their weights; below them, 1 and 2 y / width, the same.
    Terms weighted;
    Eigen::MatrixXd by_place;   ///< the polynomials of it: (places, terms)
    Terms bent;                 ///< integrals with splines' curvatures
    Eigen::VectorXd even, odd;  ///< integrals of splines, and of them times 2 y / width
    Eigen::MatrixXd value_value, value_curvature, curvature_curvature;  ///< of the polynomials
    /// By term, the bands of its integral with the splines' values (rows) and curvatures, the other
    /// way round, and with two slopes.
    Eigen::MatrixXd along, across, twisted;
    BeltBands::Band stretched, leaning;  ///< of two splines' values, and of them times 2 y / width

  private:
    /// By part: of a place in each interval (rows), its splines' values, of the first place the
    /// first spline, the second, ...
    std::array<Eigen::ArrayXXd, 3> parts_;
};

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>

namespace beltgrinding {

/// A trained regression: value = scale (sum_i c_i exp(-gamma |x - v_i|^2) - rho), x standardised.
struct TrainedRegression {
    Eigen::MatrixXf vectors;          ///< (features, n), standardised
    Eigen::VectorXf coefficients;     ///< (n,)
    Eigen::VectorXf mean, deviation;  ///< of each feature
    double rho = 0.0;
    double gamma = 0.0;
    double scale = 1.0;

    /// Values for the columns of `features`.
    Eigen::VectorXf predict(const Eigen::MatrixXf& features) const;
    /// Throws InputError if the parts do not fit together or are not finite.
    void validate(int features) const;
};

}  // namespace beltgrinding

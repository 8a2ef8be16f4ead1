#pragma once

#include <Eigen/Core>

namespace beltgrinding {

/// Settings of epsilon support-vector regression with a Gaussian kernel, for features of zero mean
/// and unit deviation and a target of unit deviation.
struct RegressionSettings {
    double cost = 10.0;
    double gamma = 0.02;    ///< of exp(-gamma |a - b|^2)
    double epsilon = 0.02;  ///< half width of the tube without loss
};

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

/// Trains by libsvm (Chang and Lin, LIBSVM: a library for support vector machines, ACM TIST 2,
/// 2011). Throws InputError for samples that are none.
TrainedRegression train_regression(const Eigen::MatrixXf& features, const Eigen::VectorXf& targets,
                                   const RegressionSettings& settings);

}  // namespace beltgrinding

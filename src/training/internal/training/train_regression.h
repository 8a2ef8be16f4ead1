#pragma once

#include "surrogate/regression.h"

namespace beltgrinding {

/// Settings of epsilon support-vector regression with a Gaussian kernel, for features of zero mean
/// and unit deviation and a target of unit deviation.
struct RegressionSettings {
    double cost = 10.0;
    double gamma = 0.02;    ///< of exp(-gamma |a - b|^2)
    double epsilon = 0.02;  ///< half width of the tube without loss
};

/// Trains by libsvm (Chang and Lin, LIBSVM: a library for support vector machines, ACM TIST 2,
/// 2011). Throws InputError for samples that are none.
TrainedRegression train_regression(const Eigen::MatrixXf& features, const Eigen::VectorXf& targets,
                                   const RegressionSettings& settings);

}  // namespace beltgrinding

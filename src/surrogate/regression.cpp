#include "surrogate/regression.h"

#include <cmath>
#include <string>

#include "beltgrinding/error.h"

namespace beltgrinding {

Eigen::VectorXf TrainedRegression::predict(const Eigen::MatrixXf& features) const {
    const Eigen::MatrixXf x = (features.colwise() - mean).array().colwise() / deviation.array();
    Eigen::MatrixXf kernel = 2.0f * (vectors.transpose() * x);  // (vectors, columns)
    kernel.colwise() -= vectors.colwise().squaredNorm().transpose();
    kernel.rowwise() -= x.colwise().squaredNorm();
    kernel = (static_cast<float>(gamma) * kernel.array()).exp();
    const Eigen::VectorXf sum = kernel.transpose() * coefficients;
    return static_cast<float>(scale) * (sum.array() - static_cast<float>(rho));
}

void TrainedRegression::validate(int features) const {
    const bool fits = vectors.rows() == features && vectors.cols() == coefficients.size() &&
                      mean.size() == features && deviation.size() == features;
    if (!fits) {
        throw InputError("surrogate.arrays",
                         "surrogate: its arrays do not fit together ({given} features where there "
                         "should be {expected})",
                         {{"given", vectors.rows()}, {"expected", features}});
    }
    if (!vectors.allFinite() || !coefficients.allFinite() || !mean.allFinite() ||
        !(deviation.array() > 0.0f).all() || !deviation.allFinite() || !std::isfinite(rho) ||
        !std::isfinite(scale) || !(gamma > 0.0)) {
        throw InputError("surrogate.numbers",
                         "surrogate: it holds a number that is not finite, or not positive");
    }
}

}  // namespace beltgrinding

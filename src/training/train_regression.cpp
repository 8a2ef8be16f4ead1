#include "training/train_regression.h"

#include <libsvm/svm.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr Eigen::Index kLeastSamples = 20;

struct FreeModel {
    void operator()(svm_model* model) const { svm_free_and_destroy_model(&model); }
};

}  // namespace

TrainedRegression train_regression(const Eigen::MatrixXf& features, const Eigen::VectorXf& targets,
                                   const RegressionSettings& settings) {
    const Eigen::Index n = features.cols(), m = features.rows();
    if (n < kLeastSamples || targets.size() != n) {
        throw InputError("training.too_few",
                         "regression: there are {count} samples; at least {least} are needed, with "
                         "a target each",
                         {{"count", n}, {"least", kLeastSamples}});
    }
    if (!features.allFinite() || !targets.allFinite()) {
        throw InputError("training.not_finite", "regression: a sample is not finite");
    }
    TrainedRegression result;
    result.mean = features.rowwise().mean();
    result.deviation =
        (features.colwise() - result.mean).rowwise().norm() / std::sqrt(static_cast<float>(n));
    result.deviation = result.deviation.cwiseMax(1e-6f);
    result.scale = std::sqrt((targets.array() - targets.mean()).square().mean());
    if (!(result.scale > 0.0))
        throw InputError("training.same_targets", "regression: all targets are the same");
    result.gamma = settings.gamma;

    const Eigen::MatrixXd x =
        ((features.colwise() - result.mean).array().colwise() / result.deviation.array())
            .matrix()
            .cast<double>();
    std::vector<svm_node> nodes(static_cast<std::size_t>(n * (m + 1)));
    std::vector<svm_node*> rows(static_cast<std::size_t>(n));
    std::vector<double> values(static_cast<std::size_t>(n));
    for (Eigen::Index k = 0; k < n; ++k) {
        svm_node* row = &nodes[static_cast<std::size_t>(k * (m + 1))];
        for (Eigen::Index f = 0; f < m; ++f) row[f] = {static_cast<int>(f) + 1, x(f, k)};
        row[m] = {-1, 0.0};
        rows[static_cast<std::size_t>(k)] = row;
        values[static_cast<std::size_t>(k)] = targets[k] / result.scale;
    }
    svm_problem problem{static_cast<int>(n), values.data(), rows.data()};
    svm_parameter parameter{};
    parameter.svm_type = EPSILON_SVR;
    parameter.kernel_type = RBF;
    parameter.gamma = settings.gamma;
    parameter.C = settings.cost;
    parameter.p = settings.epsilon;
    parameter.eps = 1e-3;
    parameter.cache_size = 1000.0;  // MB
    parameter.shrinking = 0;
    if (const char* wrong = svm_check_parameter(&problem, &parameter)) {
        throw InputError("training.refused", "regression: libsvm refuses: {reason}",
                         {{"reason", wrong}});
    }
    svm_set_print_string_function([](const char*) {});
    const std::unique_ptr<svm_model, FreeModel> model(svm_train(&problem, &parameter));
    result.rho = model->rho[0];
    result.vectors.resize(m, model->l);
    result.coefficients.resize(model->l);
    for (int v = 0; v < model->l; ++v) {
        result.coefficients[v] = static_cast<float>(model->sv_coef[0][v]);
        for (Eigen::Index f = 0; f < m; ++f) {
            result.vectors(f, v) = static_cast<float>(model->SV[v][f].value);
        }
    }
    result.validate(static_cast<int>(m));
    return result;
}

}  // namespace beltgrinding

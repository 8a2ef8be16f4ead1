#include "layer_pressure.h"

#include <Eigen/Cholesky>
#include <utility>

namespace beltgrinding {
namespace {

constexpr std::size_t kMixed = 5;   // of the last changes
constexpr double kRegular = 1e-10;  // of their products' diagonal

}  // namespace

Eigen::ArrayXd PressureMixing::next(const Eigen::ArrayXd& given, const Eigen::ArrayXd& became) {
    const Eigen::ArrayXd off = became - given;
    Eigen::ArrayXd next = became;
    if (last_off_.size() == off.size()) {
        add_change(off - last_off_, became - last_became_);
        Eigen::MatrixXd products = products_;
        products.diagonal() *= 1.0 + kRegular;
        const Eigen::VectorXd shares = products.ldlt().solve(along(off));
        if (shares.allFinite())
            for (Eigen::Index k = 0; k < shares.size(); ++k)
                next -= shares[k] * became_[static_cast<std::size_t>(k)];
    }
    last_off_ = off;
    last_became_ = became;
    return next.max(0.0);
}

void PressureMixing::add_change(Eigen::ArrayXd off, Eigen::ArrayXd became) {
    if (off_.size() == kMixed) {
        off_.erase(off_.begin());
        became_.erase(became_.begin());
        const Eigen::Index left = products_.rows() - 1;
        products_ = Eigen::MatrixXd(products_.bottomRightCorner(left, left));
    }
    off_.push_back(std::move(off));
    became_.push_back(std::move(became));
    const auto count = static_cast<Eigen::Index>(off_.size());
    products_.conservativeResize(count, count);
    products_.col(count - 1) = along(off_.back());
    products_.row(count - 1) = products_.col(count - 1).transpose();
}

Eigen::VectorXd PressureMixing::along(const Eigen::ArrayXd& other) const {
    Eigen::VectorXd result(static_cast<Eigen::Index>(off_.size()));
    for (Eigen::Index k = 0; k < result.size(); ++k)
        result[k] = off_[static_cast<std::size_t>(k)].matrix().dot(other.matrix());
    return result;
}

Eigen::ArrayXd LastLayers::next() const {
    return goes_on_ ? changed_as_before() : last_;
}

void LastLayers::add(const Eigen::ArrayXd& pressure) {
    goes_on_ = before_.size() == pressure.size() &&
               (changed_as_before() - pressure).abs().sum() < (last_ - pressure).abs().sum();
    before_ = std::move(last_);
    last_ = pressure;
}

}  // namespace beltgrinding

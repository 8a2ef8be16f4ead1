#include "block_banded.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace beltgrinding {

BlockBanded::BlockBanded(int count, int size)
    : count_(count), size_(size), blocks_(static_cast<std::size_t>(offset(count, 0)), 0.0) {}

void BlockBanded::set_zero() {
    std::fill(blocks_.begin(), blocks_.end(), 0.0);
}

bool BlockBanded::factorise() {
    for (int i = 0; i < count_; ++i) {
        auto own = block(i, 0);
        Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(own);
        if (factor.info() != Eigen::Success) return false;
        const auto lower = own.triangularView<Eigen::Lower>();
        for (int d = 1; d <= 2 && i + d < count_; ++d)
            lower.transpose().solveInPlace<Eigen::OnTheRight>(block(i, d));
        if (i + 1 < count_) {
            const auto first = block(i, 1);
            block(i + 1, 0).selfadjointView<Eigen::Lower>().rankUpdate(first, -1.0);
            if (i + 2 < count_) {
                const auto second = block(i, 2);
                block(i + 1, 1).noalias() -= second * first.transpose();
                block(i + 2, 0).selfadjointView<Eigen::Lower>().rankUpdate(second, -1.0);
            }
        }
    }
    return true;
}

void BlockBanded::solve(Eigen::MatrixXd& values) const {
    const auto rows = [&](int i) { return values.middleRows(i * size_, size_); };
    for (int i = 0; i < count_; ++i) {
        block(i, 0).triangularView<Eigen::Lower>().solveInPlace(rows(i));
        for (int d = 1; d <= 2 && i + d < count_; ++d) rows(i + d).noalias() -= block(i, d) * rows(i);
    }
    for (int i = count_; i-- > 0;) {
        for (int d = 1; d <= 2 && i + d < count_; ++d)
            rows(i).noalias() -= block(i, d).transpose() * rows(i + d);
        block(i, 0).transpose().triangularView<Eigen::Upper>().solveInPlace(rows(i));
    }
}

}  // namespace beltgrinding

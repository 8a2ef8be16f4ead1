#include "normal_matrix.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kColumns = 32;    // in a block of work
constexpr std::size_t kSamples = 4096;  // in a block of work
constexpr double kAnew = 0.3;  // of the samples with other weights, from which all is summed anew

}  // namespace

NormalMatrix::NormalMatrix(const Influence& influence, std::size_t samples,
                           std::vector<std::uint32_t> free, const std::vector<char>& chained,
                           const RunContext& context)
    : influence_(influence), free_(std::move(free)), begin_(samples + 1, 0), context_(context) {
    for (const std::uint32_t j : free_) {
        for (std::size_t e = influence_.first[j]; e < influence_.first[j + 1]; ++e) {
            ++begin_[influence_.sample[e] + 1];
        }
    }
    for (std::size_t s = 0; s < samples; ++s) begin_[s + 1] += begin_[s];
    rows_.resize(begin_.back());
    std::vector<std::size_t> at(begin_.begin(), begin_.end() - 1);
    for (std::size_t v = 0; v < free_.size(); ++v) {
        for (std::size_t e = influence_.first[free_[v]]; e < influence_.first[free_[v] + 1]; ++e) {
            rows_[at[influence_.sample[e]]++] = {static_cast<std::uint32_t>(v),
                                                 influence_.depth[e]};
        }
    }
    // The pattern, column by column: the motions that share a sample.
    const std::size_t count = free_.size();
    std::vector<std::vector<int>> below(count);
    parallel_blocks(count, kColumns, context_, [&](std::size_t begin, std::size_t end) {
        std::vector<std::size_t> seen(count, count);
        for (std::size_t v = begin; v < end; ++v) {
            const auto add = [&](std::size_t other) {
                if (other < v || seen[other] == v) return;
                seen[other] = v;
                below[v].push_back(static_cast<int>(other));
            };
            add(v);
            if (v + 1 < count && chained[v] != 0) add(v + 1);
            for (std::size_t e = influence_.first[free_[v]]; e < influence_.first[free_[v] + 1];
                 ++e) {
                const std::uint32_t s = influence_.sample[e];
                for (std::size_t r = begin_[s]; r < begin_[s + 1]; ++r) add(rows_[r].variable);
            }
            std::sort(below[v].begin(), below[v].end());
        }
    });
    const auto n = static_cast<int>(count);
    matrix_.resize(n, n);
    std::size_t entries = 0;
    for (const auto& rows : below) entries += rows.size();
    matrix_.resizeNonZeros(static_cast<Eigen::Index>(entries));
    int filled = 0;
    for (int v = 0; v < n; ++v) {
        matrix_.outerIndexPtr()[v] = filled;
        for (const int row : below[static_cast<std::size_t>(v)]) {
            matrix_.innerIndexPtr()[filled++] = row;
        }
    }
    matrix_.outerIndexPtr()[n] = filled;
}

Eigen::ArrayXd NormalMatrix::forward(const Eigen::ArrayXd& x) const {
    const std::size_t samples = begin_.size() - 1;
    Eigen::ArrayXd y(static_cast<Eigen::Index>(samples));
    parallel_blocks(samples, kSamples, context_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            double sum = 0.0;
            for (std::size_t r = begin_[s]; r < begin_[s + 1]; ++r) {
                sum += rows_[r].depth * x[static_cast<Eigen::Index>(rows_[r].variable)];
            }
            y[static_cast<Eigen::Index>(s)] = sum;
        }
    });
    return y;
}

Eigen::ArrayXd NormalMatrix::transposed(const Eigen::ArrayXd& y) const {
    Eigen::ArrayXd x(static_cast<Eigen::Index>(free_.size()));
    parallel_blocks(free_.size(), kColumns, context_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            double sum = 0.0;
            for (std::size_t e = influence_.first[free_[v]]; e < influence_.first[free_[v] + 1];
                 ++e) {
                sum += influence_.depth[e] * y[static_cast<Eigen::Index>(influence_.sample[e])];
            }
            x[static_cast<Eigen::Index>(v)] = sum;
        }
    });
    return x;
}

const NormalMatrix::Matrix& NormalMatrix::weighted(const Eigen::ArrayXd& w) {
    const bool first = weights_.size() == 0;
    Eigen::ArrayXd change = first ? w : w - weights_;
    const bool anew = first || static_cast<double>((change != 0.0).count()) >
                                   kAnew * static_cast<double>(w.size());
    if (anew) change = w;
    const std::size_t count = free_.size();
    parallel_blocks(count, kColumns, context_, [&](std::size_t begin, std::size_t end) {
        std::vector<double> sum(count, 0.0);
        for (std::size_t v = begin; v < end; ++v) {
            for (std::size_t e = influence_.first[free_[v]]; e < influence_.first[free_[v] + 1];
                 ++e) {
                const std::uint32_t s = influence_.sample[e];
                const double factor = influence_.depth[e] * change[static_cast<Eigen::Index>(s)];
                if (factor == 0.0) continue;
                // A sample's variables rise: those from v on are its last.
                for (std::size_t r = begin_[s + 1]; r-- > begin_[s] && rows_[r].variable >= v;) {
                    sum[rows_[r].variable] += factor * rows_[r].depth;
                }
            }
            const int* rows = matrix_.innerIndexPtr();
            const auto column = static_cast<int>(v);
            for (int k = matrix_.outerIndexPtr()[column]; k < matrix_.outerIndexPtr()[column + 1];
                 ++k) {
                double& value = sum[static_cast<std::size_t>(rows[k])];
                matrix_.valuePtr()[k] = anew ? value : matrix_.valuePtr()[k] + value;
                value = 0.0;
            }
        }
    });
    weights_ = w;
    return matrix_;
}

}  // namespace beltgrinding

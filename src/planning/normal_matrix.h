#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "beltgrinding/run_context.h"
#include "beltgrinding/simulation.h"

namespace beltgrinding {

/// Products with the influence A of the motions that are free, and A' W A.
class NormalMatrix {
  public:
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

    /// `free`: numbers of the motions that are variables, rising. `chained[k]`: variables k and k +
    /// 1 are neighbours, and (k + 1, k) is kept in the pattern. Keeps a reference to the influence.
    NormalMatrix(const Influence& influence, std::size_t samples, std::vector<std::uint32_t> free,
                 const std::vector<char>& chained, const RunContext& context);

    std::size_t variables() const { return free_.size(); }
    /// A x, (samples).
    Eigen::ArrayXd forward(const Eigen::ArrayXd& x) const;
    /// A' y, (variables).
    Eigen::ArrayXd transposed(const Eigen::ArrayXd& y) const;
    /// The lower triangle of A' diag(w) A; the entries of the pattern that it has not are 0. Where
    /// few of the weights are others than at the last call, only what they change is added.
    const Matrix& weighted(const Eigen::ArrayXd& w);

  private:
    struct Row {
        std::uint32_t variable;
        float depth;
    };

    const Influence& influence_;
    std::vector<std::uint32_t> free_;
    std::vector<std::size_t> begin_;  // of each sample's entries
    std::vector<Row> rows_;
    Matrix matrix_;
    Eigen::ArrayXd weights_;  // of `matrix_`; empty at first
    RunContext context_;
};

}  // namespace beltgrinding

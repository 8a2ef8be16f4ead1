#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "belt_energy.h"
#include "block_banded.h"

namespace beltgrinding {

/// The factor of the second derivatives of a belt's energy, and Newton's steps by it. Springs that
/// have switched since are taken into a step without a new factor.
class BeltFactor {
  public:
    /// With so much of the stress, up to the share `most`, as leaves them positive; false: not
    /// without any.
    bool factorise(const BeltEnergy& energy, const BeltBasis& basis, const BeltSupport& support,
                   const BeltIterate& at, double most);
    /// The springs that have switched since are so few that a step by this factor costs less than
    /// a new one.
    bool serves(const BeltSupport& support) const;
    /// Newton's step; `again`: by the factor of a step before.
    BeltStep step(const BeltEnergy& energy, const BeltBasis& basis, const BeltSupport& support,
                  const BeltUnbalanced& off, bool again);

  private:
    /// The cells that touch the work and do not so in the factor, or the other way round.
    std::vector<std::size_t> switched(const BeltSupport& support) const;
    /// Solves for what the borders push the belt with, and for `left`, by the left half of a factor
    /// that is new.
    void set_borders(const BeltEnergy& energy, const BeltBasis& basis, const BeltSupport& support,
                     Eigen::MatrixXd& left);
    /// Solves for what a unit spring at these cells pushes the belt with, where that is not yet
    /// known.
    void add_switched(const BeltColumns& columns, const BeltBasis& basis,
                      const BeltSupport& support, const std::vector<std::size_t>& cells);
    /// With the signs of the factor's rows, the lower ones of all columns.
    Eigen::MatrixXd signed_by_rows(Eigen::MatrixXd values) const;

    BeltBands bands_;
    BlockBanded matrix_;
    BeltStress::Coupling coupling_;
    std::vector<std::uint8_t> touching_;  // by cell, in the factor
    // Beside the belt, the work's lift, the mean stress, what of it is linear across: what they
    // push the belt with, by the left half of the factor, and what is left of their own matrix.
    Eigen::MatrixXd borders_;
    Eigen::VectorXd border_own_;
    // Springs that were switched since: the same, and their products with the borders and among
    // each other.
    std::vector<std::size_t> switched_;
    Eigen::MatrixXd switched_borders_, products_;
};

}  // namespace beltgrinding

#pragma once

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// Elasticity of the wheel: maps the pressure on the grid's cells to the displacement of its
/// surface into the wheel. Symmetric and positive definite in the inner product weighted by
/// `coverage`.
class ComplianceOperator : public ContactModel {
  public:
    /// By `solve_contact`.
    ContactSolution solve(const ContactProblem& problem,
                          const Eigen::ArrayXd* start = nullptr) const final;
    /// displacement (mm, into the wheel) = C(coverage * pressure). Arrays of grid.cells();
    /// pressure in MPa; coverage: share of the cell that the workpiece covers, in [0, 1].
    virtual void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
                       Eigen::ArrayXd& displacement) const = 0;
    /// An estimate of the diagonal of C at full coverage, mm/MPa: scales the solver's first step.
    virtual double diagonal() const = 0;
    /// True if a cell's displacement depends on its own pressure only.
    virtual bool local() const { return false; }
};

/// Elastic foundation (Winkler): u = p / stiffness, each cell for itself.
/// Johnson: Contact Mechanics (1985), section 4.3.
class ElasticFoundation final : public ComplianceOperator {
  public:
    /// `stiffness` in MPa/mm (N/mm3), positive.
    explicit ElasticFoundation(double stiffness);

    void set_grid(const ContactGrid&) override {}
    void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
               Eigen::ArrayXd& displacement) const override;
    double diagonal() const override { return 1.0 / stiffness_; }
    bool local() const override { return true; }
    std::string describe() const override;

  private:
    double stiffness_;
};

}  // namespace beltgrinding

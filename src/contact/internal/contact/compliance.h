#pragma once

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// Elasticity of the wheel on one grid: maps the pressure on the cells to the displacement of the
/// wheel's surface into the wheel. Symmetric and positive definite in the inner product weighted by
/// `coverage`.
///
/// A contact is solved by constrained conjugate gradients: Polonsky and Keer, A numerical method
/// for solving rough contact problems based on the multi-level multi-summation and conjugate
/// gradient techniques, Wear 231 (1999).
class ComplianceOperator : public PreparedContact {
  public:
    /// displacement (mm, into the wheel) = C(coverage * pressure), one value per cell of `grid()`;
    /// pressure in MPa; coverage: share of the cell that the workpiece covers, in [0, 1]. Throws
    /// std::invalid_argument on arrays of another size than the grid's.
    void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
               Eigen::ArrayXd& displacement);
    /// An estimate of the diagonal of C at full coverage, mm/MPa: scales the solver's first step.
    virtual double diagonal() const = 0;
    /// True if a cell's displacement depends on its own pressure only.
    virtual bool local() const { return false; }

  protected:
    using PreparedContact::PreparedContact;

  private:
    ContactSolution do_solve(const ContactProblem& problem, const Eigen::ArrayXd* start) final;
    /// All three arrays have one value per cell.
    virtual void do_apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
                          Eigen::ArrayXd& displacement) = 0;
};

/// A linear elastic wheel: its contacts are solved with a compliance operator.
class ElasticModel : public ContactModel {
  public:
    /// The operator that `prepare` gives, as what it is.
    std::unique_ptr<ComplianceOperator> compliance(const ContactGrid& grid) const;

  private:
    std::unique_ptr<PreparedContact> do_prepare(const ContactGrid& grid) const final;
    /// The grid is a valid one. Safe from several threads.
    virtual std::unique_ptr<ComplianceOperator> make_operator(const ContactGrid& grid) const = 0;
};

/// Elastic foundation (Winkler): u = p / stiffness, each cell for itself.
/// Johnson: Contact Mechanics (1985), section 4.3.
class ElasticFoundation final : public ElasticModel {
  public:
    /// `stiffness` in MPa/mm (N/mm3), positive.
    explicit ElasticFoundation(double stiffness);
    std::string describe() const override;

  private:
    std::unique_ptr<ComplianceOperator> make_operator(const ContactGrid& grid) const override;

    double stiffness_;
};

}  // namespace beltgrinding

#pragma once

#include "beltgrinding/contact_model.h"
#include "elastic/edge_loads.h"
#include "elastic/spectrum_cache.h"

namespace beltgrinding {

/// Slope of the workpiece along y at every cell, mm/mm, from the cells beside it that are wholly
/// covered and of the same layer; 0 where there is none. That of the gap less the wheel's own.
Eigen::ArrayXd axial_slopes(const ContactGrid& grid, const ContactProblem& problem);

/// Elasticity of the wheel on one grid: maps the pressure on the cells to the displacement of the
/// wheel's surface into the wheel. Symmetric and positive definite in the inner product weighted by
/// `coverage`.
///
/// A contact is solved by constrained conjugate gradients: Polonsky and Keer, A numerical method
/// for solving rough contact problems based on the multi-level multi-summation and conjugate
/// gradient techniques, Wear 231 (1999). It is solved on the columns around the pressed ones alone,
/// and looked at on the whole grid in the end: the wheel presses on fewer cells than it is near.
class ComplianceOperator : public PreparedContact {
  public:
    /// displacement (mm, into the wheel) = C(coverage * pressure), one value per cell of `grid()`;
    /// pressure in MPa; coverage: share of the cell that the workpiece covers, as in
    /// `Coverage::share`; at edges of the workpiece C is what `EdgeLoads` makes of it. Throws
    /// std::invalid_argument on arrays of another size than the grid's.
    void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
               Eigen::ArrayXd& displacement);
    /// From here on `apply` is for a surface with the slopes of the problem's gap, until that is
    /// cleared, for wheels whose surface moves along the axis as well: what it gives is then what
    /// the wheel recedes from the surface. Symmetric and positive definite as well. A solution has
    /// the surface of its problem.
    virtual void set_surface(const ContactProblem&) {}
    /// As `apply`, with the coverage of the last call of that or of `set_coverage`.
    void apply_covered(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
                       Eigen::ArrayXd& displacement);
    void set_coverage(const Eigen::ArrayXd& coverage) { edges_.find(working_, coverage); }
    virtual void clear_surface() {}
    EdgeSoftness edge_softness() const final { return edges_.softness(); }
    /// An estimate of the diagonal of C at full coverage, mm/MPa: scales the solver's first step.
    virtual double diagonal() const = 0;
    /// The same of what a cell gives way while a contact is solved, with the problem's recession.
    double softness() const { return diagonal() + recession_; }
    /// True if a cell's displacement depends on its own pressure only.
    virtual bool local() const { return false; }

  protected:
    ComplianceOperator(const ContactGrid& grid, std::string description)
        : PreparedContact(grid, std::move(description)), working_(grid) {}
    /// The grid of which the cells are at present: `grid()`, or fewer of its columns.
    const ContactGrid& working() const { return working_; }

  private:
    friend class ElasticModel;
    ContactSolution do_solve(const ContactProblem& problem, const Eigen::ArrayXd* start) final;
    /// What the wheel's surface sinks in, mm, under `pressure`, MPa, on whole cells. Both arrays
    /// have one value per cell.
    virtual void do_apply(const Eigen::ArrayXd& pressure, Eigen::ArrayXd& displacement) = 0;
    /// As `ContactSolution::axial`, under `pressure`, MPa, on whole cells.
    virtual Eigen::ArrayXXd side_displacement(const Eigen::ArrayXd&) { return {}; }
    /// Whether it can work on fewer columns; `working()` has others than before.
    virtual bool by_columns() const { return false; }
    virtual void do_work_on_columns() {}
    void work_on_columns(int count);
    /// Solves on the columns from `first` to `last`, as if there were no others; the pressure is of
    /// the whole grid.
    ContactSolution solve_columns(const ContactProblem& problem, const Eigen::ArrayXd& start,
                                  int first, int last, double tolerance);
    /// Whether what was solved on those columns meets the work on others, or may.
    bool goes_on_beyond(const ContactProblem& problem, const ContactSolution& solution, int first,
                        int last);
    /// kappa, from how much less the neighbour of a pressed line of cells sinks in.
    EdgeSoftness find_edge_softness();

    double recession_ = 0.0;  // mm/MPa, of the problem that is solved
    ContactGrid working_;
    EdgeLoads edges_;
    Eigen::ArrayXd load_, displacement_;
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

    mutable SpectrumCache<EdgeSoftness> edge_softness_;  // by the number of columns
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

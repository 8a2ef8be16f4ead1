#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>

#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// The wheel's own regular grid: nx cells along the circumference (arc length s, contact frame's x
/// at the contact) by ny along the axis. Cell (i, j) has index j * nx + i and its centre at
/// s = (i - (nx - 1) / 2) ds, y = (j - (ny - 1) / 2) dy.
struct ContactGrid {
    int nx = 0;       ///< cells along the circumference
    int ny = 0;       ///< cells along the axis
    double ds = 1.0;  ///< mm
    double dy = 1.0;  ///< mm

    /// Number of cells.
    int cells() const { return nx * ny; }
    /// mm2
    double cell_area() const { return ds * dy; }
    /// Arc length of column i, mm.
    double s(int i) const { return (i - 0.5 * (nx - 1)) * ds; }
    /// Place of row j along the axis, mm.
    double y(int j) const { return (j - 0.5 * (ny - 1)) * dy; }
    /// The same cells.
    bool operator==(const ContactGrid&) const = default;

    /// Throws InputError unless there are cells, of positive and finite sides.
    void validate() const;
};

/// The unilateral (Signorini) contact of the wheel with a rigid surface on the grid that it was
/// prepared for: find p >= 0 with g + u(p) - delta >= 0 and p (g + u - delta) = 0, u the
/// displacement of the wheel's surface under p.
struct ContactProblem {
    Eigen::ArrayXd gap;       ///< mm, undeformed wheel to surface, per cell; +inf: nothing there
    Eigen::ArrayXd coverage;  ///< share of the cell that the workpiece covers; 0 or more
    /// mm that the wheel's own profile stands back, one per row of the grid; empty: it is a
    /// cylinder. It is part of the gap, and moves along where the wheel's surface moves along its
    /// axis.
    Eigen::ArrayXd drop;
    bool force_control = true;  ///< else position control
    double force = 0.0;         ///< N, commanded (force control)
    double approach = 0.0;      ///< mm, commanded (position control)
    /// mm/N by which the robot gives way under the contact's force (position control); 0: rigid
    double robot_compliance = 0.0;
    /// mm/MPa by which the surface recedes until the time that the pressure is asked for: an
    /// abrasive takes what is pressed most first. Of a step, a wheel asks for that at the middle,
    /// and a belt at the end, which a stiff one needs: its pressure on a cell changes wholly with
    /// some 1e-4 mm. Surrogates and rigid tools know none.
    double recession = 0.0;
    double tolerance = 1e-4;   ///< relative error of the pressure field, L1
    int max_iterations = 500;  ///< then it has not converged
    RunContext context;        ///< looked at in each iteration

    /// Throws InputError on arrays of another size than the grid's, NaN, or a negative force.
    void validate(const ContactGrid& grid) const;
};

/// What a contact is solved to.
struct ContactSolution {
    Eigen::ArrayXd pressure;     ///< MPa per cell
    double force = 0.0;          ///< N, sum of pressure x coverage x cell area
    double approach = 0.0;       ///< mm, delta; what the robot gave way is not in it
    double area = 0.0;           ///< mm2 of cells with pressure, coverage counted
    double peak_pressure = 0.0;  ///< MPa, greatest mean over 1 mm2 (a cell, where that is larger)
    int iterations = 0;          ///< done
    bool converged = false;      ///< to the tolerance asked for
    /// mm that the wheel's surface moves along y, at the borders of the rows: (nx, ny + 1), from
    /// the outermost one at -y to that at +y. Empty: it does not, or the model does not know.
    Eigen::ArrayXXd axial;
};

/// How a grid's cells give way at an edge of the workpiece: kappa, mm per MPa on a whole cell, of
/// lines along and across the wheel, of which a line load sinks in by kappa ln(1 / distance in
/// cells), but for a constant. 0: each place for itself, or not known.
struct EdgeSoftness {
    double along = 0.0;   ///< of lines along the circumference
    double across = 0.0;  ///< of lines along the axis
};

/// What a prepared contact knows of its last solution beyond that.
class ContactMemory {
  public:
    virtual ~ContactMemory() = default;
    ContactMemory(const ContactMemory&) = delete;
    ContactMemory& operator=(const ContactMemory&) = delete;
    /// Of memory, about.
    virtual std::size_t bytes() const = 0;

  protected:
    ContactMemory() = default;
};

/// A contact model on one grid, with the work space to solve there: one thread at a time. It needs
/// the model that prepared it no longer.
class PreparedContact {
  public:
    virtual ~PreparedContact() = default;
    PreparedContact(const PreparedContact&) = delete;
    PreparedContact& operator=(const PreparedContact&) = delete;

    /// The grid that it was prepared for.
    const ContactGrid& grid() const { return grid_; }
    /// Name and parameters of the model as it is used here, for the report.
    const std::string& describe() const { return description_; }
    /// `start`, if not null, is a pressure (MPa per cell) to start from. Throws InputError for a
    /// problem that is invalid, or not of this grid; Cancelled, after which it can solve anew.
    ContactSolution solve(const ContactProblem& problem, const Eigen::ArrayXd* start = nullptr);
    /// How its cells give way at edges.
    virtual EdgeSoftness edge_softness() const { return {}; }
    /// For another one, of the same model and grid, to go on from to the last bit. Null: the
    /// pressure is all.
    virtual std::shared_ptr<const ContactMemory> memory() const { return nullptr; }
    /// Goes on from what another one remembered.
    virtual void remember(const std::shared_ptr<const ContactMemory>&) {}

  protected:
    /// Throws InputError for an invalid grid.
    PreparedContact(const ContactGrid& grid, std::string description);

  private:
    /// The problem and the start are of this grid.
    virtual ContactSolution do_solve(const ContactProblem& problem,
                                     const Eigen::ArrayXd* start) = 0;

    ContactGrid grid_;
    std::string description_;
};

/// What a wheel does when it is pressed on a surface: an elasticity to solve the contact with
/// (ElasticModel), a prediction learnt from solved contacts (Surrogate), or a rigid tool. It does
/// not change: contacts are solved by what it prepares, on one grid each.
class ContactModel {
  public:
    virtual ~ContactModel() = default;

    /// The model on a grid. What depends on the cells is kept, so that another number of cells
    /// along the circumference is prepared quickly. Safe from several threads. Throws InputError
    /// for an invalid grid.
    std::unique_ptr<PreparedContact> prepare(const ContactGrid& grid) const;
    /// True if there is no elasticity at all: no pressure can be solved for, and the tool's
    /// envelope is what remains.
    virtual bool rigid() const { return false; }
    /// mm of what is elastic between the work and a rigid core: no contact can be deeper. Infinite:
    /// the model knows of no core.
    virtual double thickness() const { return std::numeric_limits<double>::infinity(); }
    /// mm beyond the tool's side faces where it may bear pressure under load.
    virtual double beside() const { return 0.0; }
    /// Name and parameters, for the report.
    virtual std::string describe() const = 0;

  private:
    virtual std::unique_ptr<PreparedContact> do_prepare(const ContactGrid& grid) const = 0;
};

/// A rigid tool that cuts all that its envelope meets, as a milling cutter does (Jerard et al., The
/// Visual Computer 5, 1989). Under position control only; there is no pressure and no force.
class Geometric final : public ContactModel {
  public:
    bool rigid() const override { return true; }
    std::string describe() const override { return "geometric: rigid envelope of the tool"; }

  private:
    std::unique_ptr<PreparedContact> do_prepare(const ContactGrid& grid) const override;
};

}  // namespace beltgrinding

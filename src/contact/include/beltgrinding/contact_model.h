#pragma once

#include <Eigen/Core>
#include <string>

namespace beltgrinding {

/// The wheel's own regular grid: nx cells along the circumference (arc length s, contact frame's x
/// at the contact) by ny along the axis. Cell (i, j) has index j * nx + i and its centre at
/// s = (i - (nx - 1) / 2) ds, y = (j - (ny - 1) / 2) dy.
struct ContactGrid {
    int nx = 0;
    int ny = 0;
    double ds = 1.0;  ///< mm
    double dy = 1.0;  ///< mm

    int cells() const { return nx * ny; }
    double cell_area() const { return ds * dy; }
    double s(int i) const { return (i - 0.5 * (nx - 1)) * ds; }
    double y(int j) const { return (j - 0.5 * (ny - 1)) * dy; }
    bool operator==(const ContactGrid&) const = default;
};

/// The unilateral (Signorini) contact of the wheel with a rigid surface on the wheel's grid:
/// find p >= 0 with g + u(p) - delta >= 0 and p (g + u - delta) = 0, u the displacement of the
/// wheel's surface under p.
struct ContactProblem {
    ContactGrid grid;
    Eigen::ArrayXd gap;       ///< mm, undeformed wheel to surface, per cell; +inf: nothing there
    Eigen::ArrayXd coverage;  ///< share of the cell that the workpiece covers, [0, 1]
    bool force_control = true;
    double force = 0.0;     ///< N, commanded (force control)
    double approach = 0.0;  ///< mm, commanded (position control)
    /// mm/N by which the robot gives way under the contact's force (position control); 0: rigid
    double robot_compliance = 0.0;
    double tolerance = 1e-4;  ///< relative error of the pressure field, L1
    int max_iterations = 500;

    /// Throws InputError on arrays of the wrong size, NaN, or a negative force.
    void validate() const;
};

struct ContactSolution {
    Eigen::ArrayXd pressure;     ///< MPa per cell
    double force = 0.0;          ///< N, sum of pressure x coverage x cell area
    double approach = 0.0;       ///< mm, delta; what the robot gave way is not in it
    double area = 0.0;           ///< mm2 of cells with pressure, coverage counted
    double peak_pressure = 0.0;  ///< MPa
    int iterations = 0;
    bool converged = false;
};

/// What a wheel does when it is pressed on a surface: an elasticity to solve the contact with
/// (ComplianceOperator), a prediction learnt from solved contacts (Surrogate), or a rigid tool.
class ContactModel {
  public:
    virtual ~ContactModel() = default;

    /// Fits the model to a grid; cheap if the grid is the one of the last call.
    virtual void set_grid(const ContactGrid& grid) = 0;
    /// Solves on the grid set last. `start`, if not null and of the right size, is a pressure to
    /// start from. Throws InputError for a problem that is none.
    virtual ContactSolution solve(const ContactProblem& problem,
                                  const Eigen::ArrayXd* start = nullptr) const = 0;
    /// True if there is no elasticity at all: no pressure can be solved for, and the tool's
    /// envelope is what remains.
    virtual bool rigid() const { return false; }
    /// Name and parameters, for the report.
    virtual std::string describe() const = 0;
};

/// A rigid tool that cuts all that its envelope meets, as a milling cutter does (Jerard et al., The
/// Visual Computer 5, 1989). Under position control only; there is no pressure and no force.
class Geometric final : public ContactModel {
  public:
    void set_grid(const ContactGrid&) override {}
    ContactSolution solve(const ContactProblem& problem, const Eigen::ArrayXd*) const override;
    bool rigid() const override { return true; }
    std::string describe() const override { return "geometric: rigid envelope of the tool"; }
};

}  // namespace beltgrinding

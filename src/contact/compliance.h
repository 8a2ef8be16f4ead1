#pragma once

#include <Eigen/Core>
#include <memory>
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

/// Elasticity of the wheel: maps the pressure on the grid's cells to the displacement of its
/// surface into the wheel. Symmetric and positive definite in the inner product weighted by
/// `coverage`.
class ComplianceOperator {
  public:
    virtual ~ComplianceOperator() = default;

    /// Fits the operator to a grid; cheap if the grid is the one of the last call.
    virtual void set_grid(const ContactGrid& grid) = 0;
    /// displacement (mm, into the wheel) = C(coverage * pressure). Arrays of grid.cells();
    /// pressure in MPa; coverage: share of the cell that the workpiece covers, in [0, 1].
    virtual void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
                       Eigen::ArrayXd& displacement) const = 0;
    /// An estimate of the diagonal of C at full coverage, mm/MPa: scales the solver's first step.
    virtual double diagonal() const = 0;
    /// True if a cell's displacement depends on its own pressure only.
    virtual bool local() const { return false; }
    /// True if there is no elasticity at all: no pressure can be solved for, and the tool's
    /// envelope is what remains.
    virtual bool rigid() const { return false; }
    /// Name and parameters, for the report.
    virtual std::string describe() const = 0;
};

/// A rigid tool that cuts all that its envelope meets, as a milling cutter does (Jerard et al., The
/// Visual Computer 5, 1989). Under position control only; there is no pressure and no force.
class Geometric final : public ComplianceOperator {
  public:
    void set_grid(const ContactGrid&) override {}
    void apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd&,
               Eigen::ArrayXd& displacement) const override {
        displacement = 0.0 * pressure;
    }
    double diagonal() const override { return 1.0; }
    bool local() const override { return true; }
    bool rigid() const override { return true; }
    std::string describe() const override { return "geometric: rigid envelope of the tool"; }
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

#pragma once

#include <array>
#include <complex>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "convolution.h"
#include "elastic/compliance.h"
#include "elastic/rim_section.h"
#include "elastic/wheel_rim.h"

namespace beltgrinding {

/// The rows that are transformed: the even combinations of cells and the axial load outwards, then
/// the odd ones and the axial load towards +y.
class RimOperator final : public ComplianceOperator {
  public:
    using Spectra = std::function<std::shared_ptr<const WheelRim::Spectrum>(int length)>;
    /// `spectra`: by the length of the padded grid along the circumference; `modes`: outwards,
    /// towards +y; `bulges`: the rubber is free to move along the axis.
    RimOperator(const ContactGrid& grid, std::string description, Spectra spectra,
                const std::array<SideMode, 2>& modes, bool bulges)
        : ComplianceOperator(grid, std::move(description)),
          spectra_(std::move(spectra)),
          bulges_(bulges) {
        RimOperator::do_work_on_columns();
        for (std::size_t m = 0; m < 2; ++m) {
            for (int j = 0; j < grid.ny; ++j) cells_[m].push_back(modes[m].at(grid.y(j)));
            for (int j = 0; j <= grid.ny; ++j)
                borders_[m].push_back(modes[m].at((j - 0.5 * grid.ny) * grid.dy));
        }
    }
    double diagonal() const override { return plan_->spectrum->diagonal; }
    void set_surface(const ContactProblem& problem) override;
    void clear_surface() override { sloped_ = false; }

  private:
    using Rows = Eigen::Map<Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic>>;
    /// What a number of columns needs.
    struct Plan {
        std::shared_ptr<const WheelRim::Spectrum> spectrum;
        RowTransform transform;
        std::vector<float> values;
        std::vector<std::complex<float>> waves, image;
    };

    bool by_columns() const override { return true; }
    void do_work_on_columns() override;
    void do_apply(const Eigen::ArrayXd& pressure, Eigen::ArrayXd& displacement) override;
    Eigen::ArrayXXd side_displacement(const Eigen::ArrayXd& pressure) override;

    /// Transforms what presses on the rim: along the radius, and along the axis by the slopes.
    void forward(const Eigen::ArrayXd& pressure);
    /// A column is a row.
    Rows parts() { return {plan_->values.data(), working().nx, grid().ny + 2}; }
    int even() const { return (grid().ny + 1) / 2; }
    int odd() const { return grid().ny / 2; }
    /// Visits (up, down, number of the even combination, of the odd one) of each pair of cells from
    /// the middle outwards; up is down in the middle, which has no odd one.
    template <class Visit>
    void for_pairs(Visit visit) const {
        for (int a = 0; a < even(); ++a) {
            const int up = grid().ny / 2 + a;
            visit(up, grid().ny - 1 - up, a, even() + 1 + a - grid().ny % 2);
        }
    }

    Spectra spectra_;
    std::map<int, Plan> plans_;
    Plan* plan_ = nullptr;
    std::array<std::vector<double>, 2> cells_, borders_;  // the modes at the rows, at their borders
    bool bulges_, sloped_ = false;
    Eigen::ArrayXd applied_;                // to the whole grid the last time
    std::array<Eigen::ArrayXd, 2> moved_;   // along the axis by that: the modes along the wheel
    std::array<Eigen::ArrayXd, 2> slopes_;  // of the gap along y, mm/mm, times the modes
};

}  // namespace beltgrinding

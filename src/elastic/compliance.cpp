#include "elastic/compliance.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "beltgrinding/error.h"
#include "contact/fit.h"

namespace beltgrinding {
namespace {

constexpr double kLayerStep = 0.5;  // cells: a greater step from row to row leads to another layer

class FoundationOperator final : public ComplianceOperator {
  public:
    FoundationOperator(const ContactGrid& grid, std::string description, double stiffness)
        : ComplianceOperator(grid, std::move(description)), stiffness_(stiffness) {}
    double diagonal() const override { return 1.0 / stiffness_; }
    bool local() const override { return true; }

  private:
    void do_apply(const Eigen::ArrayXd& pressure, Eigen::ArrayXd& displacement) override {
        displacement = pressure / stiffness_;
    }

    double stiffness_;
};

}  // namespace

Eigen::ArrayXd axial_slopes(const ContactGrid& grid, const ContactProblem& problem) {
    const Eigen::ArrayXd &gap = problem.gap, &coverage = problem.coverage;
    const int nx = grid.nx, ny = grid.ny;
    Eigen::ArrayXd slopes = Eigen::ArrayXd::Zero(grid.cells());
    // Of the step from row j - 1 to row j: what it rises, and whether it counts.
    Eigen::ArrayXd rise = Eigen::ArrayXd::Zero(nx), counts = Eigen::ArrayXd::Zero(nx);
    const double most = kLayerStep * grid.dy;
    for (int j = 0; j < ny; ++j) {
        const Eigen::ArrayXd rise_before = rise, counts_before = counts;
        rise.setZero();
        counts.setZero();
        const bool profiled = problem.drop.size() == ny && j + 1 < ny;
        const double own = profiled ? problem.drop[j + 1] - problem.drop[j] : 0.0;
        for (int i = 0; i < nx && j + 1 < ny; ++i) {
            const int from = j * nx + i, to = from + nx;
            const double step =
                gap[to] - gap[from] - own;  // infinite, or no number: nothing is there
            if (!(std::abs(step) <= most) || coverage[from] != 1.0 || coverage[to] != 1.0) continue;
            rise[i] = step;
            counts[i] = 1.0;
        }
        slopes.segment(j * nx, nx) =
            (rise + rise_before) / ((counts + counts_before).max(1.0) * grid.dy);
    }
    return slopes;
}

void ComplianceOperator::apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
                               Eigen::ArrayXd& displacement) {
    const Eigen::Index cells = working_.cells();
    if (pressure.size() != cells || coverage.size() != cells) {
        throw std::invalid_argument(
            "compliance: pressure and coverage must have one value per cell of the operator's "
            "grid");
    }
    set_coverage(coverage);
    apply_covered(pressure, coverage, displacement);
}

void ComplianceOperator::apply_covered(const Eigen::ArrayXd& pressure,
                                       const Eigen::ArrayXd& coverage,
                                       Eigen::ArrayXd& displacement) {
    fit(displacement, working_.cells());
    if (local()) {
        do_apply(pressure, displacement);  // of the part that is covered: a spring to each point
        if (recession_ > 0.0) displacement += recession_ * pressure;
        return;
    }
    fit(load_, working_.cells());
    load_ = coverage * pressure;
    edges_.place(load_);
    do_apply(load_, displacement);
    edges_.sink(displacement);
    if (recession_ > 0.0) displacement += recession_ * pressure;
}

void ComplianceOperator::work_on_columns(int count) {
    if (working_.nx == count) return;
    const int before = std::exchange(working_.nx, count);
    try {
        do_work_on_columns();
    } catch (...) {
        working_.nx = before;
        throw;
    }
}

EdgeSoftness ComplianceOperator::find_edge_softness() {
    Eigen::ArrayXd pressure(grid().cells()), displacement(grid().cells());
    const auto kappa = [&](int line, int step, int count, int stride) {
        if (count < 2) return 0.0;
        const int middle = count / 2, beside = middle - 1;
        pressure.setZero();
        for (int k = 0; k < line; ++k) pressure[middle * stride + k * step] = 1.0;
        do_apply(pressure, displacement);
        const int half = line / 2 * step;
        return (displacement[middle * stride + half] - displacement[beside * stride + half]) /
               kLineOverBeside;
    };
    const double along = kappa(grid().nx, 1, grid().ny, grid().nx);
    const double across = kappa(grid().ny, grid().nx, grid().nx, 1);
    return {std::max(along, 0.0), std::max(across, 0.0)};
}

std::unique_ptr<ComplianceOperator> ElasticModel::compliance(const ContactGrid& grid) const {
    grid.validate();
    auto prepared = make_operator(grid);
    if (!prepared->local()) {
        prepared->edges_ = EdgeLoads(
            *edge_softness_.get(grid, grid.nx, [&] { return prepared->find_edge_softness(); }));
    }
    return prepared;
}

std::unique_ptr<PreparedContact> ElasticModel::do_prepare(const ContactGrid& grid) const {
    return compliance(grid);
}

ElasticFoundation::ElasticFoundation(double stiffness) : stiffness_(stiffness) {
    if (!std::isfinite(stiffness) || stiffness <= 0.0) {
        throw InputError(
            "contact.foundation",
            "elastic foundation: stiffness is {stiffness:f} MPa/mm; give a positive one",
            {{"stiffness", stiffness}});
    }
}

std::unique_ptr<ComplianceOperator> ElasticFoundation::make_operator(
    const ContactGrid& grid) const {
    return std::make_unique<FoundationOperator>(grid, describe(), stiffness_);
}

std::string ElasticFoundation::describe() const {
    std::ostringstream text;
    text << "elastic foundation (Winkler), " << stiffness_ << " MPa/mm";
    return text.str();
}

}  // namespace beltgrinding

#include "contact/compliance.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

class FoundationOperator final : public ComplianceOperator {
  public:
    FoundationOperator(const ContactGrid& grid, std::string description, double stiffness)
        : ComplianceOperator(grid, std::move(description)), stiffness_(stiffness) {}
    double diagonal() const override { return 1.0 / stiffness_; }
    bool local() const override { return true; }

  private:
    void do_apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd&,
                  Eigen::ArrayXd& displacement) override {
        displacement = pressure / stiffness_;
    }

    double stiffness_;
};

}  // namespace

void ComplianceOperator::apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd& coverage,
                               Eigen::ArrayXd& displacement) {
    const Eigen::Index cells = grid().cells();
    if (pressure.size() != cells || coverage.size() != cells) {
        throw std::invalid_argument(
            "compliance: pressure and coverage must have one value per cell of the operator's "
            "grid");
    }
    displacement.resize(cells);
    do_apply(pressure, coverage, displacement);
}

std::unique_ptr<ComplianceOperator> ElasticModel::compliance(const ContactGrid& grid) const {
    grid.validate();
    return make_operator(grid);
}

std::unique_ptr<PreparedContact> ElasticModel::do_prepare(const ContactGrid& grid) const {
    return make_operator(grid);
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

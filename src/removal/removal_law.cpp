#include "removal/removal_law.h"

#include <cmath>
#include <sstream>

#include "base/error.h"

namespace beltgrinding {
namespace {

double checked(double coefficient) {
    if (!std::isfinite(coefficient) || coefficient < 0.0) {
        throw InputError("removal law: the coefficient is " + std::to_string(coefficient) +
                         " mm2/N; give zero or a positive one");
    }
    return coefficient;
}

std::string text(const char* name, double coefficient) {
    std::ostringstream out;
    out << name << ", K = " << coefficient << " mm2/N";
    return out.str();
}

}  // namespace

LocalLinearLaw::LocalLinearLaw(double coefficient) : coefficient_(checked(coefficient)) {}

void LocalLinearLaw::rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
                          Eigen::ArrayXd& rate) const {
    rate = coefficient_ * state.belt_wear * state.belt_speed * pressure;
}

std::string LocalLinearLaw::describe() const {
    return text("local linear law", coefficient_);
}

HammannLaw::HammannLaw(double coefficient) : coefficient_(checked(coefficient)) {}

void HammannLaw::rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
                      Eigen::ArrayXd& rate) const {
    const double mean = state.contact_area > 0.0 ? state.force / state.contact_area : 0.0;
    const double everywhere = coefficient_ * state.belt_wear * state.belt_speed * mean;
    rate = (pressure > 0.0).select(Eigen::ArrayXd::Constant(pressure.size(), everywhere), 0.0);
}

std::string HammannLaw::describe() const {
    return text("Hammann's global law", coefficient_);
}

double hammann_depth(double coefficient, double wear, double belt_speed, double force, double feed,
                     double contact_width) {
    return coefficient * wear * belt_speed * force / (feed * contact_width);
}

}  // namespace beltgrinding

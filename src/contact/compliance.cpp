#include "beltgrinding/compliance.h"

#include <cmath>
#include <sstream>

#include "beltgrinding/error.h"

namespace beltgrinding {

ElasticFoundation::ElasticFoundation(double stiffness) : stiffness_(stiffness) {
    if (!std::isfinite(stiffness) || stiffness <= 0.0) {
        throw InputError("elastic foundation: stiffness is " + std::to_string(stiffness) +
                         " MPa/mm; give a positive one");
    }
}

void ElasticFoundation::apply(const Eigen::ArrayXd& pressure, const Eigen::ArrayXd&,
                              Eigen::ArrayXd& displacement) const {
    displacement = pressure / stiffness_;
}

std::string ElasticFoundation::describe() const {
    std::ostringstream text;
    text << "elastic foundation (Winkler), " << stiffness_ << " MPa/mm";
    return text.str();
}

}  // namespace beltgrinding

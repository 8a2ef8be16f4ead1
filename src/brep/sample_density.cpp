#include "sample_density.h"

#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"

namespace beltgrinding {

double SampleDensity::least() const {
    return std::min(spacing, finest > 0 ? finest : kFinestShare * spacing);
}

double SampleDensity::at(double curvature) const {
    const double bend = std::abs(curvature);
    if (!(bend > 0)) return spacing;
    const double wanted = precision > 0 ? std::sqrt(8 * precision / bend) : kTurn / bend;
    return std::clamp(wanted, least(), spacing);
}

void SampleBudget::take(std::size_t count) {
    if (limit == 0 || taken.fetch_add(count) + count <= limit) return;
    throw InputError("brep.too_dense",
                     "so fine a precision on its curved places needs more than the {limit} samples "
                     "that memory allows; take a larger precision, or a larger spacing at edges",
                     {{"limit", limit}});
}

}  // namespace beltgrinding

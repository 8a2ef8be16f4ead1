#pragma once

namespace beltgrinding {

/// Share of Student's t with `freedom` degrees of freedom (above 0; infinite: the normal
/// distribution) that lies below `t`, by the incomplete beta function's continued fraction (Lentz;
/// Abramowitz and Stegun 26.5.8, 26.7.1); to 1e-12. Throws InputError for another freedom.
double student_distribution(double t, double freedom);

/// The t below which `share` lies, 0 < share < 1. Throws InputError.
double student_quantile(double share, double freedom);

}  // namespace beltgrinding

#pragma once

#include <Eigen/Core>
#include <limits>

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// The pressure of a contact where it acts. A solution has it on the cells of the undeformed wheel;
/// under load the rubber has moved along the axis (`ContactSolution::axial`), beyond the wheel's
/// side faces as well.
struct DisplacedPressure {
    Eigen::ArrayXd pressure;  ///< MPa, one value per cell
    /// Beyond the side face at -y, then that at +y: MPa, one value per column; empty: nothing is.
    Eigen::ArrayXd beside;
    /// mm beyond the side face to which that acts, 0 or more; of the same size.
    Eigen::ArrayXd reach;

    /// mm, the longest reach; 0 where nothing is.
    double longest() const { return reach.size() > 0 ? reach.maxCoeff() : 0.0; }
};

/// Spreads the force of every cell evenly over where its borders have moved to. Nothing moves at an
/// edge of the workpiece, past which the rubber slides, nor beyond one. Beyond the sides it is put
/// within `most` mm. The force stays as it is.
DisplacedPressure displaced(const ContactGrid& grid, const ContactSolution& solution,
                            const Eigen::ArrayXd& coverage,
                            double most = std::numeric_limits<double>::infinity());

}  // namespace beltgrinding

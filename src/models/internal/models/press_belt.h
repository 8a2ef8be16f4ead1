#pragma once

#include "beltgrinding/belt_machine.h"
#include "models/single_contact.h"

namespace beltgrinding {

/// A free belt or a platen on a part that is curved alike everywhere: two circles, added.
struct PressedBelt {
    BeltMachine machine;
    double first = 0.0;   ///< 1/mm, curvature along the direction at `angle`; positive: convex
    double second = 0.0;  ///< 1/mm, square to it
    double angle = 0.0;   ///< rad about z, from the belt's travel
    bool force_control = true;
    double force = 20.0;      ///< N
    double approach = 0.0;    ///< mm beyond the flat belt that touches
    double tolerance = 1e-3;  ///< relative error of the pressure field, L1
};

/// Solves it on a grid over the belt's width that is as long as the contact needs, the whole run at
/// most. The gap is that to the flat belt. Throws InputError.
SingleContactResult press(const PressedBelt& pressed);

}  // namespace beltgrinding

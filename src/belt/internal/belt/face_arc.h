#pragma once

#include "beltgrinding/belt_machine.h"
#include "contact/belt_arc.h"

namespace beltgrinding {

/// The belt's outer face, which meets the work. Of a free belt and a flat platen: straight.
BeltArc face_arc(const BeltMachine& machine);
/// The belt's middle surface.
BeltArc middle_arc(const AbrasiveBelt& belt, const Platen& platen);

}  // namespace beltgrinding

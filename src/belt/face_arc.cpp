#include "belt/face_arc.h"

namespace beltgrinding {
namespace {

BeltArc arc_at(const Platen& platen, double above) {
    if (platen.radius == 0.0) return {};
    return {platen.radius + above, platen.end_angle()};
}

}  // namespace

BeltArc face_arc(const BeltMachine& machine) {
    if (machine.kind != BeltMachine::Kind::kPlaten) return {};
    return arc_at(machine.platen, machine.belt.thickness);
}

BeltArc middle_arc(const AbrasiveBelt& belt, const Platen& platen) {
    return arc_at(platen, 0.5 * belt.thickness);
}

}  // namespace beltgrinding

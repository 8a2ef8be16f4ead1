#include "beltgrinding/belt_machine.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "belt/face_arc.h"
#include "belt/free_belt.h"
#include "belt/platen.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// Of a curved platen's ends: the work is mapped as heights over a plane.
constexpr double kSteepest = std::numbers::pi / 3.0;  // rad

void need_positive(double value, const char* code, const char* form) {
    if (!std::isfinite(value) || value <= 0.0) throw InputError(code, form, {{"value", value}});
}

void need_not_negative(double value, const char* code, const char* form) {
    if (!std::isfinite(value) || value < 0.0) throw InputError(code, form, {{"value", value}});
}

}  // namespace

double AbrasiveBelt::bending() const {
    return membrane() * thickness * thickness / (12.0 * (1.0 - poissons_ratio * poissons_ratio));
}

double AbrasiveBelt::face() const {
    return surface_stiffness > 0.0 ? surface_stiffness : youngs_modulus / thickness;
}

void AbrasiveBelt::validate() const {
    need_positive(width, "belt.width", "belt: the width is {value:f} mm; give a positive one");
    need_positive(thickness, "belt.thickness",
                  "belt: the thickness is {value:f} mm; give a positive one");
    need_positive(youngs_modulus, "belt.youngs_modulus",
                  "belt: Young's modulus is {value:f} MPa; give a positive one");
    if (!(poissons_ratio >= 0.0) || !(poissons_ratio < 0.5)) {
        throw InputError("belt.poissons_ratio",
                         "belt: Poisson's ratio is {value:f}; give one from 0 to below 0.5",
                         {{"value", poissons_ratio}});
    }
    need_positive(tension, "belt.tension",
                  "belt: the tension is {value:f} N/mm; give a positive one");
    need_not_negative(
        surface_stiffness, "belt.surface_stiffness",
        "belt: the surface's stiffness is {value:f} MPa/mm; give a positive one, or 0");
}

void BeltRun::validate() const {
    need_positive(length, "belt.length",
                  "belt: {value:f} mm lie between its rollers; give a positive length");
    if (!(std::abs(position) < 0.5 * length)) {
        throw InputError("belt.position",
                         "belt: {value:f} mm from the middle, the contact lies not between the "
                         "rollers, which are {length:f} mm apart",
                         {{"value", position}, {"length", length}});
    }
}

double Platen::end_angle() const {
    return radius > 0.0 ? std::asin(0.5 * length / radius) : 0.0;
}

void Platen::validate() const {
    need_positive(length, "platen.length",
                  "platen: the length is {value:f} mm; give a positive one");
    need_not_negative(radius, "platen.radius",
                      "platen: the radius is {value:f} mm; give a positive one, or 0 for a flat "
                      "platen");
    if (radius > 0.0) {
        const double least = 0.5 * length / std::sin(kSteepest);
        if (!(radius >= least)) {
            throw InputError("platen.turns_too_far",
                             "platen: {length:f} mm long with a radius of {radius:f} mm, it turns "
                             "by more than 60 degrees to its ends; give a radius of at least "
                             "{least:f} mm",
                             {{"length", length}, {"radius", radius}, {"least", least}});
        }
        double thick = 0.0;
        for (const auto& layer : layers) thick += layer.thickness;
        if (!(thick < radius)) {
            throw InputError("platen.layers_beyond_middle",
                             "platen: its layers are {thickness:f} mm thick and reach beyond the "
                             "middle of its radius of {radius:f} mm",
                             {{"thickness", thick}, {"radius", radius}});
        }
    }
    need_not_negative(
        layer_surface_stiffness, "platen.surface_stiffness",
        "platen: the surface's stiffness is {value:f} MPa/mm; give a positive one, or 0");
}

void BeltMachine::validate() const {
    if (!free_face()) return;
    belt.validate();
    run.validate();
    if (kind != Kind::kPlaten) return;
    platen.validate();
    const BeltArc bent = middle_arc(belt, platen);
    const double along = bent.flat() ? platen.length : 2.0 * bent.half_length();
    if (along + 2.0 * std::abs(run.position) > run.length) {
        throw InputError("platen.beyond_rollers",
                         "platen: {platen:f} mm long, {position:f} mm from the middle, it does not "
                         "lie between the rollers, which are {length:f} mm apart",
                         {{"platen", along}, {"position", run.position}, {"length", run.length}});
    }
}

std::unique_ptr<ContactModel> make_belt_contact(const BeltMachine& machine) {
    switch (machine.kind) {
        case BeltMachine::Kind::kFreeBelt:
            return std::make_unique<FreeBelt>(machine.belt, machine.run);
        case BeltMachine::Kind::kPlaten:
            return std::make_unique<PlatenBelt>(machine.belt, machine.run, machine.platen);
        case BeltMachine::Kind::kContactWheel:
        case BeltMachine::Kind::kSmallWheel:
            break;
    }
    throw std::invalid_argument("make_belt_contact: the machine is a wheel");
}

}  // namespace beltgrinding

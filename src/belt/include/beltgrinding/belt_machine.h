#pragma once

#include <memory>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/rubber_layer.h"

namespace beltgrinding {

/// An abrasive belt as a thin plate. The defaults are those of a cloth belt of 1 mm.
struct AbrasiveBelt {
    double width = 50.0;            ///< mm
    double thickness = 1.0;         ///< mm
    double youngs_modulus = 300.0;  ///< MPa
    double poissons_ratio = 0.3;    ///< below 0.5
    double tension = 4.0;           ///< N per mm of width, of the belt that touches nothing
    /// MPa/mm by which the belt's face (grains, size coat) gives way under pressure; 0: as the
    /// belt's own thickness does, E / t.
    double surface_stiffness = 0.0;

    /// Bending stiffness E t^3 / (12 (1 - nu^2)), N mm.
    double bending() const;
    /// Stiffness in its plane, E t, N/mm.
    double membrane() const { return youngs_modulus * thickness; }
    /// `surface_stiffness`, or what stands for it, MPa/mm.
    double face() const;
    /// Throws InputError naming the invalid value.
    void validate() const;
};

/// Where the belt runs free: between two rollers, whose lines of contact hold it as hinges.
struct BeltRun {
    /// fixed: the rollers stay, and the belt's stretch adds to the tension; tensioned: the
    /// horizontal pull stays what the belt's tension is, and the rollers move towards each other so
    /// that the belt between them keeps its length.
    enum class Rollers { kFixed, kTensioned };

    double length = 200.0;  ///< mm between the rollers
    /// mm along the belt from the middle between the rollers to the origin of the contact frame.
    double position = 0.0;
    Rollers rollers = Rollers::kFixed;  ///< what the pull comes from

    /// Throws InputError unless the origin lies between the rollers.
    void validate() const;
};

/// A plate with elastic layers under the belt, flat or convex towards the work.
struct Platen {
    double length = 120.0;  ///< mm along the travel, its middle at the origin; of a curved one, the
                            ///< straight way from end to end of the face that the belt slides on
    /// mm, of that face, bent along the travel; 0: flat. The belt lies round all of it and leaves
    /// it along its tangents, so that its tension presses N / R on it before there is work.
    double radius = 0.0;
    /// From the plate outwards; empty: the plate itself is in touch with the belt.
    std::vector<RubberLayer> layers;
    double layer_surface_stiffness = 0.0;  ///< MPa/mm between belt and layer; 0: none gives way

    /// rad that the face has turned by at its ends; 0 of a flat one.
    double end_angle() const;
    /// Throws InputError naming the invalid value.
    void validate() const;
};

/// A belt machine as far as its contact goes: what presses the belt on the part.
struct BeltMachine {
    /// What presses: a wheel with the belt round it, the belt itself between two rollers, a plate
    /// behind it, a wheel in a fork.
    enum class Kind { kContactWheel, kFreeBelt, kPlaten, kSmallWheel };

    Kind kind = Kind::kContactWheel;  ///< which of them
    AbrasiveBelt belt;                ///< free belt, platen
    BeltRun run;                      ///< free belt, platen: its rollers
    Platen platen;                    ///< platen

    /// The belt is not wrapped round a wheel where it is pressed: a free belt, a platen.
    bool free_face() const { return kind == Kind::kFreeBelt || kind == Kind::kPlaten; }
    /// Throws InputError naming the value that is invalid; of wheels, nothing is looked at.
    void validate() const;
};

/// The contact model of a free belt or a platen. The gap of its problems is that to the flat belt
/// which touches nothing: mm from the plane of the belt's face to the surface, z into the work, on
/// a regular grid over x (along the belt) and y. Pressures are forces a projected area, along z.
/// Throws InputError for invalid parameters, std::invalid_argument for the kinds that are
/// wheels (`make_contact_model`).
std::unique_ptr<ContactModel> make_belt_contact(const BeltMachine& machine);

}  // namespace beltgrinding

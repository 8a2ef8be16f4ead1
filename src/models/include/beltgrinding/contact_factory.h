#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/rubber_layer.h"

namespace beltgrinding {

struct TrainedRegression;

/// What a contact model is made of, by its name. What a model does not use is ignored.
struct ContactModelParameters {
    using Layer = RubberLayer;  ///< one rubber of a rim

    /// wheel_rim: a rim of finite width on a rigid core, with the belt on it;
    /// bonded_layer: a layer of infinite width; half_space: of infinite thickness, too;
    /// elastic_foundation: every place gives way for itself; geometric: a rigid tool, which cuts
    /// all that it meets; surrogate: learnt from solved contacts.
    std::string model = "wheel_rim";
    double youngs_modulus = 5.0;   ///< MPa, of the rubber
    double poissons_ratio = 0.45;  ///< of the rubber
    double rim_thickness = 15.0;   ///< mm
    /// wheel_rim: the rubbers from the core outwards, in place of the three above; empty: these.
    std::vector<Layer> layers = {};
    double belt_tension = 0.0;  ///< wheel_rim: N per mm of width
    double belt_bending = 0.0;  ///< wheel_rim: bending stiffness of the belt, N mm
    /// wheel_rim: where the solved rim, which takes seconds, is kept for the next time; empty:
    /// nowhere.
    std::filesystem::path cache_folder = {};
    /// elastic_foundation: MPa/mm; 0: that under which a plane gives the approach of the wheel rim.
    double stiffness = 0.0;
    double cell = 1.0;               ///< surrogate: mm, cell that it was trained on
    std::string name = "surrogate";  ///< surrogate: for the report
    std::shared_ptr<const TrainedRegression> regression = {};  ///< surrogate: what was learnt
};

/// The contact model for `wheel`. `force` (N), about which it will be pressed, is used by an
/// elastic foundation without a stiffness only. Throws InputError for another name, or
/// invalid parameters.
std::unique_ptr<ContactModel> make_contact_model(const ContactModelParameters& parameters,
                                                 const ContactWheel& wheel, double force);

}  // namespace beltgrinding

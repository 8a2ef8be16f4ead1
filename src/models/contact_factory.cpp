#include "beltgrinding/contact_factory.h"

#include "beltgrinding/error.h"
#include "elastic/half_space.h"
#include "elastic/wheel_rim.h"
#include "models/single_contact.h"
#include "surrogate/regression.h"
#include "surrogate/surrogate.h"

namespace beltgrinding {
namespace {

constexpr int kDrops = 65;  // at which a profile is sampled, from the middle to the side

WheelRimDesign rim_of(const ContactModelParameters& p, const ContactWheel& wheel) {
    WheelRimDesign design;
    design.outer_radius = wheel.radius;
    design.width = wheel.width;
    for (const auto& layer : p.layers)
        design.layers.push_back({layer.thickness, {layer.youngs_modulus, layer.poissons_ratio}});
    if (design.layers.empty())
        design.layers = {{p.rim_thickness, {p.youngs_modulus, p.poissons_ratio}}};
    if (wheel.crown_radius > 0.0 || !wheel.profile.empty()) {
        wheel.validate();
        for (int k = 0; k < kDrops; ++k) {
            const double y = 0.5 * wheel.width * k / (kDrops - 1);
            design.drop.push_back(0.5 * (wheel.drop(y) + wheel.drop(-y)));
        }
    }
    return design;
}

}  // namespace

std::unique_ptr<ContactModel> make_contact_model(const ContactModelParameters& p,
                                                 const ContactWheel& wheel, double force) {
    const Elasticity elasticity{p.youngs_modulus, p.poissons_ratio};
    const BeltPlate belt{p.belt_tension, p.belt_bending};
    std::shared_ptr<RimCache> cache;
    if (!p.cache_folder.empty()) cache = std::make_shared<FolderRimCache>(p.cache_folder);
    if (p.model == "wheel_rim") return std::make_unique<WheelRim>(rim_of(p, wheel), belt, cache);
    if (p.model == "bonded_layer")
        return std::make_unique<BondedLayer>(elasticity, p.rim_thickness);
    if (p.model == "half_space") return std::make_unique<HalfSpace>(elasticity);
    if (p.model == "surrogate") {
        const ContactFeatures features{p.cell, p.rim_thickness};
        const TrainedRegression learnt = p.regression ? *p.regression : TrainedRegression();
        return std::make_unique<Surrogate>(features, learnt, p.name);
    }
    if (p.model == "geometric") return std::make_unique<Geometric>();
    if (p.model == "elastic_foundation") {
        if (p.stiffness > 0.0) return std::make_unique<ElasticFoundation>(p.stiffness);
        const WheelRimDesign design = rim_of(p, wheel);
        const WheelRim rim(design, belt, cache);
        return std::make_unique<ElasticFoundation>(
            foundation_stiffness(wheel, rim, force, design.softest()));
    }
    throw InputError("call.compliance",
                     "compliance: there is no model '{name}'; use wheel_rim, bonded_layer, "
                     "half_space, elastic_foundation, surrogate or geometric",
                     {{"name", p.model}});
}

}  // namespace beltgrinding

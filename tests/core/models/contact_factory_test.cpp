#include "beltgrinding/contact_factory.h"

#include <gtest/gtest.h>

#include "beltgrinding/error.h"
#include "elastic/half_space.h"
#include "elastic/wheel_rim.h"
#include "models/single_contact.h"

namespace beltgrinding {
namespace {

std::string made(const ContactModelParameters& p, double force = 50.0) {
    return make_contact_model(p, {}, force)->describe();
}

TEST(ContactFactory, MakesEveryModelOfItsParameters) {
    ContactModelParameters p;
    p.youngs_modulus = 4.0;
    p.poissons_ratio = 0.4;
    p.rim_thickness = 12.0;
    const ContactWheel wheel;
    const WheelRimDesign design{wheel.radius, wheel.width, {{12.0, {4.0, 0.4}}}};
    EXPECT_EQ(made(p), WheelRim(design, {}).describe());
    p.belt_tension = 2.0;
    p.belt_bending = 3.0;
    EXPECT_EQ(made(p), WheelRim(design, {2.0, 3.0}).describe());
    p.model = "bonded_layer";
    EXPECT_EQ(made(p), BondedLayer({4.0, 0.4}, 12.0).describe());
    p.model = "half_space";
    EXPECT_EQ(made(p), HalfSpace({4.0, 0.4}).describe());
    p.model = "elastic_foundation";
    p.stiffness = 0.7;
    EXPECT_EQ(made(p), ElasticFoundation(0.7).describe());
    p.model = "geometric";
    EXPECT_TRUE(make_contact_model(p, wheel, 50.0)->rigid());
}

TEST(ContactFactory, LayersReplaceTheOneRubber) {
    ContactModelParameters p;
    p.layers = {{5.0, 8.0, 0.3}, {6.0, 2.0, 0.45}};
    const ContactWheel wheel;
    const WheelRimDesign design{wheel.radius, wheel.width, {{5.0, {8.0, 0.3}}, {6.0, {2.0, 0.45}}}};
    EXPECT_EQ(made(p), WheelRim(design, {}).describe());
}

TEST(ContactFactory, RefusesWhatIsNone) {
    ContactModelParameters p;
    p.model = "rubber";
    EXPECT_THROW(made(p), InputError);
    p.model = "surrogate";  // without what was learnt
    EXPECT_THROW(made(p), InputError);
    p.model = "half_space";
    p.youngs_modulus = -1.0;
    EXPECT_THROW(made(p), InputError);
}

TEST(Workpiece, ShapesHaveNames) {
    EXPECT_EQ(Workpiece::shape_named("plane"), Workpiece::Shape::kPlane);
    EXPECT_EQ(Workpiece::shape_named("cylinder"), Workpiece::Shape::kCylinder);
    EXPECT_EQ(Workpiece::shape_named("sphere"), Workpiece::Shape::kSphere);
    EXPECT_EQ(Workpiece::shape_named("strip"), Workpiece::Shape::kStrip);
    EXPECT_THROW(Workpiece::shape_named("cube"), InputError);
}

}  // namespace
}  // namespace beltgrinding

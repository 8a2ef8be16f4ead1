#include "removal/removal_law.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace beltgrinding {
namespace {

TEST(RemovalLaw, BothLawsRemoveTheSameVolume) {
    const Eigen::ArrayXd pressure = Eigen::ArrayXd::Random(100).max(0.0);
    const double cell = 0.7;
    ProcessState state;
    state.force = pressure.sum() * cell;
    state.contact_area = (pressure > 0.0).count() * cell;
    Eigen::ArrayXd local, global;
    LocalLinearLaw(2e-4).rate(pressure, state, local);
    HammannLaw(2e-4).rate(pressure, state, global);
    EXPECT_NEAR(local.sum(), global.sum(), 1e-12 * local.sum());
    EXPECT_EQ(((global > 0.0) == (pressure > 0.0)).count(), 100);
}

// A contact of width l_w and any length, crossed at V_w: the depth is Hammann's r.
TEST(RemovalLaw, APassRemovesHammannsDepth) {
    const double k = 1.5e-4, speed = 15000.0, wear = 0.8, force = 60.0, feed = 40.0, width = 25.0;
    const double length = 9.0;
    ProcessState state{speed, wear, feed, force, width * length};
    Eigen::ArrayXd rate;
    HammannLaw(k).rate(Eigen::ArrayXd::Constant(1, force / (width * length)), state, rate);
    EXPECT_NEAR(rate[0] * length / feed, hammann_depth(k, wear, speed, force, feed, width), 1e-12);
}

TEST(RemovalLaw, RefusesNonsense) {
    EXPECT_THROW(LocalLinearLaw(-1.0), InputError);
    EXPECT_THROW(HammannLaw(std::nan("")), InputError);
}

}  // namespace
}  // namespace beltgrinding

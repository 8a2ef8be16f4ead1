#include "beltgrinding/removal_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beltgrinding/error.h"
#include "support/hammann.h"

namespace beltgrinding {
namespace {

TEST(RemovalLaw, BothLawsRemoveTheSameVolume) {
    const Eigen::ArrayXd pressure = Eigen::ArrayXd::Random(100).max(0.0);
    const double cell = 0.7;
    ProcessState state;
    state.force = pressure.sum() * cell;
    state.contact_area = (pressure > 0.0).count() * cell;
    Eigen::ArrayXd local, global;
    LocalLaw({2e-4}).rate(pressure, state, local);
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
    EXPECT_NEAR(rate[0] * length / feed, testing::hammann_depth(k, wear, speed, force, feed, width),
                1e-12);
}

/// Rate under one pressure.
double rate_of(const LocalLawParameters& p, double pressure, ProcessState state = {}) {
    Eigen::ArrayXd rate;
    LocalLaw(p).rate(Eigen::ArrayXd::Constant(1, pressure), state, rate);
    return rate[0];
}

TEST(LocalLaw, ItsParametersActAsTheFormulaSays) {
    LocalLawParameters p;
    p.coefficient = 2e-4;
    ProcessState state;
    state.belt_speed = 30000.0;
    state.belt_wear = 0.5;
    state.feed = 80.0;
    const double linear = 2e-4 * 0.5 * 30000.0 * 0.3;
    EXPECT_NEAR(rate_of(p, 0.3, state), linear, 1e-12);
    p.pressure_exponent = 1.4;
    p.speed_exponent = 1.2;
    p.feed_exponent = -0.3;
    const double power = linear * std::pow(3.0, 0.4) * std::pow(1.5, 0.2) * std::pow(1.6, -0.3);
    EXPECT_NEAR(rate_of(p, 0.3, state), power, 1e-12);
    p.pressure_threshold = 0.1;
    EXPECT_EQ(rate_of(p, 0.09, state), 0.0);
    EXPECT_NEAR(rate_of(p, 0.4, state), power, 1e-12);
    p.saturation_pressure = 0.2;
    const double q = 0.2 * (1.0 - std::exp(-0.3 / 0.2));
    EXPECT_NEAR(rate_of(p, 0.4, state), power * std::pow(q / 0.3, 1.4), 1e-12);
    EXPECT_LT(rate_of(p, 50.0, state), power * std::pow(0.2 / 0.3, 1.4) * 1.0000001);
    EXPECT_EQ(rate_of(p, 0.0, state), 0.0);
}

TEST(LocalLaw, LandsBearTheWholeForce) {
    LocalLawParameters p;
    const double plain = rate_of(p, 0.2);
    p.land_share = 0.5;
    EXPECT_NEAR(rate_of(p, 0.2), plain, 1e-12);  // linear: as much on half the area
    p.pressure_exponent = 1.5;
    const double serrated = rate_of(p, 0.2);
    p.land_share = 1.0;
    EXPECT_NEAR(serrated, rate_of(p, 0.2) * std::sqrt(2.0), 1e-12);
    p.land_share = 0.5;
    p.land_curve = Curve({{0.3, 1.4}, {0.5, 1.2}, {1.0, 1.0}}, "land");
    EXPECT_NEAR(rate_of(p, 0.2), 1.2 * serrated, 1e-12);
}

TEST(LocalLaw, CurvesReplaceThePowersAndKnowTheirRange) {
    LocalLawParameters p;
    const double linear = rate_of(p, 0.1);
    p.pressure_curve = Curve({{0.05, 0.4}, {0.1, 1.0}, {0.3, 2.0}}, "pressure");
    EXPECT_NEAR(rate_of(p, 0.1), linear, 1e-12);
    EXPECT_NEAR(rate_of(p, 0.3), 2.0 * linear, 1e-12);
    EXPECT_NEAR(rate_of(p, 0.025), 0.2 * linear, 1e-12);
    p.speed_curve = Curve({{10000.0, 0.4}, {20000.0, 1.0}, {30000.0, 1.3}}, "speed");
    ProcessState state;
    state.belt_speed = 30000.0;
    EXPECT_NEAR(rate_of(p, 0.1, state), 1.3 * linear, 1e-12);
    p.feed_curve = Curve({{20.0, 1.5}, {100.0, 0.5}}, "feed");
    state.feed = 60.0;
    EXPECT_NEAR(rate_of(p, 0.1, state), 1.3 * linear, 1e-12);

    const LocalLaw law(p);
    EXPECT_FALSE(law.outside(0.2, state));
    EXPECT_NE(law.outside(0.4, state)->fact.sentence().find("0.05 to 0.3 MPa"), std::string::npos);
    state.feed = 10.0;
    EXPECT_NE(law.outside(0.2, state)->fact.sentence().find("the feed of 10"), std::string::npos);
    state.belt_speed = 5000.0;
    EXPECT_NE(law.outside(0.2, state)->fact.sentence().find("10 to 30 m/s"), std::string::npos);
}

TEST(RemovalLaw, RefusesNonsense) {
    for (const auto spoil : {+[](LocalLawParameters& p) { p.pressure_threshold = -1.0; },
                             +[](LocalLawParameters& p) { p.pressure_exponent = 0.0; },
                             +[](LocalLawParameters& p) { p.reference_speed = 0.0; },
                             +[](LocalLawParameters& p) { p.feed_exponent = NAN; },
                             +[](LocalLawParameters& p) { p.saturation_pressure = -1.0; },
                             +[](LocalLawParameters& p) { p.land_share = 1.2; }}) {
        LocalLawParameters p;
        spoil(p);
        EXPECT_THROW(LocalLaw{p}, InputError);
    }

    EXPECT_THROW(LocalLaw({-1.0}), InputError);
    EXPECT_THROW(HammannLaw(std::nan("")), InputError);
}

TEST(RemovalLaw, IsFiniteWhateverThePressureOrRefused) {
    Eigen::ArrayXd pressure(4), rate;
    pressure << 0.0, 1e-300, 1.0, 1e300;
    LocalLawParameters p;
    p.pressure_exponent = 20.0;
    for (const double coefficient : {0.0, 1e-4, 1e300}) {
        p.coefficient = coefficient;
        LocalLaw(p).rate(pressure, {}, rate);
        EXPECT_TRUE(rate.isFinite().all() && (rate >= 0.0).all());
        EXPECT_EQ(rate[0], 0.0);
        HammannLaw(coefficient).rate(pressure, {20000.0, 1.0, 50.0, 1e300, 1e-3}, rate);
        EXPECT_TRUE(rate.isFinite().all() && (rate >= 0.0).all());
    }
    p.speed_exponent = 1e4;
    EXPECT_THROW(LocalLaw(p).rate(pressure, {40000.0}, rate), InputError);
}

TEST(RemovalLaw, IsMadeByName) {
    LocalLawParameters p;
    p.coefficient = 2e-4;
    p.pressure_exponent = 0.8;
    EXPECT_EQ(make_removal_law("local", p)->describe(), LocalLaw(p).describe());
    EXPECT_EQ(make_removal_law("hammann", p)->describe(), HammannLaw(2e-4).describe());
    EXPECT_THROW(make_removal_law("Local", p), InputError);
    p.coefficient = -1.0;
    EXPECT_THROW(make_removal_law("hammann", p), InputError);
}

}  // namespace
}  // namespace beltgrinding

// A belt that loads with chips while it grinds, and gives that back while it runs free, against
// the closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/compliance.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr double kCoefficient = 1e-5;  // mm2/N: little is removed, the force is the pass's own
constexpr double kForce = 40.0, kSpeed = 20000.0, kFeed = 40.0, kLength = 60.0;
constexpr double kWork = 1e-3 * kForce * kSpeed * kLength / kFeed;  // J, of a pass

PathPose at(double x, double z, bool rapid = false) {
    PathPose pose;
    pose.base_from_tcp = Eigen::Translation3d(x, 20, z) * Eigen::AngleAxisd(M_PI, Vec3::UnitX());
    pose.feed = kFeed;
    pose.rapid = rapid;
    return pose;
}

/// A pass to the right, and from there.
std::vector<PathPose> one_pass() {
    return {at(10, 0.3), at(10 + kLength, 0.3)};
}

BeltWear::Parameters loads(BeltWear::Variable variable, double scale) {
    BeltWear::Parameters p;
    p.variable = variable;
    p.loading_share = 0.4;
    p.loading_scale = scale;
    return p;
}

SimulationOptions options(const BeltWear& wear = {}) {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = kForce;
    o.process.belt_speed = kSpeed;
    o.process.wear = wear;
    return o;
}

SimulationResult run(const std::vector<PathPose>& poses, const SimulationOptions& o,
                     double coefficient = kCoefficient) {
    HeightField field = testing::plate(80.0, 40.0, 0.5, 0.3);
    return simulate(field, ToolPath(poses, {}), ElasticFoundation(0.5), LocalLaw({coefficient}), o);
}

TEST(Loading, TakesTheClosedFormsShareWhateverTheSteps) {
    const double fresh = run(one_pass(), options()).integrated_rate;
    const double start = 0.2;
    // The belt loads within some steps, or within two passes.
    for (const double scale : {kWork / 30.0, 2.0 * kWork}) {
        const double x = kWork / scale, end = 1.0 - (1.0 - start) * std::exp(-x);
        const double mean = 1.0 - (1.0 - start) * (1.0 - std::exp(-x)) / x;
        for (const double step : {0.5, 1.0, 6.0}) {
            SimulationOptions o = options(BeltWear(loads(BeltWear::Variable::kWork, scale)));
            o.process.belt.loading = start;
            o.resolution.max_travel = step;
            const SimulationResult found = run(one_pass(), o);
            EXPECT_NEAR(found.belt.loading, end, 1e-4) << scale << ' ' << step;
            EXPECT_NEAR(found.integrated_rate / fresh, 1.0 - 0.4 * mean, 3e-4)
                << scale << ' ' << step;
        }
    }
}

TEST(Loading, OfTheVolumeFollowsWhatIsRemoved) {
    const double fresh = run(one_pass(), options()).removed_volume;
    for (const double scale : {fresh / 30.0, 2.0 * fresh}) {
        // V of dV/dt = R (a + b exp(-V / scale)).
        const double a = 0.6, b = 0.4, x = fresh / scale;
        const double removed = scale * std::log1p((a + b) * std::expm1(a * x) / a);
        for (const double step : {0.5, 6.0}) {
            SimulationOptions o = options(BeltWear(loads(BeltWear::Variable::kVolume, scale)));
            o.resolution.max_travel = step;
            const SimulationResult found = run(one_pass(), o);
            EXPECT_NEAR(found.removed_volume, removed, 2e-3 * removed) << scale << ' ' << step;
            EXPECT_NEAR(found.belt.loading, 1.0 - std::exp(-found.belt.volume / scale), 1e-9);
        }
    }
}

TEST(Loading, IsGivenBackWhileTheBeltRunsFree) {
    // Out of the work, through the air at feed and rapidly, and a second pass; then air again.
    std::vector<PathPose> poses = one_pass();
    poses.push_back(at(10 + kLength, 8.0, true));
    poses.push_back(at(10, 8.0));  // at feed: 1.5 s
    poses.push_back(at(10, 0.3, true));
    poses.push_back(at(10 + kLength, 0.3));
    poses.push_back(at(10 + kLength, 40.3, true));
    BeltWear::Parameters p = loads(BeltWear::Variable::kWork, 0.8 * kWork);
    p.loading_recovery = 3.0;
    SimulationOptions o = options(BeltWear(p));
    o.process.pause = 2.0;
    o.process.belt.loading = 0.9;
    const SimulationResult found = run(poses, o);
    const double lift = (8.0 - 0.3) / kFeed, pass = kLength / kFeed;
    const auto rests = [](double l, double seconds) { return l * std::exp(-seconds / 3.0); };
    const auto grinds = [](double l) { return 1.0 - (1.0 - l) * std::exp(-1.0 / 0.8); };
    double l = grinds(rests(0.9, 2.0));
    l = grinds(rests(l, 2.0 * lift + pass));
    l = rests(l, 1.0);
    EXPECT_NEAR(found.belt.loading, l, 5e-4);
    EXPECT_NEAR(found.belt.time, 2.0 * pass, 1e-6);
    EXPECT_NEAR(found.process_time, 3.0 * pass + 2.0 * lift + 1.0, 1e-9) << "the pause is not";
    p.loading_recovery = 0.0;
    o.process.wear = BeltWear(p);
    EXPECT_NEAR(run(poses, o).belt.loading, grinds(grinds(0.9)), 5e-4);
}

TEST(Loading, GoesOnWhileAForceThatLagsComesToTheWork) {
    std::vector<PathPose> poses = one_pass();
    poses.push_back(at(10 + kLength, 8.0));
    BeltWear::Parameters p = loads(BeltWear::Variable::kWork, 0.8 * kWork);
    p.loading_recovery = 3.0;
    SimulationOptions o = options(BeltWear(p));
    o.process.dynamics.lag = 0.02;
    o.process.dynamics.mass = 2e-3;
    o.process.dynamics.damping = 0.2;
    const SimulationResult found = run(poses, o);
    // One contact, then air: what the belt has done is known, and how long it was free.
    const double loaded = 1.0 - std::exp(-found.belt.work / (0.8 * kWork));
    const double free = found.process_time - found.belt.time;
    EXPECT_GT(free, 0.05);
    EXPECT_NEAR(found.belt.loading, loaded * std::exp(-free / 3.0), 1e-3);
}

TEST(Loading, AShiftedShareRemovesWhatThatShareWould) {
    BeltWear::Parameters p = loads(BeltWear::Variable::kWork, 0.5 * kWork), more = p;
    more.loading_share *= 1.02;
    SimulationOptions o = options(BeltWear(p));
    const auto law = std::make_shared<LocalLaw>(LocalLawParameters{kCoefficient});
    o.outputs.shifted_laws = {{law}, {law, BeltWear(more)}};
    const SimulationResult result = run(one_pass(), o);
    EXPECT_EQ(result.shifts.col(0).abs().maxCoeff(), 0.0);
    const double shifted = 0.25 * result.shifts.col(1).sum();  // samples of 0.5 mm
    const double truth =
        run(one_pass(), options(BeltWear(more))).removed_volume - result.removed_volume;
    EXPECT_LT(truth, 0.0);
    EXPECT_NEAR(shifted, truth, 0.03 * std::abs(truth));
}

TEST(Loading, ThatIsNotAskedForChangesNothing) {
    BeltWear::Parameters p;
    p.model = BeltWear::Model::kExponential;
    p.scale = kWork;
    const SimulationResult plain = run(one_pass(), options(BeltWear(p)));
    p.loading_recovery = 5.0;
    SimulationOptions o = options(BeltWear(p));
    o.process.pause = 3.0;
    const SimulationResult found = run(one_pass(), o);
    EXPECT_EQ(found.removed_volume, plain.removed_volume);
    EXPECT_EQ(found.belt.work, plain.belt.work);
    EXPECT_EQ(found.belt.loading, 0.0);
}

TEST(Loading, RefusesWhatItWouldHaveToIgnore) {
    SimulationOptions o = options();
    o.process.belt.loading = 0.5;  // and no law of it
    EXPECT_THROW(run(one_pass(), o), InputError);
    o = options(BeltWear(loads(BeltWear::Variable::kWork, kWork)));
    o.process.pause = -1.0;
    EXPECT_THROW(run(one_pass(), o), InputError);
    o.process.pause = 0.0;
    o.process.force_control = false;
    HeightField field = testing::plate(80.0, 40.0, 0.5, 0.3);
    EXPECT_THROW(simulate(field, ToolPath(one_pass(), {}), Geometric(), LocalLaw({1.0}), o),
                 InputError);
}

}  // namespace
}  // namespace beltgrinding

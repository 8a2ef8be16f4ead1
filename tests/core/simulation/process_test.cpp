// What the process does beside removing: wear, heat, the law's range and its uncertainty.
#include <gtest/gtest.h>

#include <cmath>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/compliance.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr double kCoefficient = 1e-4;  // mm2/N
constexpr double kForce = 40.0, kSpeed = 20000.0, kFeed = 40.0, kLength = 60.0;

PathPose pressing_down(double x, double z) {
    PathPose pose;
    pose.base_from_tcp = Eigen::Translation3d(x, 20, z) * Eigen::AngleAxisd(M_PI, Vec3::UnitX());
    pose.feed = kFeed;
    return pose;
}

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = kForce;
    o.process.belt_speed = kSpeed;
    return o;
}

/// One pass along a plate, or along the crown of a cylinder (convex or, with a wheel of 60 mm,
/// concave in the feed).
SimulationResult pass(HeightField& field, const LocalLawParameters& law,
                      const SimulationOptions& o) {
    ElasticFoundation foundation(0.5);
    const ToolPath path({pressing_down(10, 0.3), pressing_down(10 + kLength, 0.3)}, {});
    return simulate(field, path, foundation, LocalLaw(law), o);
}

HeightField plate() {
    return testing::plate(80.0, 40.0, 0.5, 0.3);
}

TEST(Process, LinearLawIntegratesToTheGlobalLawOnCurvedParts) {
    // The cylinder's axis across the feed; its crown at z = 0.
    for (const double radius : {45.0, 150.0}) {
        HeightField field = testing::cylinder(radius, 60.0, 40.0, 0.4, 0.3);
        ElasticFoundation foundation(0.5);
        std::vector<PathPose> poses;
        const double swing = 8.0 / radius;
        for (const double turn : {-swing, swing}) {
            PathPose pose = pressing_down(0, 0);
            pose.base_from_tcp =
                Eigen::Translation3d(radius * std::sin(turn), 20, radius * (std::cos(turn) - 1.0)) *
                Eigen::AngleAxisd(turn, Vec3::UnitY()) * Eigen::AngleAxisd(M_PI, Vec3::UnitX());
            poses.push_back(pose);
        }
        const SimulationResult result =
            simulate(field, ToolPath(poses, {}), foundation, LocalLaw({kCoefficient}), options());
        const double whole = kCoefficient * kSpeed * kForce * result.process_time;  // K V_b F t
        EXPECT_NEAR(result.integrated_rate, whole, 0.005 * whole) << radius;
        EXPECT_NEAR(result.removed_volume, whole, 0.02 * whole) << radius;
    }
}

// An L on a plate: where the robot stops in the corner it dwells, and removes K V_b F dt more.
TEST(Process, DwellInACornerRemovesMore) {
    const auto corner = [](double zone) {
        std::vector<PathPose> poses{pressing_down(20, 0.3), pressing_down(60, 0.3),
                                    pressing_down(60, 0.3)};
        poses[0].base_from_tcp.translation().y() = poses[1].base_from_tcp.translation().y() = 20;
        poses[2].base_from_tcp.translation().y() = 60;
        poses[1].zone = zone;
        return poses;
    };
    const auto run = [](const std::vector<PathPose>& poses, const TimeLaw& law,
                        HeightField& field) {
        ElasticFoundation foundation(0.5);
        return simulate(field, ToolPath(poses, {}, law), foundation, LocalLaw({kCoefficient}),
                        options());
    };
    TimeLaw law;
    law.timing = TimeLaw::Timing::kTrapezoidal;
    law.acceleration = 200.0;
    const double ramp = kFeed / law.acceleration;  // s more of each motion from rest to rest: v / a
    HeightField even = testing::plate(80.0, 80.0, 0.5, 0.3), stopped = even, rounded = even;
    const SimulationResult constant = run(corner(0.0), {}, even);
    const SimulationResult stop = run(corner(0.0), law, stopped);
    const SimulationResult round = run(corner(8.0), law, rounded);
    EXPECT_NEAR(stop.process_time, constant.process_time + 2.0 * ramp, 1e-9);
    // In the zone at speed v_c <= feed; from rest to the feed and back as before.
    const double v = std::min(kFeed, std::sqrt(2.0 * 8.0 * law.acceleration / std::sqrt(2.0)));
    ASSERT_EQ(v, kFeed);
    EXPECT_NEAR(round.process_time, constant.process_time + ramp, 1e-9);

    const double per_second = kCoefficient * kSpeed * kForce;  // mm3/s: K V_b F
    for (const SimulationResult* result : {&constant, &stop, &round}) {
        const double whole = per_second * result->process_time;
        EXPECT_NEAR(result->integrated_rate, whole, 0.005 * whole);
        EXPECT_NEAR(result->removed_volume, whole, 0.02 * whole);
        double duration = 0.0;
        for (const StepRecord& step : result->steps) {
            duration += step.duration;
            EXPECT_GT(step.feed, 0.0f);
            EXPECT_LE(step.feed, kFeed * 1.001);
        }
        EXPECT_NEAR(duration, result->process_time, 1e-5);
    }
    // What is removed around the corner, within reach of the slow way v^2 / (2 a) and the contact.
    const auto removed = [](const HeightField& field) {
        double volume = 0.0;
        for (std::size_t s = 0; s < field.size(); ++s) {
            const Vec3 away = field.point[s].cast<double>() - Vec3(60, 20, 0);
            if (away.norm() < 18.0) volume += field.area[s] * (0.3 - field.height[s]);
        }
        return volume;
    };
    EXPECT_NEAR(removed(stopped) - removed(even), per_second * ramp, 0.1 * per_second * ramp);
    EXPECT_LT(removed(rounded), removed(even));
}

TEST(Process, TheBeltCarriesItsWorkAndLosesItsCut) {
    HeightField field = plate();
    SimulationOptions o = options();
    const double seconds = kLength / kFeed, work = 1e-3 * kForce * kSpeed * seconds;  // J
    const SimulationResult fresh = pass(field, {kCoefficient}, o);
    EXPECT_NEAR(fresh.belt.work, work, 1e-3 * work);
    EXPECT_NEAR(fresh.belt.time, seconds, 1e-9);
    EXPECT_NEAR(fresh.belt.volume, fresh.removed_volume, 1e-6 * fresh.removed_volume);

    BeltWear::Parameters wear;
    wear.model = BeltWear::Model::kExponential;
    wear.scale = work;
    o.process.wear = BeltWear(wear);
    field = plate();
    const SimulationResult first = pass(field, {kCoefficient}, o);
    // Over the pass exp(-W/scale) has the mean 1 - 1/e.
    const double mean = 1.0 - std::exp(-1.0);
    EXPECT_NEAR(first.removed_volume, mean * fresh.removed_volume, 0.01 * fresh.removed_volume);
    field = plate();
    o.process.belt = first.belt;
    const SimulationResult second = pass(field, {kCoefficient}, o);
    EXPECT_NEAR(second.removed_volume, std::exp(-1.0) * first.removed_volume,
                0.01 * first.removed_volume);
    EXPECT_NEAR(second.belt.work, 2.0 * work, 2e-3 * work);
}

TEST(Process, HeatAndLeavingTheMeasuredRangeAreEvents) {
    HeightField field = plate();
    SimulationOptions o = options();
    LocalLawParameters law{kCoefficient};
    EXPECT_TRUE(pass(field, law, o).events.empty());
    o.limits.heat = 1000.0;  // MPa mm/s
    law.pressure_curve = Curve({{0.001, 0.01}, {0.02, 0.2}}, "pressure");
    BeltWear::Parameters wear;
    wear.model = BeltWear::Model::kCurve;
    wear.curve = Curve({{0, 1}, {600, 0.9}}, "wear");
    o.process.wear = BeltWear(wear);
    field = plate();
    const SimulationResult result = pass(field, law, o);
    std::map<std::string, Event> events;
    for (const Event& e : result.events) events.emplace(e.kind, e);
    ASSERT_TRUE(events.contains("burn_risk"));
    float peak = 0.0f;
    for (const StepRecord& step : result.steps) peak = std::max(peak, step.peak_pressure);
    EXPECT_NEAR(events["burn_risk"].value, 1e-3 * peak * kSpeed, 1e-3 * peak * kSpeed);
    ASSERT_TRUE(events.contains("law_out_of_range"));
    ASSERT_TRUE(events.contains("belt_out_of_range"));
    EXPECT_GT(events["belt_out_of_range"].time, 0.5);  // the belt starts fresh
}

TEST(Process, ShiftedLawsGiveTheUncertaintyOfWhatIsRemoved) {
    HeightField field = plate();
    const HeightField before = field;
    SimulationOptions o = options();
    LocalLawParameters more{1.1 * kCoefficient}, steeper{kCoefficient};
    steeper.pressure_exponent = 1.2;
    o.outputs.shifted_laws = {{std::make_shared<LocalLaw>(more)},
                              {std::make_shared<LocalLaw>(steeper)}};
    const SimulationResult result = pass(field, {kCoefficient}, o);
    ASSERT_EQ(result.shifts.rows(), static_cast<Eigen::Index>(field.size()));
    double removed = 0.0, shifted = 0.0;
    for (std::size_t s = 0; s < field.size(); ++s) {
        const double depth = before.height[s] - field.height[s];
        const auto row = static_cast<Eigen::Index>(s);
        EXPECT_NEAR(result.shifts(row, 0), 0.1 * depth, 0.02 * depth + 1e-9);
        removed += depth;
        shifted += result.shifts(row, 1);
    }
    EXPECT_GT(removed, 0.0);
    // Below the reference pressure (0.1 MPa) a steeper law cuts less, above it more.
    const double mean = kForce / result.steps[5].contact_area;
    EXPECT_EQ(shifted > 0.0, mean > 0.1);
    EXPECT_GT(std::abs(shifted), 1e-3 * removed);

    HeightField again = before;
    o.outputs.shifted_laws.clear();
    const SimulationResult plain = pass(again, {kCoefficient}, o);
    EXPECT_EQ(again.height, field.height);  // looking at the uncertainty changes nothing
    EXPECT_EQ(plain.shifts.cols(), 0);
}

TEST(Process, AShiftedWearRemovesWhatThatWearWould) {
    BeltWear::Parameters wear;
    wear.model = BeltWear::Model::kExponential;
    wear.scale = 1e-3 * kForce * kSpeed * kLength / kFeed;  // J: a pass wears the belt to 1/e
    SimulationOptions o = options();
    o.process.wear = BeltWear(wear);
    o.process.belt_wear = 0.9;
    BeltWear::Parameters slower = wear;
    slower.scale *= 1.02;
    const auto law = std::make_shared<LocalLaw>(LocalLawParameters{kCoefficient});
    o.outputs.shifted_laws = {{law}, {law, BeltWear(slower)}};
    HeightField field = plate(), other = field;
    const SimulationResult result = pass(field, {kCoefficient}, o);
    o.process.wear = BeltWear(slower);
    const SimulationResult truth = pass(other, {kCoefficient}, o);
    EXPECT_EQ(result.shifts.col(0).abs().maxCoeff(), 0.0);
    double shifted = 0.0;
    for (std::size_t s = 0; s < field.size(); ++s)
        shifted += field.area[s] * result.shifts(static_cast<Eigen::Index>(s), 1);
    const double more = truth.removed_volume - result.removed_volume;
    EXPECT_GT(more, 0.0);
    EXPECT_NEAR(shifted, more, 0.02 * more);
}

}  // namespace
}  // namespace beltgrinding

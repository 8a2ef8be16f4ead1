// What a simulation notes as events: when, where on the part, how much.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/threads.h"
#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/compliance.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr double kFeed = 40.0, kAllowance = 0.3, kStiffness = 0.5;  // mm/s, mm, MPa/mm
const Frame kDown = Frame(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));  // the wheel presses down

PathPose at(double x, double y, double z, double tilt_about_x = 0.0) {
    PathPose pose;
    pose.base_from_tcp =
        Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(tilt_about_x, Vec3::UnitX()) * kDown;
    pose.feed = kFeed;
    return pose;
}

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = 40.0;
    return o;
}

std::vector<Event> grind(HeightField& field, std::vector<PathPose> poses,
                         const SimulationOptions& o, double coefficient = 1e-5) {
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].line = static_cast<int>(i) + 1;
    ElasticFoundation foundation(kStiffness);
    return simulate(field, ToolPath(std::move(poses), {}), foundation, LocalLaw({coefficient}), o)
        .events;
}

std::vector<Event> of(const std::vector<Event>& events, const std::string& kind) {
    std::vector<Event> found;
    std::copy_if(events.begin(), events.end(), std::back_inserter(found),
                 [&](const Event& e) { return e.kind == kind; });
    return found;
}

/// Two plates side by side along x: 0 to 40 and 80 to 120 mm.
HeightField two_plates() {
    HeightField field = testing::plate(40.0, 40.0, 0.5, kAllowance);
    const std::size_t n = field.size();
    const HeightField one = field;
    field.resize(2 * n);
    for (std::size_t s = 0; s < n; ++s) {
        const std::size_t t = n + s;
        field.point[t] = one.point[s] + Vec3(80, 0, 0);
        field.normal[t] = one.normal[s];
        field.area[t] = one.area[s];
        field.flags[t] = one.flags[s];
        field.height[t] = one.height[s];
        field.stock_height[t] = one.stock_height[s];
        field.face[t] = 1;
    }
    return field;
}

TEST(Events, ContactIsLostOnlyBetweenContactsOfAPass) {
    SimulationOptions o = options();
    o.process.force_travel = 2.0;
    // From beside the first plate to beside the second: only the gap between them counts.
    HeightField field = two_plates();
    const auto lost = of(grind(field, {at(-30, 20, 0), at(150, 20, 0)}, o), "loss_of_contact");
    ASSERT_EQ(lost.size(), 1u);
    const Event& event = lost[0];
    // The wheel's flank still touches the border where its arc is within the travel below.
    const double flank = std::sqrt(2.0 * 60.0 * (o.process.force_travel + kAllowance));
    EXPECT_GT(event.value, 40.0 - 2.0 * flank - 2.0);
    EXPECT_LE(event.value, 40.0);
    EXPECT_NEAR(event.point.x(), 60.0, 2.0);
    EXPECT_EQ(event.point.y(), 20.0);
    EXPECT_GT(event.time, 70.0 / kFeed - 0.1);
    EXPECT_NEAR(event.time + 0.5 * event.duration, 90.0 / kFeed, 0.1);
    EXPECT_EQ(event.line, 2);
    EXPECT_EQ(event.severity, Severity::kWarning);
    EXPECT_EQ(event.unit, "mm");

    const auto none = [&](std::vector<PathPose> poses, const char* why) {
        HeightField fresh = two_plates();
        EXPECT_TRUE(of(grind(fresh, std::move(poses), o), "loss_of_contact").empty()) << why;
    };
    none({at(-30, 20, 0), at(30, 20, 0)}, "before the first contact");
    none({at(10, 20, 0), at(58, 20, 0)}, "after the last contact");
    auto rapid = at(85, 20, 0);
    rapid.rapid = true;
    none({at(10, 20, 0), at(35, 20, 0), rapid, at(110, 20, 0)}, "a rapid motion");
    none({at(10, 20, 0), at(35, 20, 0), at(36, 20, 20), at(84, 20, 20), at(85, 20, 0),
          at(110, 20, 0)},
         "it lifts off");
    none({at(10, 20, 0), at(58, 20, 0), at(58, 25, 0), at(10, 25, 0)}, "it turns back beside");
}

TEST(Events, PressureBeyondItsLimitHasItsPlace) {
    HeightField field = testing::plate(80, 40, 0.5, kAllowance);
    SimulationOptions o = options();
    const auto poses = {at(20, 20, kAllowance), at(60, 20, kAllowance)};
    EXPECT_TRUE(grind(field, poses, o).empty());
    o.limits.pressure = 0.05;
    const auto events = grind(field, poses, o);
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, "over_pressure");
    EXPECT_GT(events[0].value, o.limits.pressure);
    EXPECT_EQ(events[0].limit, o.limits.pressure);
    EXPECT_EQ(events[0].face, 1u);
    EXPECT_NEAR(events[0].duration, 1.0, 1e-9);
    EXPECT_GE(events[0].worst_time, events[0].time);
    EXPECT_LE(events[0].worst_time, events[0].time + events[0].duration);
    // It was worst there and then.
    EXPECT_NEAR(events[0].point.x(), 20.0 + kFeed * events[0].worst_time, 6.0);
    EXPECT_LE(std::abs(events[0].point.y() - 20.0), 10.0);
}

TEST(Events, AWheelHeldAskewPressesWithOneEdge) {
    HeightField field = testing::plate(80, 40, 0.5, kAllowance);
    const auto run = [&](double tilt) {
        HeightField fresh = field;
        return of(
            grind(fresh, {at(20, 20, kAllowance, tilt), at(60, 20, kAllowance, tilt)}, options()),
            "edge_contact");
    };
    EXPECT_TRUE(run(0.0).empty());  // its whole width on a plane: nothing is wrong
    for (const double side : {-1.0, 1.0}) {
        const auto events = run(side * 0.15);
        ASSERT_EQ(events.size(), 1u);
        // Turned about x by a positive angle, base y rises: the lower edge is that at base y < 20,
        // which is +y of a contact frame whose y points the other way.
        EXPECT_NE(events[0].message().find(side > 0.0 ? "at +y" : "at -y"), std::string::npos)
            << events[0].message();
        EXPECT_EQ(events[0].point.y() < 20.0, side > 0.0);
        EXPECT_NEAR(std::abs(events[0].point.y() - 20.0), 10.0, 1.5);
        EXPECT_GT(events[0].value, 2.0 * events[0].limit);
        EXPECT_LE(events[0].value, 100.0);
    }
}

/// A trough: the inside of a cylinder about the y axis, its bottom at z = 0.
HeightField trough(double radius, double arc, double length) {
    HeightField field = testing::cylinder(radius, arc, length, 0.4);
    for (std::size_t s = 0; s < field.size(); ++s) {
        field.point[s].z() = -field.point[s].z();
        field.normal[s].x() = -field.normal[s].x();
        field.height[s] = kAllowance;
    }
    return field;
}

TEST(Events, AWheelTooLargeForAHollowSpansIt) {
    SimulationOptions o = options();
    o.process.force_travel = 10.0;
    const auto run = [&](HeightField field) {
        return of(grind(field, {at(-1, 18, kAllowance), at(1, 18, kAllowance)}, o, 0.0),
                  "wheel_too_large");
    };
    EXPECT_TRUE(run(trough(90.0, 60.0, 40.0)).empty());
    const auto events = run(trough(35.0, 60.0, 40.0));
    ASSERT_EQ(events.size(), 1u);
    EXPECT_NEAR(events[0].value, 35.0 - kAllowance, 0.5);
    EXPECT_EQ(events[0].limit, 60.0);
    EXPECT_NEAR(events[0].point.x(), 0.0, 4.0);
    EXPECT_NEAR(events[0].point.y(), 18.0, 10.0);
    EXPECT_EQ(events[0].face, 1u);
    EXPECT_NE(events[0].message().find("along the belt"), std::string::npos);

    // The same trough along the feed: hollow across the wheel.
    HeightField across = trough(35.0, 60.0, 40.0);
    for (std::size_t s = 0; s < across.size(); ++s) {
        std::swap(across.point[s].x(), across.point[s].y());
        std::swap(across.normal[s].x(), across.normal[s].y());
    }
    const auto poses = {at(18, 0, kAllowance), at(22, 0, kAllowance)};
    const auto found = of(grind(across, poses, o, 0.0), "wheel_too_large");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].value, 35.0 - kAllowance, 0.5);
    EXPECT_NE(found[0].message().find("across the wheel"), std::string::npos);

    // A groove ground into a plate before is no hollow of the design.
    HeightField plate = testing::plate(80, 40, 0.5, kAllowance);
    for (std::size_t s = 0; s < plate.size(); ++s) {
        if (std::abs(plate.point[s].y() - 20.0) < 4.0) plate.height[s] -= 0.5;
    }
    EXPECT_TRUE(
        of(grind(plate, {at(20, 20, 0), at(60, 20, 0)}, o, 0.0), "wheel_too_large").empty());
}

TEST(Events, AGougeNamesTheMotionThatMadeIt) {
    HeightField field = testing::plate(80, 40, 0.5, kAllowance);
    SimulationOptions o = options();
    o.limits.lower = {-0.05f};
    // The second motion dwells: it grinds through, the first and the third do not.
    std::vector<PathPose> poses{at(15, 20, 0), at(35, 20, 0), at(45, 20, 0), at(65, 20, 0)};
    poses[2].feed = kFeed / 8.0;
    const auto events = of(grind(field, poses, o, 1e-4), "gouge");
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].pose, 2u);
    EXPECT_EQ(events[0].line, 3);
    EXPECT_EQ(events[0].severity, Severity::kError);
    EXPECT_FLOAT_EQ(static_cast<float>(events[0].limit), -0.05f);
    const auto deepest = std::min_element(field.height.begin(), field.height.end());
    EXPECT_LT(*deepest, -0.05);
    EXPECT_LT(events[0].value, -0.05);
    EXPECT_GE(events[0].value, *deepest);
    EXPECT_EQ(events[0].face, 1u);
    EXPECT_GT(events[0].point.x(), 30.0);
    EXPECT_LT(events[0].point.x(), 50.0);

    // What lies below from the start was not done by the program.
    HeightField low = testing::plate(80, 40, 0.5, -0.1);
    EXPECT_TRUE(of(grind(low, {at(15, 20, 0), at(35, 20, 0)}, o), "gouge").empty());
    // One limit a sample: only the half that has one is watched.
    HeightField half = testing::plate(80, 40, 0.5, kAllowance);
    o.limits.lower.assign(half.size(), -10.0f);
    EXPECT_TRUE(of(grind(half, poses, o, 1e-4), "gouge").empty());
    o.limits.lower.assign(3, -10.0f);
    EXPECT_THROW(grind(half, poses, o), InputError);
}

TEST(Events, OrientationMayNotJumpAtFeed) {
    HeightField field = testing::plate(80, 40, 0.5, kAllowance);
    SimulationOptions o = options();
    o.limits.orientation_jump = 0.2;
    auto rapid = at(40, 20, kAllowance, 0.0);
    rapid.rapid = true;
    const std::vector<PathPose> poses{at(15, 20, kAllowance), at(20, 20, kAllowance, 0.15),
                                      at(25, 20, kAllowance, -0.15), rapid, at(45, 20, kAllowance)};
    const auto events = of(grind(field, poses, o), "orientation_jump");
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].pose, 2u);
    EXPECT_NEAR(events[0].value, 0.3 * 180.0 / M_PI, 1e-9);
    EXPECT_NEAR(events[0].time, 5.0 / kFeed, 1e-9);
    EXPECT_NEAR(events[0].point.x(), 22.5, 1e-9);
}

TEST(Events, AWheelThatTouchesFarFromTheProgrammedPointIsTilted) {
    HeightField field = testing::plate(80, 40, 0.5, kAllowance);
    SimulationOptions o = options();
    o.limits.tilt = 0.3;
    const auto turned = [](double angle) {
        std::vector<PathPose> poses;
        for (const double x : {30.0, 50.0}) {
            // About the wheel's centre, so that the wheel stays where it was.
            PathPose pose = at(x, 20, kAllowance);
            pose.base_from_tcp = pose.base_from_tcp * Eigen::Translation3d(0, 0, -60.0) *
                                 Eigen::AngleAxisd(angle, Vec3::UnitY()) *
                                 Eigen::Translation3d(0, 0, 60.0);
            poses.push_back(pose);
        }
        return poses;
    };
    EXPECT_TRUE(of(grind(field, turned(0.2), o), "tilted_contact").empty());
    const auto events = of(grind(field, turned(0.4), o), "tilted_contact");
    ASSERT_EQ(events.size(), 1u);
    EXPECT_NEAR(events[0].value, 0.4 * 180.0 / M_PI, 1.5);
}

TEST(Events, AreTheSameForAnyNumberOfThreads) {
    SimulationOptions o = options();
    o.limits.pressure = 0.05;
    o.limits.lower = {0.0f};
    const auto run = [&](std::size_t count) {
        set_threads(count);
        HeightField field = two_plates();
        return grind(field, {at(-10, 20, 0, 0.05), at(130, 20, 0, 0.05)}, o, 1e-4);
    };
    const auto one = run(1), two = run(2);
    set_threads(0);
    ASSERT_GT(one.size(), 3u);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].kind, two[i].kind);
        EXPECT_EQ(one[i].value, two[i].value);
        EXPECT_EQ(one[i].time, two[i].time);
        EXPECT_EQ(one[i].duration, two[i].duration);
        EXPECT_EQ(one[i].message(), two[i].message());
        if (one[i].point.allFinite()) {
            EXPECT_EQ(one[i].point, two[i].point);
        }
    }
}

TEST(Events, EveryKindHasAWholeDescription) {
    std::set<std::string> codes;
    for (const EventKind& kind : event_kinds()) {
        EXPECT_TRUE(codes.insert(kind.code).second) << kind.code;
        EXPECT_GT(std::string(kind.meaning).size(), 10u) << kind.code;
        EXPECT_GT(std::string(kind.advice).size(), 10u) << kind.code;
        EXPECT_EQ(&event_kind(kind.code), &kind);
    }
    EXPECT_THROW(event_kind("no_such_kind"), std::logic_error);
}

}  // namespace
}  // namespace beltgrinding

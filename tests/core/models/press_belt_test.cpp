#include "models/press_belt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

PressedBelt pressed_on(double along, double across) {
    PressedBelt pressed;
    pressed.machine.kind = BeltMachine::Kind::kFreeBelt;
    pressed.machine.belt.tension = 4.0;
    pressed.machine.run.rollers = BeltRun::Rollers::kTensioned;
    pressed.first = along;
    pressed.second = across;
    pressed.force = 20.6;
    return pressed;
}

/// mm along and across the belt that have pressure.
std::pair<double, double> extents(const SingleContactResult& result) {
    double along = 0.0, across = 0.0;
    const ContactGrid& grid = result.grid;
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i)
            if (result.solution.pressure[j * grid.nx + i] > 0.01 * result.solution.peak_pressure) {
                along = std::max(along, 2.0 * std::abs(grid.s(i)) + grid.ds);
                across = std::max(across, 2.0 * std::abs(grid.y(j)) + grid.dy);
            }
    return {along, across};
}

TEST(PressBelt, HasTheApproachOfTheReferencesCylinder) {
    const SingleContactResult result = press(pressed_on(1.0 / 40.0, 0.0));
    EXPECT_TRUE(result.solution.converged);
    EXPECT_NEAR(result.solution.force, 20.6, 0.02);
    EXPECT_NEAR(result.solution.approach, 5.0, 0.1);  // of finite elements: 20.56 N at 5 mm
    const auto [along, across] = extents(result);
    EXPECT_NEAR(along, 1.8, 0.8);
    EXPECT_NEAR(across, 49.4, 1.6);
    EXPECT_LT(result.grid.ds, along / 3.0) << "fine enough to see it";
}

TEST(PressBelt, TurnsWithTheCurvature) {
    PressedBelt turned = pressed_on(0.0, 1.0 / 40.0);
    turned.angle = std::numbers::pi / 2;
    const auto straight = press(pressed_on(1.0 / 40.0, 0.0)), same = press(turned);
    EXPECT_NEAR(same.solution.approach, straight.solution.approach, 1e-6);
    EXPECT_NEAR(extents(same).first, extents(straight).first, 1e-9);
}

TEST(PressBelt, LiesOnAPlaneWithAllThatIsBetweenTheRollers) {
    PressedBelt flat = pressed_on(0.0, 0.0);
    flat.machine.kind = BeltMachine::Kind::kPlaten;
    flat.machine.platen.layers = {{5.0, 2.0, 0.4}};
    const auto [along, across] = extents(press(flat));
    EXPECT_NEAR(along, flat.machine.platen.length, 10.0);
    EXPECT_NEAR(across, flat.machine.belt.width, 3.2);
}

TEST(PressBelt, RefusesWhatIsNoCurvature) {
    EXPECT_THROW(press(pressed_on(std::nan(""), 0.0)), InputError);
}

}  // namespace
}  // namespace beltgrinding

// Presses a tube of 60 mm diameter on a free belt that runs across it. Lengths in mm, forces in N.
#include <beltgrinding/belt_machine.h>

#include <cmath>
#include <cstdio>

using namespace beltgrinding;

int main() {
    BeltMachine machine;
    machine.kind = BeltMachine::Kind::kFreeBelt;
    machine.belt.width = 40.0;
    machine.belt.tension = 4.0;  // N per mm of width
    machine.run.rollers = BeltRun::Rollers::kTensioned;

    const ContactGrid cells{.nx = 160, .ny = 40, .ds = 0.25};  // x along the belt, y across
    ContactProblem tube;
    tube.gap.resize(cells.cells());
    for (int j = 0; j < cells.ny; ++j)
        for (int i = 0; i < cells.nx; ++i)
            tube.gap[j * cells.nx + i] = 30.0 - std::sqrt(30.0 * 30.0 - cells.s(i) * cells.s(i));
    tube.coverage.setConstant(cells.cells(), 1.0);
    for (const double force : {20.0, 40.0, 80.0}) {
        tube.force = force;
        const ContactSolution contact = make_belt_contact(machine)->prepare(cells)->solve(tube);
        std::printf("%.0f N: %.1f mm deep, %.1f mm2, %.3f MPa at most\n", force, contact.approach,
                    contact.area, contact.peak_pressure);
    }
}

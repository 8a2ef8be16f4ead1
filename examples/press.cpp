#include <beltgrinding/contact_factory.h>
#include <cstdio>
using namespace beltgrinding;

int main() {
    const ContactWheel wheel{.radius = 100.0, .width = 20.0};  // mm
    const auto rubber = make_contact_model({.youngs_modulus = 5.0}, wheel, 40.0);
    const ContactGrid cells{.nx = 41, .ny = 20};  // of 1 x 1 mm
    ContactProblem plane;
    plane.force = 40.0;  // N
    plane.gap = (Eigen::ArrayXd::LinSpaced(41, -20, 20).square() / 200.0).replicate(20, 1);
    plane.coverage = Eigen::ArrayXd::Ones(cells.cells());
    const ContactSolution contact = rubber->prepare(cells)->solve(plane);
    std::printf("%.0f mm2, %.3f MPa at most\n", contact.area, contact.peak_pressure);
}

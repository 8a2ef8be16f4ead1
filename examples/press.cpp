#include <beltgrinding/contact_factory.h>
#include <beltgrinding/simulation.h>

#include <cstdio>

using namespace beltgrinding;

int main() {
    HeightField plate;  // 80 x 40 mm of the plane z = 0, sampled every 0.5 mm
    plate.spacing = 0.5;
    plate.resize(161 * 81);
    for (std::size_t i = 0; i < plate.size(); ++i) {
        plate.point[i] = {0.5 * double(i % 161) - 40.0, 0.5 * double(i / 161) - 20.0, 0.0};
        plate.normal[i] = Vec3f::UnitZ();
        plate.area[i] = 0.25F;
    }
    ProcessSettings process;
    process.wheel = {.radius = 100.0, .width = 20.0};  // mm
    process.force = 40.0;                              // N
    const auto rubber = make_contact_model({.youngs_modulus = 5.0}, process.wheel, process.force);
    const ToolPath path({{.base_from_tcp = contact_frame({0, 0, 0}, {0, 0, -1}, {1, 0, 0})}}, {});
    const ContactSolution contact = contact_at(plate, path, 0, *rubber, process).solution;
    std::printf("%.0f mm2, %.3f MPa at most\n", contact.area, contact.peak_pressure);
}

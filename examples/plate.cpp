// Grinds a strip across a flat plate, and prints how deep. Lengths in mm, forces in N, times in s.
#include <beltgrinding/contact_factory.h>
#include <beltgrinding/simulation.h>

#include <cstdio>

using namespace beltgrinding;

int main() {
    HeightField plate;  // 100 x 40 mm of the plane z = 0, seen from above, under 1 mm of stock
    plate.spacing = 0.5;
    plate.resize(201 * 81);
    for (std::size_t i = 0; i < plate.size(); ++i) {
        plate.point[i] = {0.5 * double(i % 201) - 50.0, 0.5 * double(i / 201) - 20.0, 0.0};
        plate.normal[i] = {0.0F, 0.0F, 1.0F};
        plate.area[i] = 0.25F;
        plate.height[i] = plate.stock_height[i] = 1.0F;
    }
    SimulationOptions options;
    options.process.wheel = {.radius = 100.0, .width = 20.0};
    options.process.force = 40.0;
    options.process.belt_speed = 20e3;
    const auto contact = make_contact_model({.model = "elastic_foundation", .stiffness = 0.5},
                                            options.process.wheel, options.process.force);
    const auto law = make_removal_law("local", {.coefficient = 1e-4});  // mm2/N

    const Vec3 into(0, 0, -1), along(1, 0, 0);
    const Frame begin = contact_frame({-40, 0, 1}, into, along);
    const Frame end = contact_frame({40, 0, 1}, into, along);
    const ToolPath path({{.base_from_tcp = begin}, {.base_from_tcp = end, .feed = 50.0}}, {});
    const SimulationResult result = simulate(plate, path, *contact, *law, options);
    std::printf("depth %.4f mm, volume %.2f mm3\n", 1.0 - plate.height[40 * 201 + 100],
                result.removed_volume);
}

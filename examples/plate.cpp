// Grinds a strip across a flat plate, and prints how deep.
#include <beltgrinding/contact_factory.h>
#include <beltgrinding/removal_law.h>
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
    options.process.wheel.radius = 100.0;  // mm
    options.process.wheel.width = 20.0;    // mm
    options.process.force = 40.0;          // N
    options.process.belt_speed = 20e3;     // mm/s
    ContactModelParameters rubber;
    rubber.model = "elastic_foundation";
    rubber.stiffness = 0.5;  // MPa/mm
    const auto contact = make_contact_model(rubber, options.process.wheel, options.process.force);
    const auto law = make_removal_law("local", {.coefficient = 1e-4});  // mm2/N

    PathPose begin,
        end;  // the contact frame's z points into the work, its y along the wheel's axis
    begin.base_from_tcp = end.base_from_tcp = Frame(Eigen::DiagonalMatrix<double, 3>(1, -1, -1));
    begin.base_from_tcp.translation() = Vec3(-40.0, 0.0, 1.0);
    end.base_from_tcp.translation() = Vec3(40.0, 0.0, 1.0);
    end.feed = 50.0;  // mm/s
    const ToolPath path({begin, end}, {});

    const SimulationResult result = simulate(plate, path, *contact, *law, options);
    std::printf("depth %.4f mm, volume %.2f mm3\n", 1.0 - plate.height[40 * 201 + 100],
                result.removed_volume);
}

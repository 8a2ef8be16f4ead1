// part PART.step|.iges|.brep|.stl FACE: grinds one pass over the middle of a face, under 0.3 mm of
// stock, and prints what is in tolerance. Lengths in mm, forces in N, times in s.
#include <beltgrinding/contact_factory.h>
#include <beltgrinding/deviation.h>
#include <beltgrinding/error.h>
#include <beltgrinding/mesh_reader.h>
#include <beltgrinding/shape.h>
#include <beltgrinding/simulation.h>
#include <beltgrinding/stock.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

using namespace beltgrinding;

Shape read(const std::string& path) {
    return path.ends_with(".stl") ? shape_from_mesh(read_mesh(path)) : Shape::read(path);
}

/// Poses of the wheel along `along` through the samples nearest to that line.
ToolPath pass(const HeightField& field, const Vec3& middle, const Vec3& along, double width) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3 apart = field.point[i].cast<double>() - middle;
        const double way = apart.dot(along);
        if ((apart - way * along).norm() < width) near.emplace_back(way, i);
    }
    std::sort(near.begin(), near.end());
    std::vector<PathPose> poses;
    double last = -1e9;
    for (const auto& [way, i] : near) {
        if (way < last + 2.0 * width) continue;  // a pose every few samples
        last = way;
        const Vec3 normal = field.normal[i].cast<double>();
        const Vec3 stock = field.point[i].cast<double>() + double(field.height[i]) * normal;
        poses.push_back({.base_from_tcp = contact_frame(stock, -normal, along), .feed = 50.0});
    }
    return {poses, {}};
}

int main(int count, char** words) try {
    if (count != 3) throw InputError("example.usage", "usage: part PART FACE");
    const Shape shape = read(words[1]);
    const std::size_t face = std::strtoul(words[2], nullptr, 10) - 1;
    HeightField field = sample_faces(shape, {face}, {.spacing = 0.5});
    apply_allowance(field, 0.3);
    std::printf("face %zu of %zu: %s, %.0f mm2, %zu samples\n", face + 1, shape.face_count(),
                shape.surface_type(face).c_str(), shape.face_area(face), field.size());

    Box box;
    for (const auto& point : field.point) box.extend(point.cast<double>());
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    SimulationOptions options;
    options.process.wheel = {.radius = 50.0, .width = 20.0};
    options.process.force = 40.0;
    const auto rubber = make_contact_model({.model = "elastic_foundation"}, options.process.wheel,
                                           options.process.force);
    const auto law = make_removal_law("local", {.coefficient = 5e-5});  // mm2/N
    simulate(field, pass(field, box.center(), Vec3::Unit(axis), 1.0), *rubber, *law, options);

    const DeviationStatistics found = deviation_statistics(field, {.lower = -0.1, .upper = 0.1});
    std::printf("%.1f %% in tolerance, %.1f mm3 removed\n", 100.0 * found.in_tolerance_share,
                found.removed_volume);
} catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}

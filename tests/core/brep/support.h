#pragma once

#include <BRepPrimAPI_MakeBox.hxx>
#include <TopoDS_Shape.hxx>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "beltgrinding/shape.h"
#include "shape_impl.h"

namespace beltgrinding::test {

inline HeightField sample(const Shape& shape, double spacing,
                          const std::vector<std::size_t>& faces = {}, bool flip = false) {
    SamplingOptions options;
    options.spacing = spacing;
    return sample_faces(flip ? shape.flipped(true, {}) : shape, faces, options);
}

inline double total_area(const HeightField& field) {
    double sum = 0;
    for (const float a : field.area) sum += a;
    return sum;
}

/// What every field must be, whatever the face. `open` counts triangle edges that have one triangle
/// only: they must lie on the trimming edges.
struct MeshCheck {
    std::size_t open = 0;          ///< edges with one triangle
    std::size_t open_inside = 0;   ///< of these, with an end that is no boundary sample
    std::size_t crowded = 0;       ///< edges with more than two triangles
    std::size_t turned = 0;        ///< edges that two triangles run through in the same sense
    std::size_t across_faces = 0;  ///< triangles with samples of two faces
    std::size_t inverted = 0;      ///< triangles against their samples' normals
    std::size_t without_triangle = 0;
    double area = 0;  ///< mm2, of the triangles
    long euler = 0;   ///< vertices - edges + triangles
};

inline MeshCheck check_mesh(const HeightField& field) {
    MeshCheck check;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<int, 2>> edges;
    std::vector<char> used(field.size(), 0);
    for (const Triangle& t : field.triangles) {
        const Vec3 n =
            (field.point[t[1]] - field.point[t[0]]).cross(field.point[t[2]] - field.point[t[0]]);
        check.area += n.norm() / 2;
        const Vec3f mean = field.normal[t[0]] + field.normal[t[1]] + field.normal[t[2]];
        check.inverted += n.dot(mean.cast<double>()) <= 0;
        check.across_faces +=
            field.face[t[0]] != field.face[t[1]] || field.face[t[0]] != field.face[t[2]];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            used[a] = 1;
            ++edges[{std::min(a, b), std::max(a, b)}][a < b];
        }
    }
    for (const auto& [ends, count] : edges) {
        if (count[0] + count[1] == 1) {
            ++check.open;
            check.open_inside += !(field.flags[ends.first] & kOnBoundary) ||
                                 !(field.flags[ends.second] & kOnBoundary);
        }
        check.crowded += count[0] + count[1] > 2;
        check.turned += count[0] == 2 || count[1] == 2;
    }
    check.without_triangle =
        static_cast<std::size_t>(std::count(used.begin(), used.end(), char(0)));
    check.euler = static_cast<long>(field.size()) - static_cast<long>(edges.size()) +
                  static_cast<long>(field.triangles.size());
    return check;
}

/// Share of the grid's steps that are within 10 % of the spacing: the two shorter edges of each
/// triangle that has no sample on a boundary or next to one.
inline double even_share(const HeightField& field) {
    std::vector<char> near(field.size(), 0);
    for (const Triangle& t : field.triangles)
        for (const auto v : t)
            if (field.flags[v] & (kOnBoundary | kDegenerate))
                for (const auto w : t) near[w] = 1;
    std::size_t even = 0, all = 0;
    for (const Triangle& t : field.triangles) {
        if (near[t[0]] || near[t[1]] || near[t[2]]) continue;
        std::array<double, 3> l{};
        for (std::size_t k = 0; k < 3; ++k)
            l[k] = (field.point[t[k]] - field.point[t[(k + 1) % 3]]).norm() / field.spacing;
        std::sort(l.begin(), l.end());
        for (std::size_t k = 0; k < 2; ++k, ++all) even += l[k] > 0.9 && l[k] < 1.1;
    }
    return all ? double(even) / double(all) : 0.0;
}

/// Where the data for tests lie; empty if absent.
inline std::filesystem::path shared_data() {
    const char* named = std::getenv("BELTGRINDING_SHARED");
    const std::filesystem::path root =
        named ? std::filesystem::path(named)
              : std::filesystem::path(__FILE__).parent_path() / "../../../../shared";
    return std::filesystem::is_directory(root / "data") ? root / "data" : std::filesystem::path();
}

}  // namespace beltgrinding::test

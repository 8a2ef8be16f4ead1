#include "mesh/mesh_check.h"

#include <algorithm>
#include <string>
#include <utility>

#include "beltgrinding/error.h"
#include "mesh/topology.h"

namespace beltgrinding {
namespace {

/// One triangle's use of an edge; the lowest bit tells its direction.
struct Use {
    std::uint64_t edge;
    std::uint32_t triangle;
    bool forward;
};

}  // namespace

MeshCheck check_mesh(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
    MeshCheck check;
    std::vector<Use> uses;
    uses.reserve(3 * triangles.size());
    std::vector<char> used(vertices.size(), 0);
    // From a place near the mesh: far from the origin the sum would lose digits.
    const Vec3 origin = vertices.empty() ? Vec3::Zero().eval() : vertices.front();
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const Triangle& v = triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = v[k], b = v[(k + 1) % 3];
            if (a >= vertices.size())
                throw InputError("inspection.triangle_without_vertex",
                                 "triangle {triangle} names a vertex that is not there",
                                 {{"triangle", t}});
            used[a] = 1;
            uses.push_back({edge_key(a, b), t, a < b});
        }
        const Vec3 a = vertices[v[0]] - origin, b = vertices[v[1]] - origin,
                   c = vertices[v[2]] - origin;
        check.volume += a.dot(b.cross(c)) / 6.0;
        check.area += 0.5 * (b - a).cross(c - a).norm();
    }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
        return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
    });
    DisjointSets pieces(triangles.size());
    std::size_t edges = 0;
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t j = i + 1;
        for (; j < uses.size() && uses[j].edge == uses[i].edge; ++j)
            pieces.join(uses[i].triangle, uses[j].triangle);
        ++edges;
        if (j - i == 1) ++check.border_edges;
        if (j - i > 2) ++check.non_manifold_edges;
        if (j - i == 2 && uses[i].forward == uses[i + 1].forward) ++check.turned_edges;
        i = j;
    }
    for (std::uint32_t t = 0; t < pieces.size(); ++t) check.components += pieces.find(t) == t;
    check.euler = std::count(used.begin(), used.end(), 1) - static_cast<long long>(edges) +
                  static_cast<long long>(triangles.size());
    return check;
}

}  // namespace beltgrinding

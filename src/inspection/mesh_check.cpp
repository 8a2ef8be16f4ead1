#include <algorithm>
#include <array>
#include <numeric>

#include "beltgrinding/error.h"
#include "inspection/ground_mesh.h"

namespace beltgrinding {
namespace {

/// One triangle's use of an edge; the lowest bit tells its direction.
struct Use {
    std::uint64_t edge;
    std::uint32_t triangle;
    bool forward;
};

std::uint32_t find(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

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
            uses.push_back({std::uint64_t(std::min(a, b)) << 32U | std::max(a, b), t, a < b});
        }
        const Vec3 a = vertices[v[0]] - origin, b = vertices[v[1]] - origin,
                   c = vertices[v[2]] - origin;
        check.volume += a.dot(b.cross(c)) / 6.0;
        check.area += 0.5 * (b - a).cross(c - a).norm();
    }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
        return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
    });
    std::vector<std::uint32_t> parent(triangles.size());
    std::iota(parent.begin(), parent.end(), 0U);
    std::size_t edges = 0;
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t j = i + 1;
        for (; j < uses.size() && uses[j].edge == uses[i].edge; ++j) {
            const std::uint32_t a = find(parent, uses[i].triangle),
                                b = find(parent, uses[j].triangle);
            parent[std::max(a, b)] = std::min(a, b);
        }
        ++edges;
        if (j - i == 1) ++check.border_edges;
        if (j - i > 2) ++check.non_manifold_edges;
        if (j - i == 2 && uses[i].forward == uses[i + 1].forward) ++check.turned_edges;
        i = j;
    }
    for (std::uint32_t t = 0; t < parent.size(); ++t) check.components += parent[t] == t;
    check.euler = std::count(used.begin(), used.end(), 1) - static_cast<long long>(edges) +
                  static_cast<long long>(triangles.size());
    return check;
}

}  // namespace beltgrinding

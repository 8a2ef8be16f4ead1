#include "geodesic.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "mesh/topology.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kCancelEvery = 1 << 12;  // vertices

/// Distance at `c` from those at `a` and `b`: the plane wave through the triangle if it comes from
/// between them, else the shorter edge.
double update(const Vec3& c, const Vec3& a, double ta, const Vec3& b, double tb) {
    const Vec3 u = a - c, v = b - c;
    const double along = std::min(ta + u.norm(), tb + v.norm());
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v);
    const double det = uu * vv - uv * uv;
    if (!(det > 1e-12 * uu * vv)) return along;
    // The inverse of the edges' Gram matrix.
    const double q11 = vv / det, q12 = -uv / det, q22 = uu / det;
    const double one = q11 + 2 * q12 + q22;
    const double mixed = (q11 + q12) * ta + (q12 + q22) * tb;
    const double rest = q11 * ta * ta + 2 * q12 * ta * tb + q22 * tb * tb - 1.0;
    const double root = mixed * mixed - one * rest;
    if (root < 0) return along;
    const double t = (mixed + std::sqrt(root)) / one;
    const bool between = q11 * (ta - t) + q12 * (tb - t) < 0 && q12 * (ta - t) + q22 * (tb - t) < 0;
    return between ? std::min(t, along) : along;
}

}  // namespace

void march(const std::vector<Vec3>& point, const std::vector<Triangle>& triangles,
           std::vector<double>& distance, const RunContext& context) {
    const VertexTriangles around(point.size(), triangles);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    for (std::uint32_t i = 0; i < point.size(); ++i)
        if (std::isfinite(distance[i])) front.push({distance[i], i});
    std::vector<char> known(point.size(), 0);
    std::size_t done = 0;
    while (!front.empty()) {
        const auto [value, vertex] = front.top();
        front.pop();
        if (known[vertex] || value > distance[vertex]) continue;
        known[vertex] = 1;
        if (++done % kCancelEvery == 0) context.throw_if_cancelled();
        for (const std::uint32_t near : around.of(vertex)) {
            const Triangle& t = triangles[near];
            const auto at =
                static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
            for (std::size_t step = 1; step < 3; ++step) {
                const std::uint32_t c = t[(at + step) % 3], b = t[(at + 3 - step) % 3];
                if (known[c]) continue;
                const double reached =
                    known[b] ? update(point[c], point[vertex], value, point[b], distance[b])
                             : value + (point[c] - point[vertex]).norm();
                if (reached < distance[c]) {
                    distance[c] = reached;
                    front.push({reached, c});
                }
            }
        }
    }
}

}  // namespace beltgrinding

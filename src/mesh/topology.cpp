#include "mesh/topology.h"

namespace beltgrinding {

VertexTriangles::VertexTriangles(std::size_t vertices, const std::vector<Triangle>& triangles)
    : first_(vertices + 1, 0), around_(3 * triangles.size()) {
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t) ++first_[v + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (const std::uint32_t v : triangles[t]) around_[next[v]++] = t;
}

std::optional<TriangleCrossing> triangle_crossing(const std::array<bool, 3>& above) {
    if (above[0] == above[1] && above[1] == above[2]) return std::nullopt;
    TriangleCrossing crossing{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (above[k] && !above[next]) crossing.leaves = {k, next};
        if (!above[k] && above[next]) crossing.enters = {k, next};
    }
    return crossing;
}

}  // namespace beltgrinding

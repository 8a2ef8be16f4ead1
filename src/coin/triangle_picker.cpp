#include "coin/triangle_picker.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kRun = 128;      // triangles in a box: 16,000 boxes for a million samples
constexpr std::size_t kBoxBlock = 64;  // boxes of one task
constexpr float kSlack = 1e-5F;  // of a box's slabs, against rounding: a flat one is thin as paper

/// Whether the ray meets the box (slabs; Kay and Kajiya, SIGGRAPH 1986).
bool meets(const Eigen::AlignedBox3f& box, const Vec3f& origin, const Vec3f& direction) {
    float near = 0.0F, far = std::numeric_limits<float>::max();
    for (int k = 0; k < 3; ++k) {
        const float low = box.min()[k] - origin[k], high = box.max()[k] - origin[k];
        if (direction[k] == 0.0F) {
            if (low > 0.0F || high < 0.0F) return false;
            continue;
        }
        const auto [a, b] = std::minmax({low / direction[k], high / direction[k]});
        near = std::max(near, a);
        far = std::min(far, b);
    }
    return near <= far * (1.0F + kSlack) + kSlack;
}

}  // namespace

void TrianglePicker::update(const std::vector<Vec3f>& vertices,
                            const std::vector<Triangle>& triangles) {
    boxes_.assign((triangles.size() + kRun - 1) / kRun, {});
    parallel_blocks(boxes_.size(), kBoxBlock, RunContext(),
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t b = begin; b < end; ++b) {
                            const std::size_t last = std::min((b + 1) * kRun, triangles.size());
                            for (std::size_t i = b * kRun; i < last; ++i) {
                                for (const std::uint32_t v : triangles[i])
                                    boxes_[b].extend(vertices[v]);
                            }
                        }
                    });
}

std::vector<TriangleHit> TrianglePicker::pick(const std::vector<Vec3f>& vertices,
                                              const std::vector<Triangle>& triangles,
                                              const Vec3f& origin, const Vec3f& direction) const {
    std::vector<TriangleHit> hits;
    const Eigen::Vector3d o = origin.cast<double>(), d = direction.cast<double>();
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
        if (!meets(boxes_[b], origin, direction)) continue;
        const std::size_t last = std::min((b + 1) * kRun, triangles.size());
        for (std::size_t i = b * kRun; i < last; ++i) {
            // Moeller and Trumbore, Journal of Graphics Tools 2(1), 1997. In double: samples lie
            // thousandths of the eye's distance apart.
            const Eigen::Vector3d a = vertices[triangles[i][0]].cast<double>();
            const Eigen::Vector3d ab = vertices[triangles[i][1]].cast<double>() - a;
            const Eigen::Vector3d ac = vertices[triangles[i][2]].cast<double>() - a;
            const Eigen::Vector3d p = d.cross(ac);
            const double det = ab.dot(p);
            if (det == 0.0) continue;
            const Eigen::Vector3d from_a = o - a;
            const double u = from_a.dot(p) / det;
            if (!(u >= 0.0 && u <= 1.0)) continue;
            const Eigen::Vector3d q = from_a.cross(ab);
            const double v = d.dot(q) / det;
            const double t = ac.dot(q) / det;
            if (!(v >= 0.0 && u + v <= 1.0 && t >= 0.0)) continue;
            hits.push_back({static_cast<std::uint32_t>(i), static_cast<float>(t),
                            Eigen::Vector3d(1.0 - u - v, u, v).cast<float>()});
        }
    }
    return hits;
}

}  // namespace beltgrinding

#include "heightfield/height_lookup.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace beltgrinding {
namespace {

constexpr double kCellSpacings = 2.0;  // of the samples, a cell's edge
constexpr int kMostRings = 4;          // of cells round the point's own
constexpr int kCellBits = 21;          // of a cell's coordinate
constexpr int kMostCells = (1 << kCellBits) - 1;

}  // namespace

Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double v = d1 - d3 > 0 ? d1 / (d1 - d3) : 0.0;
        return {1 - v, v, 0};
    }
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double w = d2 - d6 > 0 ? d2 / (d2 - d6) : 0.0;
        return {1 - w, 0, w};
    }
    const double va = d3 * d6 - d5 * d4;
    const double e = d4 - d3, f = d5 - d6;
    if (va <= 0 && e >= 0 && f >= 0) {
        const double w = e + f > 0 ? e / (e + f) : 0.0;
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return {1, 0, 0};
    return {va / sum, vb / sum, vc / sum};
}

HeightLookup::HeightLookup(const HeightField& field) : field_(field) {
    Box box;
    for (const Vec3& p : field.point) box.extend(p);
    if (box.isEmpty()) return;
    origin_ = box.min();
    size_ = std::max(kCellSpacings * field.spacing, box.sizes().maxCoeff() / kMostCells);
    for (std::uint32_t t = 0; t < field.triangles.size(); ++t) {
        Box around;
        for (const std::uint32_t s : field.triangles[t]) around.extend(field.point[s]);
        const Eigen::Vector3i low = coordinates(around.min()), high = coordinates(around.max());
        const std::uint32_t face = field.face[field.triangles[t][0]];
        for (int z = low.z(); z <= high.z(); ++z)
            for (int y = low.y(); y <= high.y(); ++y)
                for (int x = low.x(); x <= high.x(); ++x)
                    entries_.push_back({face, cell_of({x, y, z}), t});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.face, a.cell, a.triangle) < std::tie(b.face, b.cell, b.triangle);
    });
}

HeightLookup::Cell HeightLookup::cell_of(const Eigen::Vector3i& c) const {
    return (Cell(c.x()) << 2 * kCellBits) | (Cell(c.y()) << kCellBits) | Cell(c.z());
}

Eigen::Vector3i HeightLookup::coordinates(const Vec3& p) const {
    const Vec3 cells = (p - origin_) / size_;
    return cells.array().floor().max(-1e9).min(1e9).cast<int>();
}

void HeightLookup::search(std::uint32_t face, const Eigen::Vector3i& c, const Vec3& point,
                          std::optional<Place>& best) const {
    if (c.minCoeff() < 0 || c.maxCoeff() > kMostCells) return;
    const std::pair key(face, cell_of(c));
    auto at = std::lower_bound(
        entries_.begin(), entries_.end(), key,
        [](const Entry& e, const auto& k) { return std::pair(e.face, e.cell) < k; });
    for (; at != entries_.end() && std::pair(at->face, at->cell) == key; ++at) {
        const Triangle& t = field_.triangles[at->triangle];
        const Vec3 &p = field_.point[t[0]], &q = field_.point[t[1]], &r = field_.point[t[2]];
        const Vec3 w = nearest_on_triangle(point, p, q, r);
        const double distance = (w.x() * p + w.y() * q + w.z() * r - point).norm();
        if (!best || distance < best->distance) best = {t, w, distance};
    }
}

std::optional<HeightLookup::Place> HeightLookup::find(std::uint32_t face, const Vec3& point) const {
    std::optional<Place> best;
    if (!point.allFinite()) return best;
    const Eigen::Vector3i own = coordinates(point);
    const Vec3 inside = point - origin_ - size_ * own.cast<double>();
    const double wall = std::min(inside.minCoeff(), size_ - inside.maxCoeff());
    for (int ring = 0; ring <= kMostRings; ++ring) {
        // All cells of smaller rings are known: nothing nearer than this can be outside of them.
        if (best && best->distance <= wall + (ring - 1) * size_) break;
        for (int z = -ring; z <= ring; ++z)
            for (int y = -ring; y <= ring; ++y) {
                const bool shell = std::max(std::abs(y), std::abs(z)) == ring;
                for (int x = -ring; x <= ring; x += shell ? 1 : std::max(1, 2 * ring))
                    search(face, own + Eigen::Vector3i(x, y, z), point, best);
            }
    }
    return best;
}

std::optional<double> HeightLookup::height(const Place& place) const {
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t s = place.samples[k];
        if ((field_.flags[s] & kMissed) != 0) continue;
        const double w = place.weight[static_cast<Eigen::Index>(k)];
        sum += w * field_.height[s];
        weight += w;
    }
    if (!(weight > 1e-9)) return std::nullopt;
    return sum / weight;
}

Vec3 HeightLookup::lean(const Place& place) const {
    Vec3 sum = Vec3::Zero();
    if (field_.rays.empty()) return sum;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t s = place.samples[static_cast<std::size_t>(k)];
        sum += place.weight[k] * (field_.rays[s] - field_.normal[s]).cast<double>();
    }
    return sum;
}

}  // namespace beltgrinding

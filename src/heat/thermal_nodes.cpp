#include "heat/thermal_nodes.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "beltgrinding/error.h"
#include "point_hash.h"

namespace beltgrinding {
namespace {

constexpr float kSameSide = 0.5f;    // least cosine between normals that heat flows between
constexpr float kOtherSide = -0.5f;  // greatest, of a section's two sides
constexpr double kLeastArea = 0.1;   // of spacing^2, of a cell
constexpr int kHalvings = 24;        // for the border of a cell

/// A convex polygon in the plane, whose sides know what they are borders to.
struct Polygon {
    std::vector<Eigen::Vector2d> corner;
    std::vector<std::int64_t> side;  // from each corner to the next; negative: to nothing

    double area() const {
        double sum = 0.0;
        for (std::size_t k = 0; k < corner.size(); ++k) {
            const Eigen::Vector2d &a = corner[k], &b = corner[(k + 1) % corner.size()];
            sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
        }
        return sum;
    }
    /// Keeps what has direction . x <= limit.
    Polygon cut(const Eigen::Vector2d& direction, double limit, std::int64_t number) const {
        Polygon kept;
        for (std::size_t k = 0; k < corner.size(); ++k) {
            const Eigen::Vector2d &a = corner[k], &b = corner[(k + 1) % corner.size()];
            const double at_a = direction.dot(a) - limit, at_b = direction.dot(b) - limit;
            if (at_a <= 0.0) {
                kept.corner.push_back(a);
                kept.side.push_back(side[k]);
            }
            if ((at_a <= 0.0) == (at_b <= 0.0)) continue;
            kept.corner.emplace_back(a + at_a / (at_a - at_b) * (b - a));
            kept.side.push_back(at_a <= 0.0 ? number : side[k]);
        }
        return kept;
    }
    bool open() const {
        return std::any_of(side.begin(), side.end(), [](std::int64_t s) { return s < 0; });
    }
};

/// The cell of a node between the others, round it as the origin.
class Cell {
  public:
    Cell(const ThermalNodes& nodes, std::uint32_t node, const std::vector<std::uint32_t>& near)
        : nodes_(nodes), node_(node) {
        const double h = nodes.spacing;
        polygon_.corner = {{-h, -h}, {h, -h}, {h, h}, {-h, h}};
        polygon_.side = {-1, -1, -1, -1};
        const Vec3 n = nodes.normal[node].cast<double>();
        const Vec3 e = n.unitOrthogonal(), f = n.cross(e);
        struct Other {
            double distance;
            Eigen::Vector2d at;
            std::uint32_t number;
        };
        std::vector<Other> others;
        for (const std::uint32_t k : near) {
            if (k == node || nodes.normal[k].dot(nodes.normal[node]) < kSameSide) continue;
            const Vec3 way = nodes.point[k] - nodes.point[node];
            const double distance = way.norm();
            const Eigen::Vector2d flat(way.dot(e), way.dot(f));
            // What lies behind or before the surface is another layer of it.
            if (distance > 2.0 * h || flat.norm() < 0.5 * distance) continue;
            others.push_back({distance, flat * (distance / flat.norm()), k});
        }
        std::sort(others.begin(), others.end(), [](const Other& a, const Other& b) {
            return std::tie(a.distance, a.number) < std::tie(b.distance, b.number);
        });
        for (const Other& other : others) {
            mean_ += other.at / other.distance;
            polygon_ = polygon_.cut(other.at / other.distance, 0.5 * other.distance, other.number);
        }
    }
    /// On the border of what is sampled the cell ends where it has the area of its samples, mm2.
    void end_at(double area) {
        if (!polygon_.open() || mean_.norm() == 0.0) return;
        const Eigen::Vector2d out = -mean_.normalized();
        double low = 0.0, high = 2.0 * nodes_.spacing;
        for (int k = 0; k < kHalvings; ++k) {
            const double middle = 0.5 * (low + high);
            (polygon_.cut(out, middle, -1).area() < area ? low : high) = middle;
        }
        polygon_ = polygon_.cut(out, low, -1);
    }
    double area() const { return polygon_.area(); }
    /// Calls visit(neighbour, length of the border over the distance).
    template <class Visit>
    void for_borders(Visit visit) const {
        const auto& corner = polygon_.corner;
        for (std::size_t k = 0; k < corner.size(); ++k) {
            if (polygon_.side[k] < 0) continue;
            const auto other = static_cast<std::uint32_t>(polygon_.side[k]);
            const double length = (corner[(k + 1) % corner.size()] - corner[k]).norm();
            visit(other, length / (nodes_.point[other] - nodes_.point[node_]).norm());
        }
    }

  private:
    const ThermalNodes& nodes_;
    std::uint32_t node_;
    Polygon polygon_;
    Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
};

/// The nearest of `near` on the same side; kNone if all are `most` mm away or more.
std::uint32_t nearest(const ThermalNodes& nodes, const std::vector<std::uint32_t>& near,
                      const Vec3& point, const Vec3f& normal, double most) {
    std::uint32_t found = ThermalNodes::kNone;
    double least = most * most;
    for (const std::uint32_t k : near) {
        const double away = (nodes.point[k] - point).squaredNorm();
        if (away < least && nodes.normal[k].dot(normal) >= kSameSide) least = away, found = k;
    }
    return found;
}

PointHash hash_of(const ThermalNodes& nodes) {
    PointHash hash(nodes.spacing);
    for (std::uint32_t k = 0; k < nodes.size(); ++k) hash.add(k, nodes.point[k]);
    return hash;
}

void choose(ThermalNodes& nodes, const HeightField& field) {
    PointHash hash(nodes.spacing);
    std::vector<std::uint32_t> near;
    PointHash::Cube looked{};
    bool any = false;
    std::uint32_t last = ThermalNodes::kNone;  // that covered a sample
    const auto covers = [&](std::uint32_t k, std::uint32_t s) {
        return (nodes.point[k] - field.point[s]).squaredNorm() < nodes.spacing * nodes.spacing &&
               nodes.normal[k].dot(field.normal[s]) >= kSameSide;
    };
    std::vector<std::uint32_t> covering(field.size());
    for (std::uint32_t s = 0; s < field.size(); ++s) {
        if (last == ThermalNodes::kNone || !covers(last, s)) {
            const PointHash::Cube cube = hash.cube(field.point[s]);
            if (!any || cube != looked) hash.near(looked = cube, 1, near);
            any = true;
            last = nearest(nodes, near, field.point[s], field.normal[s], nodes.spacing);
        }
        if (last == ThermalNodes::kNone) {
            last = static_cast<std::uint32_t>(nodes.size());
            nodes.sample.push_back(s);
            nodes.point.push_back(field.point[s]);
            nodes.normal.push_back(field.normal[s]);
            hash.add(last, field.point[s]);
            near.push_back(last);
        }
        covering[s] = last;
    }
    // The nearest is less than twice the spacing from one that covers.
    std::vector<std::size_t> first = {0};
    std::vector<std::uint32_t> others;
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        hash.near(hash.cube(nodes.point[k]), 2, near);
        std::sort(near.begin(), near.end());
        for (const std::uint32_t other : near) {
            const double away = (nodes.point[other] - nodes.point[k]).norm();
            if (other != k && away < 2.0 * nodes.spacing) others.push_back(other);
        }
        first.push_back(others.size());
    }
    nodes.node_of = std::move(covering);
    for (std::uint32_t s = 0; s < field.size(); ++s) {
        const std::uint32_t from = nodes.node_of[s];
        double least = (nodes.point[from] - field.point[s]).squaredNorm();
        for (std::size_t e = first[from]; e < first[from + 1]; ++e) {
            const std::uint32_t other = others[e];
            const double away = (nodes.point[other] - field.point[s]).squaredNorm();
            if (away < least && nodes.normal[other].dot(field.normal[s]) >= kSameSide)
                least = away, nodes.node_of[s] = other;
        }
    }
}

void join(ThermalNodes& nodes, const HeightField& field) {
    std::vector<double> sampled(nodes.size(), 0.0);
    for (std::size_t s = 0; s < field.size(); ++s) sampled[nodes.node_of[s]] += field.area[s];
    const PointHash hash = hash_of(nodes);
    std::vector<std::uint32_t> near;
    std::vector<std::tuple<std::uint32_t, std::uint32_t, float>> borders;
    nodes.area.resize(nodes.size());
    const double least = kLeastArea * nodes.spacing * nodes.spacing;
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        hash.near(hash.cube(nodes.point[k]), 2, near);
        Cell cell(nodes, k, near);
        cell.end_at(std::max(sampled[k], least));
        nodes.area[k] = static_cast<float>(std::max(cell.area(), least));
        // Both cells have a say, which differ where the surface is bent.
        cell.for_borders([&](std::uint32_t other, double share) {
            const auto half = static_cast<float>(0.5 * share);
            borders.emplace_back(k, other, half);
            borders.emplace_back(other, k, half);
        });
    }
    std::sort(borders.begin(), borders.end());
    nodes.first.assign(nodes.size() + 1, 0);
    std::uint32_t from = ThermalNodes::kNone;
    for (const auto& [a, b, share] : borders) {
        if (a == from && nodes.neighbour.back() == b) {
            nodes.conductance.back() += share;
            continue;
        }
        from = a;
        nodes.neighbour.push_back(b);
        nodes.conductance.push_back(share);
        ++nodes.first[a + 1];
    }
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes.first[k + 1] += nodes.first[k];
}

}  // namespace

std::size_t ThermalNodes::bytes() const {
    const std::size_t each = 2 * sizeof(std::uint32_t) + sizeof(Vec3) + sizeof(Vec3f) +
                             3 * sizeof(float) + 2 * sizeof(DepthModes::Weights);
    return size() * each + node_of.size() * sizeof(std::uint32_t) +
           neighbour.size() * (sizeof(std::uint32_t) + sizeof(float));
}

ThermalNodes make_thermal_nodes(const HeightField& field, double spacing) {
    ThermalNodes nodes;
    nodes.spacing = spacing;
    choose(nodes, field);
    join(nodes, field);
    set_thickness(nodes, std::vector<float>(nodes.size(), NAN));
    return nodes;
}

void set_thickness(ThermalNodes& nodes, const std::vector<float>& thickness) {
    if (thickness.size() != nodes.size()) {
        throw InputError("heat.thickness_size",
                         "the thickness has {count} values; {nodes} nodes need one each",
                         {{"count", thickness.size()}, {"nodes", nodes.size()}});
    }
    nodes.thickness = thickness;
    nodes.opposite.assign(nodes.size(), ThermalNodes::kNone);
    nodes.own.resize(nodes.size());
    nodes.other.resize(nodes.size());
    const PointHash hash = hash_of(nodes);
    std::vector<std::uint32_t> near;
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        float& d = nodes.thickness[k];
        if (d <= 0.0f) throw InputError("heat.thickness", "a section has no thickness");
        if (!(d < DepthModes::kThick)) d = HUGE_VALF;
        nodes.own[k] = DepthModes::own(d);
        nodes.other[k] = DepthModes::opposite(d);
        if (!std::isfinite(d)) continue;
        const Vec3 inwards = -nodes.normal[k].cast<double>();
        const Vec3 there = nodes.point[k] + d * inwards;
        hash.near(hash.cube(there), 2, near);
        double least = 2.0 * nodes.spacing;
        for (const std::uint32_t other : near) {
            const double away = (nodes.point[other] - there).norm();
            if (away < least && nodes.normal[other].dot(nodes.normal[k]) <= kOtherSide)
                least = away, nodes.opposite[k] = other;
        }
    }
}

}  // namespace beltgrinding

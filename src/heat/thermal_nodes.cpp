#include "heat/thermal_nodes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "point_hash.h"
#include "voronoi_cell.h"

namespace beltgrinding {
namespace {

constexpr float kSameSide = 0.5f;     // least cosine between normals that heat flows between
constexpr float kOtherSide = -0.5f;   // greatest, of a section's two sides
constexpr double kLeastArea = 0.1;    // of spacing^2, of a cell
constexpr int kHalvings = 24;         // for the border of a cell
constexpr std::size_t kBlock = 1024;  // of nodes, for a thread

/// Nodes near each, and how far they are.
struct Near {
    struct Other {
        std::uint32_t number;
        double distance;  // mm
    };
    std::vector<std::size_t> first;
    std::vector<Other> others;  // by their distance, then their number

    std::span<const Other> of(std::uint32_t node) const {
        return {others.data() + first[node], others.data() + first[node + 1]};
    }
};

/// Calls visit(k) for all nodes of blocks, on all threads.
template <class Visit>
void for_nodes(std::size_t count, Visit visit) {
    parallel_blocks(count, kBlock, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) visit(static_cast<std::uint32_t>(k));
    });
}

PointHash hash_of(const ThermalNodes& nodes, double side) {
    PointHash hash(side);
    for (std::uint32_t k = 0; k < nodes.size(); ++k) hash.add(k, nodes.point[k]);
    return hash;
}

/// All up to twice the spacing away.
Near find_near(const ThermalNodes& nodes) {
    const double reach = 2.0 * nodes.spacing;
    const PointHash hash = hash_of(nodes, reach);
    const std::size_t blocks = (nodes.size() + kBlock - 1) / kBlock;
    std::vector<std::vector<Near::Other>> parts(blocks);
    Near near;
    near.first.assign(nodes.size() + 1, 0);
    parallel_blocks(nodes.size(), kBlock, {}, [&](std::size_t begin, std::size_t end) {
        std::vector<Near::Other>& part = parts[begin / kBlock];
        std::vector<std::uint32_t> found;
        PointHash::Cube looked{};
        for (std::size_t k = begin; k < end; ++k) {
            const PointHash::Cube cube = hash.cube(nodes.point[k]);
            if (k == begin || cube != looked) hash.near(looked = cube, 1, found);
            const std::size_t before = part.size();
            for (const std::uint32_t other : found) {
                const double squared = (nodes.point[other] - nodes.point[k]).squaredNorm();
                if (other != k && squared <= 1.0001 * reach * reach) {
                    const double distance = std::sqrt(squared);
                    if (distance <= reach) part.push_back({other, distance});
                }
            }
            std::sort(part.begin() + static_cast<std::ptrdiff_t>(before), part.end(),
                      [](const Near::Other& a, const Near::Other& b) {
                          return std::tie(a.distance, a.number) < std::tie(b.distance, b.number);
                      });
            near.first[k + 1] = part.size() - before;
        }
    });
    for (std::size_t k = 0; k < nodes.size(); ++k) near.first[k + 1] += near.first[k];
    near.others.reserve(near.first.back());
    for (const auto& part : parts) near.others.insert(near.others.end(), part.begin(), part.end());
    return near;
}

/// The cell of a node between those near it, round it as the origin. On the border of what is
/// sampled it ends where it has the area of its samples, `sampled` mm2.
VoronoiCell cell_of(const ThermalNodes& nodes, std::uint32_t node,
                    std::span<const Near::Other> near, double sampled) {
    VoronoiCell cell(nodes.spacing);
    const Vec3 n = nodes.normal[node].cast<double>();
    const Vec3 e = n.unitOrthogonal(), f = n.cross(e);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    double radius = cell.radius();
    for (const Near::Other& other : near) {
        if (nodes.normal[other.number].dot(nodes.normal[node]) < kSameSide) continue;
        const Vec3 way = nodes.point[other.number] - nodes.point[node];
        const Eigen::Vector2d flat(way.dot(e), way.dot(f));
        const double length = flat.norm();
        // What lies behind or before the surface is another layer of it.
        if (length < 0.5 * other.distance) continue;
        mean += flat / length;
        if (0.5 * other.distance > radius) continue;
        cell.cut(flat / length, 0.5 * other.distance, other.number);
        radius = cell.radius();
    }
    if (!cell.open() || mean.norm() == 0.0) return cell;
    const Eigen::Vector2d out = -mean.normalized();
    const auto ended = [&](double at) {
        VoronoiCell one = cell;
        one.cut(out, at, VoronoiCell::kNothing);
        return one;
    };
    double low = 0.0, high = 2.0 * nodes.spacing;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (ended(middle).area() < sampled ? low : high) = middle;
    }
    return ended(low);
}

void choose(ThermalNodes& nodes, const HeightField& field) {
    PointHash hash(2.0 * nodes.spacing);
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
            const PointHash::Cube corner = hash.corner(field.point[s]);
            if (!any || corner != looked) hash.near_corner(looked = corner, near);
            any = true;
            // Any will do: `move_to_nearest` finds the nearest.
            const auto found = std::find_if(near.begin(), near.end(),
                                            [&](std::uint32_t k) { return covers(k, s); });
            last = found != near.end() ? *found : ThermalNodes::kNone;
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
    nodes.node_of = std::move(covering);
}

/// The nearest is less than twice the spacing from one that covers.
void move_to_nearest(ThermalNodes& nodes, const HeightField& field, const Near& near) {
    for_nodes(field.size(), [&](std::uint32_t s) {
        const std::uint32_t from = nodes.node_of[s];
        double least = (nodes.point[from] - field.point[s]).squaredNorm();
        const double there = std::sqrt(least);
        double reach = 2.0 * there;
        for (const auto& [other, distance] : near.of(from)) {
            if (distance > reach) break;
            const double away = (nodes.point[other] - field.point[s]).squaredNorm();
            if (away >= least || nodes.normal[other].dot(field.normal[s]) < kSameSide) continue;
            least = away;
            nodes.node_of[s] = other;
            reach = there + std::sqrt(least);
        }
    });
}

void join(ThermalNodes& nodes, const HeightField& field, const Near& near) {
    std::vector<double> sampled(nodes.size(), 0.0);
    for (std::size_t s = 0; s < field.size(); ++s) sampled[nodes.node_of[s]] += field.area[s];
    struct Border {
        std::uint32_t other;
        float half;
    };
    const std::size_t blocks = (nodes.size() + kBlock - 1) / kBlock;
    std::vector<std::vector<Border>> parts(blocks);
    std::vector<std::uint32_t> count(nodes.size());  // of each one's own cell
    nodes.area.resize(nodes.size());
    const double least = kLeastArea * nodes.spacing * nodes.spacing;
    for_nodes(nodes.size(), [&](std::uint32_t k) {
        const VoronoiCell cell = cell_of(nodes, k, near.of(k), std::max(sampled[k], least));
        nodes.area[k] = static_cast<float>(std::max(cell.area(), least));
        auto& part = parts[k / kBlock];
        const std::size_t before = part.size();
        cell.for_sides([&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::int64_t side) {
            if (side < 0) return;
            const auto other = static_cast<std::uint32_t>(side);
            const double share = (b - a).norm() / (nodes.point[other] - nodes.point[k]).norm();
            part.push_back({other, static_cast<float>(0.5 * share)});
        });
        count[k] = static_cast<std::uint32_t>(part.size() - before);
    });
    // Both cells have a say, which differ where the surface is bent.
    std::vector<std::size_t> end(nodes.size() + 1, 0);
    for (std::uint32_t k = 0; k < nodes.size(); ++k) end[k + 1] = count[k];
    for (const auto& part : parts)
        for (const Border& border : part) ++end[border.other + 1];
    for (std::size_t k = 0; k < nodes.size(); ++k) end[k + 1] += end[k];
    std::vector<Border> borders(end.back());
    std::size_t at = 0;  // in a part
    const std::vector<std::size_t> begin(end.begin(), end.end() - 1);
    end.pop_back();
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        if (k % kBlock == 0) at = 0;
        for (std::uint32_t n = 0; n < count[k]; ++n, ++at) {
            const Border border = parts[k / kBlock][at];
            borders[end[k]++] = border;
            borders[end[border.other]++] = {k, border.half};
        }
    }
    nodes.first.assign(1, 0);
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        const auto from = borders.begin() + static_cast<std::ptrdiff_t>(begin[k]),
                   to = borders.begin() + static_cast<std::ptrdiff_t>(end[k]);
        std::sort(from, to, [](const Border& a, const Border& b) { return a.other < b.other; });
        for (auto border = from; border != to; ++border) {
            if (border != from && border->other == nodes.neighbour.back()) {
                nodes.conductance.back() += border->half;
                continue;
            }
            nodes.neighbour.push_back(border->other);
            nodes.conductance.push_back(border->half);
        }
        nodes.first.push_back(static_cast<std::uint32_t>(nodes.neighbour.size()));
    }
}

/// By Taylor's series: the mean of cos^4 is 3 / 8, and 4! = 24.
double dispersion_of(const ThermalNodes& nodes) {
    double sum = 0.0;
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        double fourth = 0.0;
        for (std::uint32_t e = nodes.first[k]; e < nodes.first[k + 1]; ++e) {
            const Vec3 way = nodes.point[nodes.neighbour[e]] - nodes.point[k];
            fourth += nodes.conductance[e] * way.squaredNorm() * way.squaredNorm();
        }
        sum += fourth / (64.0 * nodes.area[k]);
    }
    return sum / static_cast<double>(nodes.size());
}

}  // namespace

std::vector<float> ThermalNodes::depth() const {
    std::vector<float> found(size());
    for (std::size_t k = 0; k < size(); ++k) found[k] = 1.0f / own[k].modes[0];
    return found;
}

std::size_t ThermalNodes::bytes() const {
    const std::size_t each = 2 * sizeof(std::uint32_t) + sizeof(Vec3) + sizeof(Vec3f) +
                             3 * sizeof(float) + 2 * sizeof(DepthModes::Weights);
    return size() * each + node_of.size() * sizeof(std::uint32_t) +
           neighbour.size() * (sizeof(std::uint32_t) + sizeof(float));
}

ThermalNodes make_thermal_nodes(const HeightField& field, double spacing, double longer) {
    ThermalNodes nodes;
    nodes.longer = longer;
    nodes.spacing = spacing;
    choose(nodes, field);
    const Near near = find_near(nodes);
    move_to_nearest(nodes, field, near);
    join(nodes, field, near);
    nodes.dispersion = dispersion_of(nodes);
    set_thickness(nodes, std::vector<float>(nodes.size(), NAN));
    return nodes;
}

std::vector<float> sectional_conductances(const ThermalNodes& nodes,
                                          const std::vector<float>& depth) {
    std::vector<float> found(nodes.conductance.size());
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        for (std::uint32_t e = nodes.first[k]; e < nodes.first[k + 1]; ++e) {
            const double one = depth[k], other = depth[nodes.neighbour[e]];
            found[e] = static_cast<float>(nodes.conductance[e] * 2.0 * one * other / (one + other));
        }
    }
    return found;
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
    const double reach = 2.0 * nodes.spacing;
    std::optional<PointHash> hash;
    for (float& d : nodes.thickness) {
        if (d <= 0.0f) throw InputError("heat.thickness", "a section has no thickness");
        if (!(d < nodes.longer * DepthModes::kThick)) d = HUGE_VALF;
        if (std::isfinite(d) && !hash) hash = hash_of(nodes, reach);
    }
    parallel_blocks(nodes.size(), kBlock, {}, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> near;
        for (std::size_t k = begin; k < end; ++k) {
            const float d = nodes.thickness[k];
            nodes.own[k] = DepthModes::own(d, nodes.longer);
            nodes.other[k] = DepthModes::opposite(d, nodes.longer);
            if (!std::isfinite(d)) continue;
            const Vec3 there = nodes.point[k] - d * nodes.normal[k].cast<double>();
            hash->near(hash->cube(there), 1, near);
            double least = reach;
            for (const std::uint32_t other : near) {
                const double away = (nodes.point[other] - there).norm();
                if (away < least && nodes.normal[other].dot(nodes.normal[k]) <= kOtherSide)
                    least = away, nodes.opposite[k] = other;
            }
        }
    });
}

}  // namespace beltgrinding

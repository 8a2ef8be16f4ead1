#include "heat/thermal_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr int kMostLevels = 8;
constexpr std::size_t kFewest = 64;  // nodes of a level
constexpr double kFewer = 0.75;      // of the nodes below, or a level is worth nothing
constexpr std::size_t kBlock = 512;  // of nodes, for a thread
constexpr double kWhole = 0.05;      // of a cell's area, that it may differ by
constexpr int kRounds = 2;           // in which nodes move to the middle of what is theirs
constexpr double kNoBorder = 1e-3;   // of conductances, which are about 1
constexpr double kLeastTurn = 1e-9;  // of a triangle, over the squares of its sides
constexpr std::uint32_t kNone = ThermalNodes::kNone;

using Plane = Eigen::Vector2d;

/// What a level is made from: `ThermalNodes` or a level.
struct Finer {
    const std::vector<Vec3>& point;
    const std::vector<Vec3f>& normal;
    const std::vector<float>& area;
    const std::vector<float>& depth;  // mm
    const std::vector<std::uint32_t>& first;
    const std::vector<std::uint32_t>& neighbour;
    const std::vector<float>& conductance;
    const std::vector<float>& sectional;
    double spacing;  // mm
};

struct Border {
    std::uint32_t other;
    double conductance, sectional = 0.0;
};
using Borders = std::vector<std::vector<Border>>;  // by node, ascending

void add(std::vector<Border>& borders, std::uint32_t other, double conductance,
         double sectional = 0.0) {
    for (Border& border : borders) {
        if (border.other != other) continue;
        border.conductance += conductance;
        border.sectional += sectional;
        return;
    }
    borders.push_back({other, conductance, sectional});
}

bool has(const std::vector<Border>& borders, std::uint32_t other) {
    return std::any_of(borders.begin(), borders.end(),
                       [other](const Border& border) { return border.other == other; });
}

/// Lists of numbers by what they belong to.
void list_by(const std::vector<std::uint32_t>& of, std::size_t count,
             std::vector<std::uint32_t>& first, std::vector<std::uint32_t>& list) {
    first.assign(count + 1, 0);
    for (const std::uint32_t k : of) ++first[k + 1];
    for (std::size_t k = 0; k < count; ++k) first[k + 1] += first[k];
    list.resize(of.size());
    std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
    for (std::uint32_t x = 0; x < of.size(); ++x) list[at[of[x]]++] = x;
}

/// Those whose finer nodes have borders.
Borders finer_borders(const Finer& finer, const ThermalNodes& nodes) {
    Borders borders(nodes.size());
    for (std::uint32_t x = 0; x < finer.point.size(); ++x) {
        const std::uint32_t a = nodes.node_of[x];
        for (std::uint32_t e = finer.first[x]; e < finer.first[x + 1]; ++e) {
            const std::uint32_t b = nodes.node_of[finer.neighbour[e]];
            if (a != b) add(borders[a], b, finer.conductance[e]);
        }
    }
    return borders;
}

/// Whether heat gets from a to b by finer nodes, or may do: both have a border with the same.
bool near(const Borders& below, std::uint32_t a, std::uint32_t b) {
    return has(below[a], b) ||
           std::any_of(below[a].begin(), below[a].end(),
                       [&](const Border& between) { return has(below[between.other], b); });
}

/// Which cells are polygons between others that heat gets to: their areas are those of the
/// triangles from the node to each border.
std::vector<std::uint8_t> whole_cells(const ThermalNodes& nodes, const Borders& below) {
    std::vector<std::uint8_t> whole(nodes.size(), 1);
    for (std::uint32_t a = 0; a < nodes.size(); ++a) {
        double area = 0.0;
        for (std::uint32_t e = nodes.first[a]; e < nodes.first[a + 1]; ++e) {
            const std::uint32_t b = nodes.neighbour[e];
            area += 0.25 * nodes.conductance[e] * (nodes.point[b] - nodes.point[a]).squaredNorm();
            if (!near(below, a, b)) whole[a] = 0;
        }
        if (std::abs(area - nodes.area[a]) > kWhole * nodes.area[a]) whole[a] = 0;
    }
    return whole;
}

/// The triangles' sides: neighbours of whole cells, and what heat gets to elsewhere, where cells
/// reach farther than what is there, or see nothing where the surface is bent.
Borders sides(const Finer& finer, const ThermalNodes& nodes) {
    const Borders below = finer_borders(finer, nodes);
    const std::vector<std::uint8_t> whole = whole_cells(nodes, below);
    Borders found(nodes.size());
    for (std::uint32_t a = 0; a < nodes.size(); ++a) {
        const auto both = [&](std::uint32_t b) { return whole[a] != 0 && whole[b] != 0; };
        for (std::uint32_t e = nodes.first[a]; e < nodes.first[a + 1]; ++e)
            if (both(nodes.neighbour[e])) found[a].push_back({nodes.neighbour[e], 0.0});
        for (const Border& border : below[a])
            if (!both(border.other)) found[a].push_back(border);
    }
    return found;
}

/// What the finer ways conduct where the temperature is interpolated (Galerkin).
void join(ThermalLevel& level, const Finer& finer) {
    struct Part {
        std::uint32_t node;
        double share;
    };
    Borders borders(level.size());
    for (std::uint32_t x = 0; x < finer.point.size(); ++x) {
        for (std::uint32_t e = finer.first[x]; e < finer.first[x + 1]; ++e) {
            const std::uint32_t y = finer.neighbour[e];
            if (y < x) continue;
            std::array<Part, 6> parts;
            std::size_t count = 0;
            for (const auto& [node, sign] : {std::pair{x, 1.0}, std::pair{y, -1.0}}) {
                const ThermalLevel::Shares& shares = level.shares[node];
                for (std::size_t i = 0; i < 3; ++i) {
                    if (shares.share[i] == 0.0f) continue;
                    std::size_t k = 0;
                    while (k < count && parts[k].node != shares.node[i]) ++k;
                    if (k == count) parts[count++] = {shares.node[i], 0.0};
                    parts[k].share += sign * shares.share[i];
                }
            }
            for (std::size_t i = 0; i < count; ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    const double both = -parts[i].share * parts[j].share;
                    add(borders[std::max(parts[i].node, parts[j].node)],
                        std::min(parts[i].node, parts[j].node), both * finer.conductance[e],
                        both * finer.sectional[e]);
                }
            }
        }
    }
    for (std::uint32_t a = 0; a < level.size(); ++a)
        for (const Border& border : borders[a])
            if (border.other < a)
                borders[border.other].push_back({a, border.conductance, border.sectional});
    level.first.assign(1, 0);
    double dispersion = 0.0;
    for (std::uint32_t a = 0; a < level.size(); ++a) {
        std::sort(borders[a].begin(), borders[a].end(),
                  [](const Border& p, const Border& q) { return p.other < q.other; });
        double fourth = 0.0;
        for (const Border& border : borders[a]) {
            if (std::abs(border.conductance) < kNoBorder) continue;
            level.neighbour.push_back(border.other);
            level.conductance.push_back(static_cast<float>(border.conductance));
            level.sectional.push_back(static_cast<float>(border.sectional));
            const double away = (level.point[border.other] - level.point[a]).squaredNorm();
            fourth += border.conductance * away * away;
        }
        dispersion += fourth / (64.0 * level.area[a]);
        level.first.push_back(static_cast<std::uint32_t>(level.neighbour.size()));
    }
    level.dispersion = std::max(dispersion / static_cast<double>(level.size()), 0.0);
}

double cross(const Plane& a, const Plane& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// A node, the neighbours round it in its tangent plane by their direction, as far as they are.
struct Fan {
    struct Other {
        std::uint32_t node;
        Plane way;  // mm
        double turn;
    };
    std::uint32_t middle = kNone;
    Vec3 point, e, f;
    std::vector<Other> others;

    Plane flat(const Vec3& at) const {
        const Vec3 way = at - point;
        const Plane plane(way.dot(e), way.dot(f));
        const double length = plane.norm();
        return length > 0.0 ? Plane(plane * (way.norm() / length)) : plane;
    }
    void look(const ThermalLevel& level, const Borders& sides, std::uint32_t node) {
        middle = node;
        point = level.point[node];
        const Vec3 n = level.normal[node].cast<double>();
        e = n.unitOrthogonal();
        f = n.cross(e);
        others.clear();
        for (const Border& side : sides[node]) {
            const std::uint32_t other = side.other;
            const Plane way = flat(level.point[other]);
            // Rises with the angle, from 0 to 4.
            const double share = way.y() / (std::abs(way.x()) + std::abs(way.y()));
            const double turn = way.x() < 0.0 ? 2.0 - share : way.y() < 0.0 ? 4.0 + share : share;
            others.push_back({other, way, turn});
        }
        std::sort(others.begin(), others.end(), [](const Other& a, const Other& b) {
            return a.turn < b.turn || (a.turn == b.turn && a.node < b.node);
        });
    }
    ThermalLevel::Shares shares(const Vec3& at) const {
        const Plane v = flat(at);
        const auto made = [this](std::uint32_t b, double beta, std::uint32_t c, double gamma) {
            const double sum = std::max(beta + gamma, 1.0);
            const auto first = static_cast<float>(beta / sum),
                       second = static_cast<float>(gamma / sum);
            return ThermalLevel::Shares{{middle, b, c}, {1.0f - first - second, first, second}};
        };
        double most = 0.0;
        std::uint32_t nearest = middle;
        for (std::size_t k = 0; k < others.size(); ++k) {
            const Other &b = others[k], &c = others[k + 1 < others.size() ? k + 1 : 0];
            const double area = cross(b.way, c.way);
            const double beta = cross(v, c.way), gamma = cross(b.way, v);
            if (area > kLeastTurn * (b.way.squaredNorm() + c.way.squaredNorm()) && beta >= 0.0 &&
                gamma >= 0.0)
                return made(b.node, beta / area, c.node, gamma / area);
            const double along = v.dot(b.way) / b.way.squaredNorm();
            if (along > most) most = along, nearest = b.node;
        }
        return made(nearest, std::min(most, 1.0), nearest, 0.0);
    }
};

/// Interpolates between the nodes where they are, in the triangles that their cells have.
void interpolate(ThermalLevel& level, const Finer& finer, const Borders& sides,
                 const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& list) {
    parallel_blocks(level.size(), kBlock, {}, [&](std::size_t begin, std::size_t end) {
        Fan fan;
        for (std::size_t a = begin; a < end; ++a) {
            fan.look(level, sides, static_cast<std::uint32_t>(a));
            for (std::uint32_t k = first[a]; k < first[a + 1]; ++k)
                level.shares[list[k]] = fan.shares(finer.point[list[k]]);
        }
    });
}

/// Calls visit(finer node, node, mm2) for what nodes stand for.
template <class Visit>
void for_parts(const ThermalLevel& level, const Finer& finer, Visit visit) {
    for (std::size_t x = 0; x < finer.point.size(); ++x)
        for (std::size_t i = 0; i < 3; ++i)
            if (level.shares[x].share[i] != 0.0f)
                visit(x, level.shares[x].node[i], double{level.shares[x].share[i]} * finer.area[x]);
}

void share_out(ThermalLevel& level, const Finer& finer, const ThermalNodes& nodes) {
    std::vector<std::uint32_t> first, list;
    list_by(nodes.node_of, nodes.size(), first, list);
    const Borders around = sides(finer, nodes);
    level.shares.resize(finer.point.size());
    std::vector<double> area, volume(nodes.size(), 0.0);
    // Where a node is, and the middle of what it stands for, must be the same, or heat that is
    // handed up moves: they come together.
    for (int round = 0;; ++round) {
        interpolate(level, finer, around, first, list);
        area.assign(nodes.size(), 0.0);
        std::vector<Vec3> middle(nodes.size(), Vec3::Zero());
        for_parts(level, finer, [&](std::size_t x, std::uint32_t k, double part) {
            area[k] += part;
            middle[k] += part * finer.point[x];
        });
        if (round == kRounds) break;
        for (std::size_t k = 0; k < nodes.size(); ++k) level.point[k] = middle[k] / area[k];
    }
    level.first_part.assign(nodes.size() + 1, 0);
    for_parts(level, finer, [&](std::size_t x, std::uint32_t k, double part) {
        volume[k] += part * finer.depth[x];
        ++level.first_part[k + 1];
    });
    for (std::size_t k = 0; k < nodes.size(); ++k) level.first_part[k + 1] += level.first_part[k];
    level.part.resize(level.first_part.back());
    std::vector<std::uint32_t> at(level.first_part.begin(), level.first_part.end() - 1);
    for_parts(level, finer, [&](std::size_t x, std::uint32_t k, double) {
        level.part[at[k]++] = static_cast<std::uint32_t>(x);
    });
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        level.area.push_back(static_cast<float>(area[k]));
        level.depth.push_back(static_cast<float>(volume[k] / area[k]));
    }
}

ThermalLevel make_level(const Finer& finer) {
    HeightField field;
    field.point = finer.point;
    field.normal = finer.normal;
    field.area = finer.area;
    field.resize(finer.point.size());
    ThermalNodes nodes = make_thermal_nodes(field, ThermalLevel::kCoarser * finer.spacing);
    ThermalLevel level;
    level.spacing = nodes.spacing;
    level.point = std::move(nodes.point);
    level.normal = std::move(nodes.normal);
    nodes.point = level.point;
    share_out(level, finer, nodes);
    join(level, finer);
    list_by(nodes.node_of, nodes.size(), level.first_member, level.member);
    return level;
}

}  // namespace

std::vector<ThermalLevel> make_thermal_levels(const ThermalNodes& nodes) {
    std::vector<ThermalLevel> levels;
    if (nodes.size() <= kFewest) return levels;
    const std::vector<float> depth = nodes.depth();
    const std::vector<float> sectional = sectional_conductances(nodes, depth);
    levels.push_back(make_level({nodes.point, nodes.normal, nodes.area, depth, nodes.first,
                                 nodes.neighbour, nodes.conductance, sectional, nodes.spacing}));
    while (levels.size() < kMostLevels && levels.back().size() > kFewest) {
        const ThermalLevel& finer = levels.back();
        ThermalLevel next =
            make_level({finer.point, finer.normal, finer.area, finer.depth, finer.first,
                        finer.neighbour, finer.conductance, finer.sectional, finer.spacing});
        if (next.size() > kFewer * static_cast<double>(finer.size())) break;
        // Of the nodes themselves, by way of those between.
        std::vector<std::uint32_t> between(finer.size()), home(nodes.size());
        for (std::uint32_t k = 0; k < next.size(); ++k)
            for (std::uint32_t m = next.first_member[k]; m < next.first_member[k + 1]; ++m)
                between[next.member[m]] = k;
        for (std::uint32_t k = 0; k < finer.size(); ++k)
            for (std::uint32_t m = finer.first_member[k]; m < finer.first_member[k + 1]; ++m)
                home[finer.member[m]] = between[k];
        list_by(home, next.size(), next.first_member, next.member);
        levels.push_back(std::move(next));
    }
    return levels;
}

}  // namespace beltgrinding

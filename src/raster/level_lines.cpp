#include "level_lines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "mesh/topology.h"

namespace beltgrinding {
namespace {

constexpr double kSamePoint = 1e-7;   // mm
constexpr double kOnePlace = 1e-4;    // mm; the two sides of an edge lie so near
constexpr double kSameNormal = 1e-3;  // rad; more is an edge between faces
constexpr std::size_t kCancelEvery = 1 << 14;

/// Where a level line crosses an edge.
struct Crossing {
    std::uint64_t edge = 0;  ///< both vertices
    Vec3 point, normal;
};

struct Segment {
    std::size_t level = 0;
    Crossing from, to;
};

Crossing crossing(const LevelMesh& mesh, std::size_t triangle, std::size_t i, std::size_t j,
                  double value) {
    const Triangle& t = mesh.triangles[triangle];
    const auto& c = mesh.scalar[triangle];
    const auto& n = mesh.normal[triangle];
    // From the lower vertex number, so that both triangles of the edge round alike.
    if (t[i] > t[j]) std::swap(i, j);
    const double w = std::clamp((value - c[i]) / (c[j] - c[i]), 0.0, 1.0);
    return {edge_key(t[i], t[j]), (1 - w) * mesh.point[t[i]] + w * mesh.point[t[j]],
            ((1 - w) * n[i] + w * n[j]).normalized()};
}

std::vector<Segment> segments(const LevelMesh& mesh, const std::vector<Level>& levels,
                              double period, const RunContext& context) {
    std::map<std::size_t, std::vector<std::pair<double, std::size_t>>> by_part;
    for (std::size_t k = 0; k < levels.size(); ++k)
        by_part[levels[k].part].push_back({levels[k].value, k});
    for (auto& [part, values] : by_part) std::sort(values.begin(), values.end());
    std::vector<Segment> result;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (i % kCancelEvery == 0) context.throw_if_cancelled();
        const auto found = by_part.find(mesh.part[i]);
        if (found == by_part.end()) continue;
        const auto& c = mesh.scalar[i];
        const auto [low, high] = std::minmax({c[0], c[1], c[2]});
        if (!std::isfinite(high - low)) continue;
        for (int turn = period > 0 ? -1 : 0; turn <= (period > 0 ? 1 : 0); ++turn) {
            const double shift = turn * period;
            auto it = std::upper_bound(found->second.begin(), found->second.end(),
                                       std::pair(low - shift, levels.size()));
            for (; it != found->second.end() && it->first + shift <= high; ++it) {
                const double value = it->first + shift;
                Segment s;
                s.level = it->second;
                const auto through =
                    triangle_crossing({c[0] >= value, c[1] >= value, c[2] >= value});
                if (!through) continue;
                s.from = crossing(mesh, i, through->leaves[0], through->leaves[1], value);
                s.to = crossing(mesh, i, through->enters[0], through->enters[1], value);
                result.push_back(s);
            }
        }
    }
    return result;
}

double between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

void append(RasterLine& line, const Crossing& c) {
    if (!line.point.empty() && (line.point.back() - c.point).norm() < kSamePoint &&
        between(line.normal.back(), c.normal) < kSameNormal)
        return;
    line.point.push_back(c.point);
    line.normal.push_back(c.normal);
}

/// Joins segments that share an edge.
std::vector<RasterLine> chains(const std::vector<Segment>& all) {
    using Key = std::tuple<std::size_t, std::uint64_t, std::size_t>;  // level, edge, segment
    std::vector<Key> starts, ends;
    for (std::size_t i = 0; i < all.size(); ++i) {
        starts.push_back({all[i].level, all[i].from.edge, i});
        ends.push_back({all[i].level, all[i].to.edge, i});
    }
    std::sort(starts.begin(), starts.end());
    std::sort(ends.begin(), ends.end());
    std::vector<char> used(all.size(), 0);
    const auto follow = [&](std::size_t i) {  // the unused segment that begins where i ends
        const std::size_t level = all[i].level;
        const std::uint64_t edge = all[i].to.edge;
        auto it = std::lower_bound(starts.begin(), starts.end(), Key(level, edge, 0));
        for (; it != starts.end() && std::get<0>(*it) == level && std::get<1>(*it) == edge; ++it)
            if (!used[std::get<2>(*it)]) return std::get<2>(*it);
        return all.size();
    };
    const auto has_before = [&](std::size_t i) {
        const auto it =
            std::lower_bound(ends.begin(), ends.end(), Key(all[i].level, all[i].from.edge, 0));
        return it != ends.end() && std::get<0>(*it) == all[i].level &&
               std::get<1>(*it) == all[i].from.edge;
    };
    std::vector<RasterLine> lines;
    // First the open lines, from their beginnings; what is left then is closed.
    for (const bool open : {true, false}) {
        for (const auto& [level, edge, first] : starts) {
            if (used[first] || (open && has_before(first))) continue;
            RasterLine line;
            line.level = level;
            std::size_t last = first;
            for (std::size_t i = first; i < all.size(); i = follow(i)) {
                used[i] = 1;
                append(line, all[i].from);
                append(line, all[i].to);
                last = i;
            }
            line.closed = !open && all[last].to.edge == all[first].from.edge;
            if (line.point.size() > 1) lines.push_back(std::move(line));
        }
    }
    std::stable_sort(lines.begin(), lines.end(),
                     [](const RasterLine& a, const RasterLine& b) { return a.level < b.level; });
    return lines;
}

/// Cuts a line where the normal jumps in one place: at an edge between faces, not at a tight bend
/// of one face.
void split(RasterLine&& line, double turn, std::vector<RasterLine>& out) {
    const std::size_t n = line.point.size();
    std::vector<std::size_t> cuts{0};
    for (std::size_t i = 1; i < n; ++i)
        if ((line.point[i] - line.point[i - 1]).norm() < kOnePlace &&
            between(line.normal[i - 1], line.normal[i]) > turn)
            cuts.push_back(i);
    if (cuts.size() == 1) {
        out.push_back(std::move(line));
        return;
    }
    std::vector<RasterLine> pieces;
    cuts.push_back(n);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        RasterLine piece;
        piece.level = line.level;
        const auto a = static_cast<std::ptrdiff_t>(cuts[k]),
                   b = static_cast<std::ptrdiff_t>(cuts[k + 1]);
        piece.point.assign(line.point.begin() + a, line.point.begin() + b);
        piece.normal.assign(line.normal.begin() + a, line.normal.begin() + b);
        pieces.push_back(std::move(piece));
    }
    if (line.closed) {  // its beginning is no end: the last piece runs on into the first
        RasterLine& first = pieces.front();
        RasterLine& last = pieces.back();
        last.point.insert(last.point.end(), first.point.begin() + 1, first.point.end());
        last.normal.insert(last.normal.end(), first.normal.begin() + 1, first.normal.end());
        pieces.erase(pieces.begin());
    }
    for (RasterLine& piece : pieces)
        if (piece.point.size() > 1) out.push_back(std::move(piece));
}

std::vector<double> arc_length(const RasterLine& line) {
    std::vector<double> s(line.point.size(), 0.0);
    for (std::size_t i = 1; i < s.size(); ++i)
        s[i] = s[i - 1] + (line.point[i] - line.point[i - 1]).norm();
    return s;
}

/// Index i and share w of the place at arc length x: between points i and i + 1.
std::pair<std::size_t, double> place(const std::vector<double>& s, double x) {
    const auto upper = std::upper_bound(s.begin() + 1, s.end() - 1, x);
    const auto i = static_cast<std::size_t>(upper - s.begin()) - 1;
    const double step = s[i + 1] - s[i];
    return {i, step > 0 ? std::clamp((x - s[i]) / step, 0.0, 1.0) : 0.0};
}

/// Averages the normal over `window` mm of the line.
void smooth(RasterLine& line, double window) {
    const std::vector<double> s = arc_length(line);
    std::vector<Vec3> sum(s.size(), Vec3::Zero());  // integral of the normal
    for (std::size_t i = 1; i < s.size(); ++i)
        sum[i] = sum[i - 1] + 0.5 * (line.normal[i] + line.normal[i - 1]) * (s[i] - s[i - 1]);
    const auto integral = [&](double x) {
        const auto [i, w] = place(s, x);
        const Vec3 end = (1 - w) * line.normal[i] + w * line.normal[i + 1];
        return Vec3(sum[i] + 0.5 * w * (s[i + 1] - s[i]) * (line.normal[i] + end));
    };
    std::vector<Vec3> averaged(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        const double low = std::max(0.0, s[i] - 0.5 * window);
        const double high = std::min(s.back(), s[i] + 0.5 * window);
        const Vec3 mean = integral(high) - integral(low);
        averaged[i] = mean.norm() > 1e-9 * (high - low) ? mean.normalized() : line.normal[i];
    }
    line.normal = std::move(averaged);
}

/// Tangents over `reach` mm to both sides: the short chords of thin triangles say little.
void find_tangents(RasterLine& line, double reach) {
    const std::vector<double> s = arc_length(line);
    const auto at = [&](double x) {
        const auto [i, w] = place(s, x);
        return Vec3((1 - w) * line.point[i] + w * line.point[i + 1]);
    };
    const double whole = s.back();
    line.tangent.resize(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        double low = s[i] - reach, high = s[i] + reach;
        Vec3 way;
        if (line.closed && whole > 4 * reach) {
            way = at(high > whole ? high - whole : high) - at(low < 0 ? low + whole : low);
        } else {
            low = std::max(low, 0.0), high = std::min(high, whole);
            way = at(high) - at(low);
        }
        way -= way.dot(line.normal[i]) * line.normal[i];
        const double length = way.norm();
        line.tangent[i] = length > 0 ? Vec3(way / length)
                          : i > 0    ? line.tangent[i - 1]
                                     : line.normal[i].unitOrthogonal();
    }
}

}  // namespace

std::vector<std::uint32_t> welded(const std::vector<Vec3>& point,
                                  const std::vector<Triangle>& triangles, double tolerance) {
    std::vector<std::uint32_t> merged(point.size());
    for (std::uint32_t i = 0; i < point.size(); ++i) merged[i] = i;
    if (!(tolerance > 0)) return merged;
    std::vector<std::uint64_t> edges;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.push_back(edge_key(t[k], t[(k + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    std::vector<char> open(point.size(), 0);
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t j = i;
        while (j < edges.size() && edges[j] == edges[i]) ++j;
        if (j == i + 1) open[edges[i] >> 32] = open[edges[i] & 0xffffffffu] = 1;
        i = j;
    }
    // A point joins the first one of the neighbouring cells that is near enough.
    std::map<std::array<long long, 3>, std::vector<std::uint32_t>> cells;
    for (std::uint32_t i = 0; i < point.size(); ++i) {
        if (!open[i]) continue;
        std::array<long long, 3> cell{};
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<long long>(std::floor(point[i][Eigen::Index(k)] / tolerance));
        bool found = false;
        for (long long n = 0; n < 27 && !found; ++n) {
            const auto it =
                cells.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
            if (it == cells.end()) continue;
            for (const std::uint32_t other : it->second) {
                if ((point[other] - point[i]).norm() > tolerance) continue;
                merged[i] = other;
                found = true;
                break;
            }
        }
        if (!found) cells[cell].push_back(i);
    }
    return merged;
}

std::vector<RasterLine> level_lines(const LevelMesh& mesh, const std::vector<Level>& levels,
                                    double period, double split_turn, double smoothing,
                                    const RunContext& context) {
    const std::vector<Segment> all = segments(mesh, levels, period, context);
    double total = 0;
    for (const Segment& s : all) total += (s.to.point - s.from.point).norm();
    const double reach = all.empty() ? 0.0 : total / double(all.size());
    std::vector<RasterLine> lines;
    for (RasterLine& line : chains(all)) split(std::move(line), split_turn, lines);
    for (RasterLine& line : lines) {
        if (smoothing > 0) smooth(line, smoothing);
        find_tangents(line, 2 * reach);
    }
    return lines;
}

}  // namespace beltgrinding

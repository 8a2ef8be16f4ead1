#include "raster/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "beltgrinding/error.h"
#include "geodesic.h"
#include "level_lines.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBins = 2048;     // of the scalar's range, for the distance between levels
constexpr double kUsualShare = 0.9;     // the "usual" gradient: exceeded on a tenth of the area
constexpr double kLeastGradient = 0.1;  // of the usual one: 84 degrees against the planes
constexpr double kSliver = 0.02;        // area over longest edge squared: its gradient is noise
constexpr double kRounding = 1e-9;      // of a step-over
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kNoPart = std::numeric_limits<std::size_t>::max();  // which no level crosses

struct TriangleFacts {
    double area = 0.0;      ///< mm2
    double gradient = 0.0;  ///< scalar per mm; 0: not known
    bool sliver = false;
};

TriangleFacts facts_of(const std::array<Vec3, 3>& p, const std::array<double, 3>& c) {
    TriangleFacts facts;
    const Vec3 u = p[1] - p[0], v = p[2] - p[0];
    const Vec3 cross = u.cross(v);
    facts.area = 0.5 * cross.norm();
    const double longest =
        std::max({u.squaredNorm(), v.squaredNorm(), (p[2] - p[1]).squaredNorm()});
    facts.sliver = !(facts.area > kSliver * longest);
    if (facts.area > 0) {
        const Vec3 g = (c[1] - c[0]) * v - (c[2] - c[0]) * u;  // turned by a right angle
        facts.gradient = g.norm() / cross.norm();
    }
    return facts;
}

/// The surface's triangles after welding, with their scalars brought to one branch each.
class Raster {
  public:
    Raster(const RasterSurface& surface, const RasterOptions& options, const RunContext& context)
        : surface_(surface), options_(options), context_(context) {
        weld();
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const Triangle& t = mesh_.triangles[i];
            facts_.push_back(facts_of({mesh_.point[t[0]], mesh_.point[t[1]], mesh_.point[t[2]]},
                                      mesh_.scalar[i]));
            result_.area += facts_.back().area;
        }
    }

    RasterLines run() {
        if (options_.spacing == RasterSpacing::kLines) {
            find_levels();
        } else {
            for (const auto& part : parts()) even_levels(part);
        }
        context_.throw_if_cancelled();
        for (std::size_t i = 0; i < of_surface_.size(); ++i)
            if (!surface_.wanted.empty() && surface_.wanted[of_surface_[i]] == 0)
                mesh_.part[i] = kNoPart;
        const bool even = options_.spacing == RasterSpacing::kEven;  // distances have no period
        result_.lines = level_lines(mesh_, levels_, even ? 0.0 : surface_.period,
                                    options_.split_turn, options_.smoothing, context_);
        return std::move(result_);
    }

  private:
    void weld() {
        std::vector<std::uint32_t> merged =
            welded(surface_.point, surface_.triangles, options_.weld);
        mesh_.point = surface_.point;
        // Corners that became one must agree, or a level line would break between them.
        std::vector<double> agreed(surface_.point.size(), kInfinity);
        for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
            const Triangle& t = surface_.triangles[i];
            const Triangle m{merged[t[0]], merged[t[1]], merged[t[2]]};
            if (m[0] == m[1] || m[1] == m[2] || m[2] == m[0]) continue;
            std::array<double, 3> c = surface_.scalar[i];
            const double known = std::isfinite(c[0]) ? c[0] : std::isfinite(c[1]) ? c[1] : c[2];
            if (surface_.period > 0)
                for (double& x : c)
                    x += surface_.period * std::round((known - x) / surface_.period);
            // A pole has no scalar of its own: that of the side opposite to it.
            const int unknown = !std::isfinite(c[0]) + !std::isfinite(c[1]) + !std::isfinite(c[2]);
            if (unknown > 1) continue;
            if (unknown == 1)
                for (std::size_t k = 0; k < 3; ++k)
                    if (!std::isfinite(c[k])) c[k] = 0.5 * (c[(k + 1) % 3] + c[(k + 2) % 3]);
            if (options_.weld > 0 && !(surface_.period > 0)) {
                for (std::size_t k = 0; k < 3; ++k) {
                    double& first = agreed[m[k]];
                    if (std::isinf(first)) first = c[k];
                    if (std::abs(first - c[k]) <= options_.weld) c[k] = first;
                }
            }
            mesh_.triangles.push_back(m);
            mesh_.scalar.push_back(c);
            mesh_.normal.push_back(
                {surface_.normal[t[0]], surface_.normal[t[1]], surface_.normal[t[2]]});
            mesh_.part.push_back(0);
            of_surface_.push_back(i);
        }
    }

    /// A place in the scalar's range, and the distance to it from the range's beginning, mm.
    struct Node {
        double value, length;
    };

    /// Levels of `part` between the first and the last node, at equal distance.
    void add_levels(const std::vector<Node>& nodes, std::size_t part) {
        const double length = nodes.back().length;
        const double wanted = std::ceil(length / options_.step_over - kRounding);
        if (!(double(levels_.size()) + wanted <= double(options_.most)))
            throw InputError(
                "raster.too_many_passes",
                "the step-over of {step_over:.4g} mm gives more than {count} passes; enlarge it",
                {{"step_over", options_.step_over}, {"count", options_.most}});
        const auto count = static_cast<std::size_t>(std::max(1.0, wanted));
        for (std::size_t k = 0; k < count; ++k) {
            const double at = (double(k) + 0.5) / double(count) * length;
            const auto upper =
                std::upper_bound(nodes.begin() + 1, nodes.end() - 1, at,
                                 [](double x, const Node& node) { return x < node.length; });
            const Node &low = *(upper - 1), &high = *upper;
            const double step = high.length - low.length;
            const double w = step > 0 ? (at - low.length) / step : 0.5;
            levels_.push_back({(1 - w) * low.value + w * high.value, part});
            result_.distance.push_back(length / double(count));
        }
    }

    /// Levels of the scalar itself, at equal distance where neighbours are farthest apart.
    void find_levels() {
        double low = kInfinity, high = -kInfinity;
        for (std::size_t i = 0; i < surface_.triangles.size(); ++i)
            for (const double c : surface_.scalar[i])
                if (std::isfinite(c)) low = std::min(low, c), high = std::max(high, c);
        std::vector<std::size_t> order(facts_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return facts_[a].gradient < facts_[b].gradient;
        });
        double sum = 0, usual = 0;
        for (const std::size_t i : order) {
            sum += facts_[i].area;
            usual = facts_[i].gradient;
            if (sum >= kUsualShare * result_.area) break;
        }
        const double least = kLeastGradient * usual;
        if (!(high > low) || !(least > 0)) {
            result_.uncovered_area = result_.area;
            return;
        }
        const double bin = (high - low) / double(kBins);
        struct Bin {
            double gradient = kInfinity, low = kInfinity, high = -kInfinity;  // low, high: covered
        };
        std::vector<Bin> bins(kBins);
        const auto index = [&](double c) {
            const double k = std::floor((c - low) / bin);
            return static_cast<std::size_t>(std::clamp(k, 0.0, double(kBins - 1)));
        };
        for (std::size_t i = 0; i < facts_.size(); ++i) {
            const double g = facts_[i].gradient;
            if (g < least) result_.uncovered_area += facts_[i].area;
            if (facts_[i].sliver || g < least) continue;
            const auto& c = mesh_.scalar[i];
            const auto [first, last] = std::minmax({c[0], c[1], c[2]});
            for (int turn = surface_.period > 0 ? -1 : 0; turn <= (surface_.period > 0); ++turn) {
                const double a = std::max(first + turn * surface_.period, low);
                const double b = std::min(last + turn * surface_.period, high);
                if (!(a < b)) continue;
                for (std::size_t k = index(a); k <= index(b); ++k) {
                    bins[k].gradient = std::min(bins[k].gradient, g);
                    bins[k].low = std::min(bins[k].low, std::max(a, low + double(k) * bin));
                    bins[k].high = std::max(bins[k].high, std::min(b, low + double(k + 1) * bin));
                }
            }
        }
        // What lies between surfaces that do not meet takes no passes.
        for (std::size_t k = 0; k < kBins;) {
            if (!(bins[k].high > bins[k].low)) {
                ++k;
                continue;
            }
            std::vector<Node> nodes{{bins[k].low, 0.0}};
            for (; k < kBins && bins[k].high > bins[k].low; ++k)
                nodes.push_back({bins[k].high, nodes.back().length + (bins[k].high - bins[k].low) /
                                                                         bins[k].gradient});
            add_levels(nodes, 0);
        }
    }

    /// Triangles of each connected part, in the order of their first one.
    std::vector<std::vector<std::size_t>> parts() {
        std::vector<std::uint32_t> root(mesh_.point.size());
        std::iota(root.begin(), root.end(), 0u);
        const auto find = [&](std::uint32_t v) {
            while (root[v] != v) v = root[v] = root[root[v]];
            return v;
        };
        for (const Triangle& t : mesh_.triangles)
            for (const std::uint32_t v : {t[1], t[2]}) {
                const std::uint32_t a = find(t[0]), b = find(v);
                root[std::max(a, b)] = std::min(a, b);
            }
        std::vector<std::vector<std::size_t>> result;
        std::vector<std::size_t> number(mesh_.point.size(), 0);
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
            std::size_t& n = number[find(mesh_.triangles[i][0])];
            if (n == 0) {
                result.emplace_back();
                n = result.size();
            }
            result[n - 1].push_back(i);
            mesh_.part[i] = n - 1;
        }
        return result;
    }

    double middle(const std::vector<std::size_t>& part) const {
        std::vector<std::pair<double, double>> values;  // scalar, area
        double total = 0, sum = 0;
        for (const std::size_t i : part) {
            const auto& c = mesh_.scalar[i];
            values.push_back({(c[0] + c[1] + c[2]) / 3.0, facts_[i].area});
            total += facts_[i].area;
        }
        std::sort(values.begin(), values.end());
        for (const auto& [value, area] : values)
            if ((sum += area) >= 0.5 * total) return value;
        return values.back().first;
    }

    /// Turns the part's scalar into the signed distance from its middle line.
    void even_levels(const std::vector<std::size_t>& part) {
        const double start = middle(part), period = surface_.period;
        std::vector<double> distance(mesh_.point.size(), kInfinity);
        std::vector<Triangle> triangles;
        std::vector<char> crossing(part.size(), 0);
        for (std::size_t k = 0; k < part.size(); ++k) {
            auto& c = mesh_.scalar[part[k]];
            if (period > 0) {
                const double mean = (c[0] + c[1] + c[2]) / 3.0;
                const double shift = period * std::round((start - mean) / period);
                for (double& x : c) x += shift;
            }
            const Triangle& t = mesh_.triangles[part[k]];
            triangles.push_back(t);
            const auto [a, b] = std::minmax({c[0], c[1], c[2]});
            if (!(a <= start && b >= start) || !(facts_[part[k]].gradient > 0)) continue;
            crossing[k] = 1;
            for (std::size_t j = 0; j < 3; ++j) {
                const double d = std::abs(c[j] - start) / facts_[part[k]].gradient;
                distance[t[j]] = std::min(distance[t[j]], d);
            }
        }
        march(mesh_.point, triangles, distance, context_);
        double low = kInfinity, high = -kInfinity;
        for (std::size_t k = 0; k < part.size(); ++k) {
            auto& c = mesh_.scalar[part[k]];
            const Triangle& t = mesh_.triangles[part[k]];
            const double mean = (c[0] + c[1] + c[2]) / 3.0;
            bool reached = true;
            for (std::size_t j = 0; j < 3; ++j) {
                const double side = crossing[k] ? c[j] : mean;
                c[j] = side < start ? -distance[t[j]] : distance[t[j]];
                reached &= std::isfinite(c[j]);
                if (std::isfinite(c[j])) low = std::min(low, c[j]), high = std::max(high, c[j]);
            }
            if (!reached) result_.uncovered_area += facts_[part[k]].area;
        }
        if (high >= low) add_levels({{low, 0.0}, {high, high - low}}, mesh_.part[part.front()]);
    }

    const RasterSurface& surface_;
    const RasterOptions& options_;
    const RunContext& context_;
    LevelMesh mesh_;
    std::vector<std::size_t> of_surface_;  // the number there of each triangle
    std::vector<TriangleFacts> facts_;
    std::vector<Level> levels_;
    RasterLines result_;
};

double between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// True if the straight way from point i to point j of the line keeps to the limits.
bool straight(const RasterLine& line, std::size_t i, std::size_t j, const PoseSpacing& spacing) {
    const Vec3 way = line.point[j] - line.point[i];
    if (way.norm() > spacing.max_distance) return false;
    const double turn = std::max(between(line.normal[i], line.normal[j]),
                                 between(line.tangent[i], line.tangent[j]));
    if (turn > spacing.max_turn) return false;
    const double bend = spacing.lever * turn * turn / 8.0;
    const double length = way.squaredNorm();
    for (std::size_t k = i + 1; k < j; ++k) {
        const Vec3 d = line.point[k] - line.point[i];
        const double share = length > 0 ? std::clamp(d.dot(way) / length, 0.0, 1.0) : 0.0;
        if ((d - share * way).norm() + bend > spacing.chord_error) return false;
    }
    return true;
}

}  // namespace

RasterLines raster_lines(const RasterSurface& surface, const RasterOptions& options,
                         const RunContext& context) {
    if (!(options.step_over > 0) || !std::isfinite(options.step_over))
        throw InputError("raster.step_over", "the step-over must be above 0 mm");
    if (surface.scalar.size() != surface.triangles.size() ||
        surface.normal.size() != surface.point.size())
        throw InputError("raster.lengths",
                         "a raster needs a normal for every point, scalars for every triangle");
    if (!surface.wanted.empty() && surface.wanted.size() != surface.triangles.size())
        throw InputError("raster.wanted_length",
                         "a raster needs of every triangle whether lines are wanted on it");
    for (const Triangle& t : surface.triangles)
        for (const std::uint32_t v : t)
            if (v >= surface.point.size())
                throw InputError("raster.triangle_without_point",
                                 "a triangle names a point that does not exist");
    return Raster(surface, options, context).run();
}

std::vector<std::size_t> thin(const RasterLine& line, const PoseSpacing& spacing) {
    std::vector<std::size_t> kept{0};
    const std::size_t n = line.point.size();
    while (kept.back() + 1 < n) {
        const std::size_t i = kept.back();
        std::size_t j = i + 1;
        while (j + 1 < n && straight(line, i, j + 1, spacing)) ++j;
        kept.push_back(j);
    }
    return kept;
}

}  // namespace beltgrinding

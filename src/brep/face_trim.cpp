#include "face_trim.h"

#include <BRep_Tool.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <map>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr int kLooksPerSpan = 16;  // points at which a trimming curve is looked at
constexpr int kFewestLooks = 32;
constexpr int kMostLooks = 4000;
constexpr double kZeroLength = 1e-7;   // mm, OpenCASCADE's confusion: an edge without length
constexpr std::size_t kPoleNodes = 8;  // intervals of an edge without length
constexpr double kMostTurn = 1.0472;   // rad, between neighbouring samples of an edge
constexpr double kFinestShare = 0.1;   // of the spacing: turning makes no denser samples than this
constexpr double kMergeShare = 1e-3;   // of the spacing: ends of chains that are one node
constexpr int kRefinements = 7;        // halvings of chords that cross
constexpr double kLookTurn = 0.2;      // rad, between looks at an edge whose samples are uneven
constexpr int kLookHalvings = 10;

int looks(const TrimCurve& c) {
    int spans = 1;
    try {
        spans = Geom2dAdaptor_Curve(c.curve, c.first, c.last).NbIntervals(GeomAbs_C2);
    } catch (const Standard_Failure&) {
        // One span it is.
    }
    return std::clamp(kLooksPerSpan * spans, kFewestLooks, kMostLooks);
}

/// Halves what lies between looks where the edge turns.
void look_where_bent(const TrimCurve& c, const FaceSurface& surface,
                     const GeomAdaptor_Surface& evaluator, std::vector<double>& at) {
    for (int round = 0; round < kLookHalvings && at.size() < kMostLooks; ++round) {
        std::vector<double> finer{at.front()};
        Vec3 last = Vec3::Zero(), before = Vec3::Zero();
        bool bent = false;
        for (std::size_t i = 0; i < at.size(); ++i) {
            const gp_Pnt2d uv = c.curve->Value(at[i]);
            const Vec3 p =
                surface
                    .at(evaluator, surface.swap ? uv.Y() : uv.X(), surface.swap ? uv.X() : uv.Y())
                    .point;
            if (i == 0) {
                last = p;
                continue;
            }
            const Vec3 way = p - last;
            const bool turns =
                i > 1 && way.dot(before) < std::cos(kLookTurn) * way.norm() * before.norm();
            // Both chords that meet in the turn.
            if (turns && !bent) finer.insert(finer.end() - 1, 0.5 * (at[i - 2] + at[i - 1]));
            if (turns) finer.push_back(0.5 * (at[i - 1] + at[i]));
            finer.push_back(at[i]);
            bent = turns;
            last = p;
            before = way;
        }
        if (finer.size() == at.size()) return;
        at = std::move(finer);
    }
}

/// Parameters at equal arc length along one use of an edge, as the metric stretches it.
std::vector<double> edge_parameters(const TrimCurve& c, const FaceSurface& surface,
                                    const SurfaceMetric& metric,
                                    const GeomAdaptor_Surface& evaluator, double spacing,
                                    bool& degenerate) {
    const auto even = [&](std::size_t n) {
        std::vector<double> p(n + 1);
        for (std::size_t i = 0; i <= n; ++i)
            p[i] = c.first + (c.last - c.first) * double(i) / double(n);
        return p;
    };
    if (degenerate) return even(kPoleNodes);
    std::vector<double> at = even(static_cast<std::size_t>(looks(c)));
    if (metric.stretched()) look_where_bent(c, surface, evaluator, at);
    std::vector<double> length;
    double turn = 0;
    std::size_t intervals = 1;
    for (int round = 0; round < 2; ++round) {
        length.assign(at.size(), 0.0);
        turn = 0;
        Vec3 last = Vec3::Zero(), direction = Vec3::Zero();
        for (std::size_t i = 0; i < at.size(); ++i) {
            const gp_Pnt2d uv = c.curve->Value(at[i]);
            const double s = surface.swap ? uv.Y() : uv.X(), t = surface.swap ? uv.X() : uv.Y();
            const SurfacePoint here = surface.at(evaluator, s, t);
            const Vec3 p = here.point;
            if (i > 0) {
                const Vec3 step = p - last;
                length[i] =
                    length[i - 1] +
                    (metric.stretched() ? metric.stretched(step, here, s, t).norm() : step.norm());
                if (step.norm() > kZeroLength) {
                    const Vec3 d = step.normalized();
                    if (direction != Vec3::Zero())
                        turn += std::atan2(direction.cross(d).norm(), direction.dot(d));
                    direction = d;
                }
            }
            last = p;
        }
        const double total = length.back();
        if (!std::isfinite(total))
            throw InputError(
                "brep.edge_nan",
                "an edge of it evaluates to NaN; repair the shape or leave the face out");
        if (total < kZeroLength) {
            degenerate = true;
            return even(kPoleNodes);
        }
        const double by_turn = std::min(std::ceil(turn / kMostTurn - 0.01),
                                        std::ceil(total / (kFinestShare * spacing)));
        double wanted = std::max({1.0, std::round(total / spacing), by_turn});
        if (c.vertex_first == c.vertex_last) wanted = std::max(wanted, 3.0);
        intervals = static_cast<std::size_t>(wanted);
        if (2 * intervals <= at.size()) break;
        if (round == 0) at = even(2 * intervals);
        if (round == 0 && metric.stretched()) look_where_bent(c, surface, evaluator, at);
    }
    std::vector<double> parameters(intervals + 1);
    std::size_t k = 0;
    for (std::size_t i = 0; i <= intervals; ++i) {
        const double l = length.back() * double(i) / double(intervals);
        while (k + 2 < length.size() && length[k + 1] < l) ++k;
        const double step = length[k + 1] - length[k];
        const double w = step > 0 ? std::clamp((l - length[k]) / step, 0.0, 1.0) : 0.0;
        parameters[i] = at[k] + w * (at[k + 1] - at[k]);
    }
    parameters.front() = c.first;
    parameters.back() = c.last;
    return parameters;
}

/// Adds samples and nodes for the given parameters of each edge.
class BoundaryBuilder {
  public:
    BoundaryBuilder(const TrimCurves& trim, const FaceSurface& surface, const SurfaceMetric& metric,
                    const PlaneGrid& grid, double spacing)
        : trim_(trim),
          surface_(surface),
          metric_(metric),
          grid_(grid),
          spacing_(spacing),
          evaluator_(surface.evaluator()) {}

    Boundary build(const std::vector<std::vector<double>>& parameters,
                   const std::vector<char>& degenerate) {
        boundary_ = {};
        vertex_sample_.assign(static_cast<std::size_t>(trim_.vertices), kNone);
        vertex_nodes_.assign(static_cast<std::size_t>(trim_.vertices), {});
        edge_samples_.assign(trim_.uses.size(), {});
        for (const TrimCurve& c : trim_.curves) {
            const auto edge = static_cast<std::size_t>(c.edge);
            add(c, parameters[edge], degenerate[edge] != 0, trim_.uses[edge] > 1);
        }
        cancel_doubles();
        bridge_gaps();
        return std::move(boundary_);
    }

  private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    void add(const TrimCurve& c, const std::vector<double>& parameters, bool degenerate,
             bool seam) {
        auto& shared = edge_samples_[static_cast<std::size_t>(c.edge)];
        const bool first_use = shared.empty();
        if (first_use) shared.assign(parameters.size(), kNone);
        std::uint32_t previous = kNone;
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            const bool end = i == 0 || i + 1 == parameters.size();
            const int vertex = i == 0 ? c.vertex_first : c.vertex_last;
            const gp_Pnt2d uv = c.curve->Value(parameters[i]);
            Boundary::Node node;
            node.s = surface_.swap ? uv.Y() : uv.X();
            node.t = surface_.swap ? uv.X() : uv.Y();
            node.x = metric_.x_of(node.s, node.t);
            node.y = metric_.y_of(node.t);
            node.grid = grid_.point(node.x, node.y);
            std::uint32_t& sample =
                end || degenerate ? vertex_sample_[static_cast<std::size_t>(vertex)] : shared[i];
            if (sample == kNone) sample = new_sample(node);
            if (!seam && !degenerate) boundary_.samples[sample].on_boundary = true;
            if (degenerate) boundary_.samples[sample].singular = true;
            node.sample = sample;
            std::uint32_t id = end ? near_node(node, vertex, c.tolerance) : kNone;
            if (id == kNone) {
                id = static_cast<std::uint32_t>(boundary_.nodes.size());
                boundary_.nodes.push_back(node);
                if (end) vertex_nodes_[static_cast<std::size_t>(vertex)].push_back(id);
            }
            if (previous != kNone && previous != id)
                boundary_.segments.push_back({previous, id, c.edge, i - 1});
            previous = id;
        }
    }

    std::uint32_t new_sample(const Boundary::Node& node) {
        const SurfacePoint p = surface_.at(evaluator_, node.s, node.t);
        boundary_.samples.push_back({p.point, p.ds.cross(p.dt), false, p.singular});
        return static_cast<std::uint32_t>(boundary_.samples.size() - 1);
    }

    double distance(const Boundary::Node& a, const Boundary::Node& b) const {
        return std::hypot((a.x - b.x) * metric_.mean_length(), a.y - b.y);
    }

    std::uint32_t near_node(const Boundary::Node& node, int vertex, double tolerance) const {
        const double reach = std::max(kMergeShare * spacing_, std::min(2 * tolerance, spacing_));
        for (const std::uint32_t id : vertex_nodes_[static_cast<std::size_t>(vertex)])
            if (node.grid == boundary_.nodes[id].grid ||
                distance(node, boundary_.nodes[id]) < reach)
                return id;
        return kNone;
    }

    /// A slit, run to and fro, bounds nothing.
    void cancel_doubles() {
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
        const auto key = [](const Boundary::Segment& s) {
            return std::pair(std::min(s.a, s.b), std::max(s.a, s.b));
        };
        for (const auto& s : boundary_.segments) ++count[key(s)];
        std::erase_if(boundary_.segments, [&](const auto& s) { return count[key(s)] % 2 == 0; });
    }

    /// Joins chain ends that meet no other end (a gap in the trimming loop), nearest first.
    void bridge_gaps() {
        std::vector<int> degree(boundary_.nodes.size(), 0);
        for (const auto& s : boundary_.segments) ++degree[s.a], ++degree[s.b];
        std::vector<std::uint32_t> loose;
        for (std::uint32_t i = 0; i < degree.size(); ++i)
            if (degree[i] % 2) loose.push_back(i);
        while (loose.size() > 1) {
            std::size_t best_a = 0, best_b = 1;
            double best = INFINITY;
            for (std::size_t a = 0; a < loose.size(); ++a)
                for (std::size_t b = a + 1; b < loose.size(); ++b) {
                    const double d = distance(boundary_.nodes[loose[a]], boundary_.nodes[loose[b]]);
                    if (d < best) best = d, best_a = a, best_b = b;
                }
            boundary_.segments.push_back({loose[best_a], loose[best_b], -1, 0});
            loose.erase(loose.begin() + static_cast<std::ptrdiff_t>(best_b));
            loose.erase(loose.begin() + static_cast<std::ptrdiff_t>(best_a));
        }
    }

    const TrimCurves& trim_;
    const FaceSurface& surface_;
    const SurfaceMetric& metric_;
    const PlaneGrid& grid_;
    double spacing_;
    GeomAdaptor_Surface evaluator_;
    Boundary boundary_;
    std::vector<std::uint32_t> vertex_sample_;
    std::vector<std::vector<std::uint32_t>> vertex_nodes_;
    std::vector<std::vector<std::uint32_t>> edge_samples_;
};

}  // namespace

TrimCurves collect_trim_curves(const TopoDS_Face& oriented) {
    const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
    TrimCurves result;
    TopTools_IndexedMapOfShape edges, vertices;
    bool any = false;
    for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
        if (edge.Orientation() == TopAbs_INTERNAL || edge.Orientation() == TopAbs_EXTERNAL)
            continue;
        TrimCurve c;
        c.curve = BRep_Tool::CurveOnSurface(edge, face, c.first, c.last);
        if (c.curve.IsNull())
            throw InputError(
                "brep.edge_without_curve",
                "an edge has no curve on the surface; repair the shape or leave the face out");
        c.edge = edges.Add(edge) - 1;
        result.uses.resize(static_cast<std::size_t>(edges.Extent()), 0);
        ++result.uses[static_cast<std::size_t>(c.edge)];
        const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
        const TopoDS_Vertex from = TopExp::FirstVertex(forward), to = TopExp::LastVertex(forward);
        if (from.IsNull() || to.IsNull())
            throw InputError("brep.edge_without_vertices",
                             "an edge has no vertices; repair the shape or leave the face out");
        c.vertex_first = vertices.Add(from) - 1;
        c.vertex_last = vertices.Add(to) - 1;
        c.tolerance = std::max(BRep_Tool::Tolerance(from), BRep_Tool::Tolerance(to));
        c.degenerate = BRep_Tool::Degenerated(edge);
        const int n = looks(c);
        for (int i = 0; i <= n; ++i) {
            const gp_Pnt2d p = c.curve->Value(c.first + (c.last - c.first) * i / n);
            if (!std::isfinite(p.X()) || !std::isfinite(p.Y()))
                throw InputError("brep.edge_curve_nan",
                                 "an edge's curve on the surface evaluates to NaN; repair the "
                                 "shape or leave the face out");
            if (!any) {
                result.u0 = result.u1 = p.X();
                result.v0 = result.v1 = p.Y();
                any = true;
            }
            result.u0 = std::min(result.u0, p.X());
            result.u1 = std::max(result.u1, p.X());
            result.v0 = std::min(result.v0, p.Y());
            result.v1 = std::max(result.v1, p.Y());
        }
        result.curves.push_back(c);
    }
    if (!any)
        throw InputError("brep.no_edges",
                         "it has no edges; repair the shape or leave the face out");
    result.vertices = vertices.Extent();
    return result;
}

GridPoint PlaneGrid::point(double x, double y) const {
    return {static_cast<std::int32_t>(std::lround(x * x_scale)),
            static_cast<std::int32_t>(std::lround(y * y_scale))};
}

Boundary sample_boundary(const TrimCurves& trim, const FaceSurface& surface,
                         const SurfaceMetric& metric, const PlaneGrid& grid, double spacing) {
    std::vector<std::vector<double>> parameters(trim.uses.size());
    std::vector<char> degenerate(trim.uses.size(), 0);
    const GeomAdaptor_Surface evaluator = surface.evaluator();
    for (const TrimCurve& c : trim.curves) {
        const auto edge = static_cast<std::size_t>(c.edge);
        if (!parameters[edge].empty()) continue;
        bool pole = c.degenerate;
        parameters[edge] = edge_parameters(c, surface, metric, evaluator, spacing, pole);
        degenerate[edge] = pole;
    }
    BoundaryBuilder builder(trim, surface, metric, grid, spacing);
    Boundary boundary = builder.build(parameters, degenerate);
    for (int round = 0; round < kRefinements; ++round) {
        std::vector<std::vector<std::size_t>> halve(parameters.size());
        for (const std::size_t i : crossing_segments(boundary)) {
            const auto& s = boundary.segments[i];
            if (s.edge >= 0) halve[static_cast<std::size_t>(s.edge)].push_back(s.interval);
        }
        bool changed = false;
        for (std::size_t e = 0; e < halve.size(); ++e) {
            std::sort(halve[e].begin(), halve[e].end());
            halve[e].erase(std::unique(halve[e].begin(), halve[e].end()), halve[e].end());
            for (std::size_t k = halve[e].size(); k-- > 0;) {
                const std::size_t i = halve[e][k];
                parameters[e].insert(parameters[e].begin() + static_cast<std::ptrdiff_t>(i + 1),
                                     0.5 * (parameters[e][i] + parameters[e][i + 1]));
                changed = true;
            }
        }
        if (!changed) break;
        boundary = builder.build(parameters, degenerate);
    }
    return boundary;
}

}  // namespace beltgrinding

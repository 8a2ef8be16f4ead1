#include "mesh_refinement.h"

#include <GeomAdaptor_Surface.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <utility>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr int kMostRounds = 60;         // each halves; more would be a curve that is none
constexpr std::size_t kBlock = 4096;    // places that one thread evaluates at a time
constexpr double kShorter = 0.9;        // of the chord's length: what each half must be, to end
constexpr double kEven = 0.75;          // of the chord's length: halves that need no better cut
constexpr int kCuts = 12;               // tries for a place half way between the ends
constexpr std::size_t kMostPairs = 20;  // rounds that part edges between the same two vertices

Vec3 vec(const gp_Pnt& p) {
    return {p.X(), p.Y(), p.Z()};
}

/// One new vertex: on a curve, or on a surface, between the parameters of two ends.
struct Place {
    std::uint32_t vertex;
    std::uint32_t a, b;                 ///< vertices, ends of the chord
    std::uint32_t segment, node, face;  ///< kNone: not on a curve; not on a surface
    std::array<double, 2> from, to;     ///< t, or u and v
    double share = 0.5;                 ///< of the way from `from`
    bool found = false;

    double at(std::size_t k) const { return from[k] + share * (to[k] - from[k]); }
};

class Refinement {
  public:
    Refinement(FaceMesh& mesh, const std::vector<char>& fine, double longest,
               const RunContext& context)
        : mesh_(mesh), fine_(fine), longest_(longest), context_(context) {}

    void run() {
        split_until_short();
        for (std::size_t i = 0; i < kMostPairs && mark_doubles(); ++i) {
            halve();
            split_until_short();
        }
    }

  private:
    std::uint32_t face_of(std::uint32_t side) const {
        return mesh_.nodes[mesh_.sides[side].from].face;
    }

    double length(std::uint32_t a, std::uint32_t b) const {
        return (mesh_.vertices[a] - mesh_.vertices[b]).norm();
    }

    void split_until_short() {
        for (int round = 0; round < kMostRounds && mark_long(); ++round) {
            context_.throw_if_cancelled();
            halve();
        }
    }

    void mark(std::uint32_t side) {
        const std::uint32_t segment = mesh_.sides[side].segment;
        if (segment != kNone) {
            split_segment_.resize(mesh_.segments.size(), 0);
            split_segment_[segment] = 1;
        } else {
            split_side_.resize(mesh_.sides.size(), 0);
            split_side_[side] = 1;
        }
    }

    bool mark_long() {
        bool any = false;
        for (const FaceMesh::Corners& t : mesh_.triangles) {
            if (!fine_[mesh_.nodes[t.node[0]].face]) continue;
            for (const std::uint32_t s : t.side) {
                const FaceMesh::Side& side = mesh_.sides[s];
                if (length(mesh_.nodes[side.from].vertex, mesh_.nodes[side.to].vertex) > longest_) {
                    mark(s);
                    any = true;
                }
            }
        }
        return any;
    }

    /// Marks what joins the same two vertices as another: it would be an edge of four triangles.
    bool mark_doubles() {
        struct Join {
            std::uint32_t a, b, what, side;  ///< what: the segment, or the side if it has none
            bool border;
            auto key() const { return std::tuple(a, b, border, what); }
        };
        std::vector<Join> joins;
        for (const FaceMesh::Corners& t : mesh_.triangles) {
            for (const std::uint32_t s : t.side) {
                const FaceMesh::Side& side = mesh_.sides[s];
                const std::uint32_t a = mesh_.nodes[side.from].vertex;
                const std::uint32_t b = mesh_.nodes[side.to].vertex;
                const bool border = side.segment != kNone;
                joins.push_back(
                    {std::min(a, b), std::max(a, b), border ? side.segment : s, s, border});
            }
        }
        std::sort(joins.begin(), joins.end(),
                  [](const Join& x, const Join& y) { return x.key() < y.key(); });
        bool any = false;
        for (std::size_t i = 0; i < joins.size(); ++i) {
            const Join& j = joins[i];
            const auto differs = [&](const Join& other) {
                return other.a == j.a && other.b == j.b &&
                       (other.border != j.border || other.what != j.what);
            };
            if (j.a == j.b || (i > 0 && differs(joins[i - 1])) ||
                (i + 1 < joins.size() && differs(joins[i + 1]))) {
                mark(j.side);
                any = true;
            }
        }
        return any;
    }

    /// Halves all that is marked and the triangles beside it.
    void halve() {
        split_segment_.resize(mesh_.segments.size(), 0);
        split_side_.resize(mesh_.sides.size(), 0);
        for (std::uint32_t s = 0; s < split_segment_.size(); ++s)
            if (split_segment_[s]) halve_segment(s);
        place_vertices();
        std::vector<FaceMesh::Corners> old;
        old.swap(mesh_.triangles);
        for (const FaceMesh::Corners& t : old)
            for (const std::uint32_t s : t.side) halve_side(s);
        place_vertices();
        mesh_.triangles.reserve(2 * old.size());
        for (const FaceMesh::Corners& t : old) split(t);
        split_segment_.clear();
        split_side_.clear();
    }

    std::uint32_t new_vertex() {
        mesh_.vertices.push_back(Vec3::Zero());
        return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
    }

    void halve_segment(std::uint32_t index) {
        FaceMesh::Segment segment = mesh_.segments[index];
        segment.middle = new_vertex();
        segment.first = static_cast<std::uint32_t>(mesh_.segments.size());
        mesh_.segments[index] = segment;
        mesh_.segments.push_back(
            {segment.edge, segment.from, segment.middle, segment.t0, 0, kNone, kNone});
        mesh_.segments.push_back(
            {segment.edge, segment.middle, segment.to, 0, segment.t1, kNone, kNone});
        Place place{};
        place.vertex = segment.middle;
        place.a = segment.from, place.b = segment.to;
        place.segment = index, place.node = kNone;
        place.from = {segment.t0, 0}, place.to = {segment.t1, 0};
        places_.push_back(place);
    }

    void halve_side(std::uint32_t index) {
        FaceMesh::Side side = mesh_.sides[index];
        const bool border = side.segment != kNone;
        if (side.middle != kNone || !(border ? split_segment_[side.segment] : split_side_[index]))
            return;
        const FaceMesh::Node a = mesh_.nodes[side.from], b = mesh_.nodes[side.to];
        // At a pole every u (or v) is right: the other end's makes a straight line of the two.
        const std::array<double, 2> from{a.any_u ? b.u : a.u, a.any_v ? b.v : a.v};
        const std::array<double, 2> to{b.any_u ? a.u : b.u, b.any_v ? a.v : b.v};
        FaceMesh::Node middle;
        middle.face = a.face;
        std::array<std::uint32_t, 2> halves{kNone, kNone};
        if (border) {
            const FaceMesh::Segment& segment = mesh_.segments[side.segment];
            middle.vertex = segment.middle;
            middle.u = 0.5 * (from[0] + to[0]);
            middle.v = 0.5 * (from[1] + to[1]);
            halves = {segment.first, segment.first + 1};
            on_border(middle, mesh_.coedges[side.coedge], mesh_.segments[segment.first].t1,
                      length(a.vertex, b.vertex));
        } else {
            middle.vertex = new_vertex();
            Place place{};
            place.vertex = middle.vertex;
            place.a = a.vertex, place.b = b.vertex;
            place.segment = kNone, place.face = a.face;
            place.node = static_cast<std::uint32_t>(mesh_.nodes.size());
            place.from = from, place.to = to;
            places_.push_back(place);
        }
        side.middle = static_cast<std::uint32_t>(mesh_.nodes.size());
        side.first = static_cast<std::uint32_t>(mesh_.sides.size());
        mesh_.nodes.push_back(middle);
        mesh_.sides[index] = side;
        mesh_.sides.push_back({side.from, side.middle, halves[0], side.coedge, kNone, kNone});
        mesh_.sides.push_back({side.middle, side.to, halves[1], side.coedge, kNone, kNone});
    }

    /// The parameters on the border's own curve, if that lies where the mean of the ends does.
    void on_border(FaceMesh::Node& node, const FaceMesh::Coedge& coedge, double t,
                   double chord) const {
        if (coedge.curve.IsNull()) return;
        try {
            const gp_Pnt2d uv = coedge.curve->Value(t);
            const Handle(Geom_Surface)& surface = mesh_.surfaces[coedge.face];
            const Vec3 there = vec(surface->Value(uv.X(), uv.Y()));
            const Vec3 mean = vec(surface->Value(node.u, node.v));
            if ((there - mean).norm() <= chord) {
                node.u = uv.X();
                node.v = uv.Y();
            }
        } catch (const Standard_Failure&) {
        }
    }

    void place_vertices() {
        parallel_blocks(places_.size(), kBlock, context_, [&](std::size_t begin, std::size_t end) {
            std::uint32_t face = kNone;
            std::optional<GeomAdaptor_Surface> surface;  // not thread-safe: one for each block
            for (std::size_t i = begin; i < end; ++i) {
                Place& p = places_[i];
                if (p.node != kNone && p.face != face) {
                    face = p.face;
                    surface.emplace(mesh_.surfaces[face]);
                }
                place(p, surface);
            }
        });
        for (const Place& p : places_) {
            mesh_.on_chords += !p.found;
            if (p.node != kNone) {
                mesh_.nodes[p.node].u = p.at(0);
                mesh_.nodes[p.node].v = p.at(1);
            } else {
                const std::uint32_t first = mesh_.segments[p.segment].first;
                mesh_.segments[first].t1 = mesh_.segments[first + 1].t0 = p.at(0);
            }
        }
        places_.clear();
    }

    std::optional<Vec3> evaluate(const Place& p,
                                 const std::optional<GeomAdaptor_Surface>& surface) const {
        try {
            Vec3 point;
            if (p.node == kNone) {
                const Handle(Geom_Curve)& curve = mesh_.curves[mesh_.segments[p.segment].edge];
                if (curve.IsNull()) return std::nullopt;
                point = vec(curve->Value(p.at(0)));
            } else {
                point = vec(surface->Value(p.at(0), p.at(1)));
            }
            if (point.allFinite()) return point;
        } catch (const Standard_Failure&) {
        }
        return std::nullopt;
    }

    /// Half way in parameters, or, where these run too unevenly, nearer to half way in space; the
    /// middle of the chord where nothing else would make the halves shorter.
    void place(Place& p, const std::optional<GeomAdaptor_Surface>& surface) {
        const Vec3 a = mesh_.vertices[p.a], b = mesh_.vertices[p.b];
        Vec3& out = mesh_.vertices[p.vertex];
        out = 0.5 * (a + b);
        const double chord = (a - b).norm();
        double low = 0, high = 1, best = p.a == p.b ? 1e300 : kShorter * chord, best_share = 0.5;
        for (int cut = 0; cut < kCuts; ++cut) {
            p.share = 0.5 * (low + high);
            const auto point = evaluate(p, surface);
            if (!point) break;
            const double from_a = (*point - a).norm(), from_b = (*point - b).norm();
            const double longer = std::max(from_a, from_b);
            if (longer < best) {
                best = longer;
                best_share = p.share;
                out = *point;
                p.found = true;
            }
            if (p.a == p.b || longer < kEven * chord) break;
            (from_a > from_b ? high : low) = p.share;
        }
        p.share = best_share;
    }

    /// The half of a side that ends at `node`.
    std::uint32_t half(std::uint32_t side, std::uint32_t node) const {
        const FaceMesh::Side& s = mesh_.sides[side];
        return s.from == node ? s.first : s.first + 1;
    }

    std::uint32_t new_side(std::uint32_t a, std::uint32_t b) {
        mesh_.sides.push_back({a, b, kNone, kNone, kNone, kNone});
        return static_cast<std::uint32_t>(mesh_.sides.size() - 1);
    }

    void split(const FaceMesh::Corners& t) {
        std::array<std::uint32_t, 3> middle{};
        int count = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            middle[k] = mesh_.sides[t.side[k]].middle;
            count += middle[k] != kNone;
        }
        if (count == 0) {
            mesh_.triangles.push_back(t);
        } else if (count == 3) {
            const std::array<std::uint32_t, 3> cut{new_side(middle[2], middle[0]),
                                                   new_side(middle[0], middle[1]),
                                                   new_side(middle[1], middle[2])};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t before = (k + 2) % 3;
                mesh_.triangles.push_back(
                    {{t.node[k], middle[k], middle[before]},
                     {half(t.side[k], t.node[k]), cut[k], half(t.side[before], t.node[k])}});
            }
            mesh_.triangles.push_back({middle, {cut[1], cut[2], cut[0]}});
        } else {
            std::size_t k = 0;  // count 1: the side that is halved; 2: the one that is not
            while ((middle[k] != kNone) != (count == 1)) ++k;
            split_one_or_two(t, k, middle, count == 1);
        }
    }

    void split_one_or_two(const FaceMesh::Corners& t, std::size_t k,
                          const std::array<std::uint32_t, 3>& middle, bool one) {
        const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
        const std::uint32_t a = t.node[k], b = t.node[l], c = t.node[m];
        if (one) {
            const std::uint32_t cut = new_side(middle[k], c);
            mesh_.triangles.push_back({{a, middle[k], c}, {half(t.side[k], a), cut, t.side[m]}});
            mesh_.triangles.push_back({{middle[k], b, c}, {half(t.side[k], b), t.side[l], cut}});
            return;
        }
        const std::uint32_t p = middle[l], q = middle[m];  // on b-c and on c-a
        const std::uint32_t cut = new_side(p, q);
        mesh_.triangles.push_back({{p, c, q}, {half(t.side[l], c), half(t.side[m], c), cut}});
        const auto span = [&](std::uint32_t x, std::uint32_t y) {
            return length(mesh_.nodes[x].vertex, mesh_.nodes[y].vertex);
        };
        if (span(a, p) <= span(b, q)) {
            const std::uint32_t diagonal = new_side(a, p);
            mesh_.triangles.push_back({{a, b, p}, {t.side[k], half(t.side[l], b), diagonal}});
            mesh_.triangles.push_back({{a, p, q}, {diagonal, cut, half(t.side[m], a)}});
        } else {
            const std::uint32_t diagonal = new_side(b, q);
            mesh_.triangles.push_back({{a, b, q}, {t.side[k], diagonal, half(t.side[m], a)}});
            mesh_.triangles.push_back({{b, p, q}, {half(t.side[l], b), cut, diagonal}});
        }
    }

    FaceMesh& mesh_;
    const std::vector<char>& fine_;
    double longest_;
    const RunContext& context_;
    std::vector<char> split_segment_, split_side_;
    std::vector<Place> places_;
};

}  // namespace

void refine(FaceMesh& mesh, const std::vector<char>& fine, double longest,
            const RunContext& context) {
    Refinement(mesh, fine, longest, context).run();
}

}  // namespace beltgrinding

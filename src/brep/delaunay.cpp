// Own code, because it must be exact and give the same everywhere, and be free for all to use:
// CGAL's is GPL, and Triangle's is not for trade.

#include "delaunay.h"

#include <algorithm>
#include <utility>

namespace beltgrinding {
namespace {

__extension__ using Int128 = __int128;

constexpr std::int32_t kFar = 1 << 28;  // the surrounding triangle's size

int next(int i) {
    return i == 2 ? 0 : i + 1;
}
int prev(int i) {
    return i == 0 ? 2 : i - 1;
}

/// True if d lies inside the circle through the counter-clockwise a, b, c. Exact: differences stay
/// below 2^30, the determinant below 2^124.
bool in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
    const std::int64_t ax = std::int64_t(a.x) - d.x, ay = std::int64_t(a.y) - d.y;
    const std::int64_t bx = std::int64_t(b.x) - d.x, by = std::int64_t(b.y) - d.y;
    const std::int64_t cx = std::int64_t(c.x) - d.x, cy = std::int64_t(c.y) - d.y;
    const Int128 det = Int128(ax * ax + ay * ay) * (bx * cy - by * cx) -
                       Int128(bx * bx + by * by) * (ax * cy - ay * cx) +
                       Int128(cx * cx + cy * cy) * (ax * by - ay * bx);
    return det > 0;
}

/// Order of insertion: rounds of doubling size (Amenta et al. 2003), each along a snake over
/// coarse cells, so that the walk from the last point is short and no point row degenerates.
std::vector<Delaunay::Index> insertion_order(const std::vector<GridPoint>& points) {
    struct Key {
        std::uint64_t key;
        Delaunay::Index index;
    };
    std::vector<Key> keys(points.size());
    for (Delaunay::Index i = 0; i < points.size(); ++i) {
        std::uint64_t hash = (i + 1) * 0x9e3779b97f4a7c15ull;
        hash ^= hash >> 29;
        hash *= 0xbf58476d1ce4e5b9ull;
        hash ^= hash >> 32;
        std::uint64_t round = 0;  // 0 is the last and largest
        while (round < 12 && (hash >> round & 1)) ++round;
        const int bits = std::max(2, 9 - static_cast<int>(round) / 2);
        const auto cell = [&](std::int32_t x) {
            return static_cast<std::uint64_t>(x + kGridHalf) >> (28 - bits);
        };
        const std::uint64_t row = cell(points[i].y);
        std::uint64_t column = cell(points[i].x);
        if (row & 1) column = (1u << bits) - 1 - column;
        keys[i] = {(12 - round) << 40 | row << 20 | column, i};
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
    std::vector<Delaunay::Index> order(points.size());
    for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].index;
    return order;
}

}  // namespace

Delaunay::Delaunay(const std::vector<GridPoint>& points) {
    points_ = {{-kFar, -kFar}, {kFar, -kFar}, {0, kFar}};
    points_.insert(points_.end(), points.begin(), points.end());
    alias_.resize(points.size());
    face_at_.assign(points_.size(), kNone);
    faces_.reserve(2 * points_.size());
    faces_.push_back({{0, 1, 2}, {kNone, kNone, kNone}, 0});
    face_at_[0] = face_at_[1] = face_at_[2] = 0;
    for (const Index i : insertion_order(points)) insert(i + 3);
}

int Delaunay::corner_of(Index face, Index vertex) const {
    const Face& f = faces_[face];
    return f.v[0] == vertex ? 0 : f.v[1] == vertex ? 1 : 2;
}

int Delaunay::corner_towards(Index face, Index neighbour) const {
    const Face& f = faces_[face];
    return f.n[0] == neighbour ? 0 : f.n[1] == neighbour ? 1 : 2;
}

void Delaunay::link(Index face, int corner, Index neighbour) {
    faces_[face].n[static_cast<std::size_t>(corner)] = neighbour;
}

Delaunay::Index Delaunay::locate(const GridPoint& p) {
    Index face = last_;
    int start = 0;
    for (;;) {
        const Face& f = faces_[face];
        bool moved = false;
        for (int k = 0; k < 3; ++k) {
            // The first edge to try changes from step to step: no walk can then circle.
            const auto i = static_cast<std::size_t>((k + start) % 3);
            const auto a = static_cast<std::size_t>(next(static_cast<int>(i)));
            const auto b = static_cast<std::size_t>(prev(static_cast<int>(i)));
            if (f.n[i] != kNone && orient(points_[f.v[a]], points_[f.v[b]], p) < 0) {
                face = f.n[i];
                moved = true;
                break;
            }
        }
        if (!moved) return face;
        start = next(start);
    }
}

void Delaunay::insert(Index vertex) {
    const GridPoint p = points_[vertex];
    const Index face = locate(p);
    const Face old = faces_[face];
    int edge = -1;  // p lies on the edge opposite to this corner
    for (std::size_t i = 0; i < 3; ++i) {
        if (points_[old.v[i]] == p) {
            alias_[vertex - 3] = old.v[i] - 3;
            last_ = face;
            return;
        }
        const auto a = static_cast<std::size_t>(next(static_cast<int>(i)));
        const auto b = static_cast<std::size_t>(prev(static_cast<int>(i)));
        if (orient(points_[old.v[a]], points_[old.v[b]], p) == 0) edge = static_cast<int>(i);
    }
    alias_[vertex - 3] = vertex - 3;
    const auto relink = [&](Index outer, Index from, Index to) {
        if (outer != kNone) link(outer, corner_towards(outer, from), to);
    };
    stack_.clear();
    if (edge < 0) {
        const Index f1 = static_cast<Index>(faces_.size()), f2 = f1 + 1;
        faces_.push_back({{vertex, old.v[2], old.v[0]}, {old.n[1], f2, face}, 0});
        faces_.push_back({{vertex, old.v[0], old.v[1]}, {old.n[2], face, f1}, 0});
        faces_[face] = {{vertex, old.v[1], old.v[2]}, {old.n[0], f1, f2}, 0};
        relink(old.n[1], face, f1);
        relink(old.n[2], face, f2);
        face_at_[old.v[0]] = f1;
        face_at_[old.v[1]] = face_at_[old.v[2]] = face_at_[vertex] = face;
        stack_ = {{face, 0}, {f1, 0}, {f2, 0}};
    } else {
        // Split the edge and both of its triangles.
        const auto e = static_cast<std::size_t>(edge);
        const auto ea = static_cast<std::size_t>(next(edge)),
                   eb = static_cast<std::size_t>(prev(edge));
        const Index a = old.v[ea], b = old.v[eb], top = old.v[e];
        const Index other = old.n[e];
        const Face far = faces_[other];
        const int oc = corner_towards(other, face);
        const Index bottom = far.v[static_cast<std::size_t>(oc)];
        const Index top_a = old.n[eb], top_b = old.n[ea];  // across top-a and b-top
        const Index bottom_a = far.n[static_cast<std::size_t>(next(oc))];
        const Index bottom_b = far.n[static_cast<std::size_t>(prev(oc))];
        // far is (bottom, b, a): its neighbour after b lies across a-bottom.
        const Index f1 = static_cast<Index>(faces_.size()), f2 = f1 + 1;
        faces_.push_back({{vertex, b, top}, {top_b, face, f2}, 0});
        faces_.push_back({{vertex, bottom, b}, {bottom_b, f1, other}, 0});
        faces_[face] = {{vertex, top, a}, {top_a, other, f1}, 0};
        faces_[other] = {{vertex, a, bottom}, {bottom_a, f2, face}, 0};
        relink(top_b, face, f1);
        relink(bottom_b, other, f2);
        face_at_[a] = face_at_[top] = face_at_[vertex] = face;
        face_at_[b] = f1;
        face_at_[bottom] = other;
        stack_ = {{face, 0}, {f1, 0}, {f2, 0}, {other, 0}};
    }
    last_ = face;
    while (!stack_.empty()) {
        const auto [f, c] = stack_.back();
        stack_.pop_back();
        legalise(f, c);
    }
}

/// Checks the edge opposite to the new vertex at `corner`.
void Delaunay::legalise(Index face, int corner) {
    const Face& f = faces_[face];
    const auto c = static_cast<std::size_t>(corner);
    const Index other = f.n[c];
    if (other == kNone || (f.fixed >> corner & 1)) return;
    const int oc = corner_towards(other, face);
    const Index far = faces_[other].v[static_cast<std::size_t>(oc)];
    if (!in_circle(points_[f.v[0]], points_[f.v[1]], points_[f.v[2]], points_[far])) return;
    flip(face, corner);
    // Both faces now have the new vertex at corner 0.
    stack_.push_back({face, 0});
    stack_.push_back({other, 0});
}

/// Replaces the edge opposite to `corner` by the other diagonal of its quad. Afterwards both faces
/// carry the vertex of `corner` at corner 0.
void Delaunay::flip(Index face, int corner) {
    const Face f = faces_[face];
    const auto c = static_cast<std::size_t>(corner);
    const auto ca = static_cast<std::size_t>(next(corner)),
               cb = static_cast<std::size_t>(prev(corner));
    const Index other = f.n[c];
    const Face g = faces_[other];
    const int oc = corner_towards(other, face);
    const auto o = static_cast<std::size_t>(oc);
    const auto on = static_cast<std::size_t>(next(oc)), op = static_cast<std::size_t>(prev(oc));
    const Index p = f.v[c], a = f.v[ca], b = f.v[cb], q = g.v[o];  // g is (q, b, a)
    const auto bit = [](const Face& t, std::size_t i) {
        return static_cast<std::uint8_t>(t.fixed >> i & 1);
    };
    // (p, a, q): across a-q, q-p, p-a.  (p, q, b): across q-b, b-p, p-q.
    faces_[face] = {{p, a, q},
                    {g.n[on], other, f.n[cb]},
                    static_cast<std::uint8_t>(bit(g, on) | bit(f, cb) << 2)};
    faces_[other] = {{p, q, b},
                     {g.n[op], f.n[ca], face},
                     static_cast<std::uint8_t>(bit(g, op) | bit(f, ca) << 1)};
    if (g.n[on] != kNone) link(g.n[on], corner_towards(g.n[on], other), face);
    if (f.n[ca] != kNone) link(f.n[ca], corner_towards(f.n[ca], face), other);
    face_at_[p] = face_at_[a] = face_at_[q] = face;
    face_at_[b] = other;
}

bool Delaunay::find_edge(Index a, Index b, Index& face, int& corner) const {
    const Index first = face_at_[a];
    Index f = first;
    do {
        const int at = corner_of(f, a);
        if (faces_[f].v[static_cast<std::size_t>(next(at))] == b) {
            face = f;
            corner = prev(at);
            return true;
        }
        // A vertex that is no corner of the surrounding triangle has a full fan about it.
        f = faces_[f].n[static_cast<std::size_t>(next(at))];
    } while (f != first && f != kNone);
    return false;
}

bool Delaunay::fix_edge(Index a, Index b) {
    Index face = 0;
    int corner = 0;
    if (!find_edge(a, b, face, corner)) return false;
    Face& f = faces_[face];
    f.fixed = static_cast<std::uint8_t>(f.fixed | 1u << corner);
    const Index other = f.n[static_cast<std::size_t>(corner)];
    if (other == kNone) return true;
    Face& g = faces_[other];
    g.fixed = static_cast<std::uint8_t>(g.fixed | 1u << corner_towards(other, face));
    return true;
}

std::optional<Delaunay::Exit> Delaunay::leave(Index a, Index end) const {
    const GridPoint &pa = points_[a], &pe = points_[end];
    const auto ahead = [&](Index v) {
        return (std::int64_t(points_[v].x) - pa.x) * (std::int64_t(pe.x) - pa.x) +
                   (std::int64_t(points_[v].y) - pa.y) * (std::int64_t(pe.y) - pa.y) >
               0;
    };
    const Index first = face_at_[a];
    Index f = first;
    do {
        const int at = corner_of(f, a);
        const Index r = faces_[f].v[static_cast<std::size_t>(next(at))];
        const Index l = faces_[f].v[static_cast<std::size_t>(prev(at))];
        const std::int64_t side_r = orient(pa, pe, points_[r]);
        const std::int64_t side_l = orient(pa, pe, points_[l]);
        if (side_r == 0 && ahead(r)) return Exit{r, f, at};
        if (side_r < 0 && side_l > 0) return Exit{kNone, f, at};
        f = faces_[f].n[static_cast<std::size_t>(next(at))];
    } while (f != first && f != kNone);
    return std::nullopt;
}

std::optional<Delaunay::Crossed> Delaunay::march(Index a, Index end, const Exit& exit) const {
    const GridPoint &pa = points_[a], &pe = points_[end];
    Crossed crossed;
    Index from = exit.face;
    int edge = exit.corner;
    Index right = faces_[from].v[static_cast<std::size_t>(next(edge))];
    Index left = faces_[from].v[static_cast<std::size_t>(prev(edge))];
    for (;;) {
        if (faces_[from].fixed >> edge & 1) return std::nullopt;
        crossed.edges.push_back({right, left});
        const Index to = faces_[from].n[static_cast<std::size_t>(edge)];
        const int c = corner_towards(to, from);
        const Index v = faces_[to].v[static_cast<std::size_t>(c)];
        const std::int64_t side = orient(pa, pe, points_[v]);
        if (side == 0) {
            crossed.vertex = v;
            return crossed;
        }
        edge = corner_of(to, side > 0 ? left : right);
        (side > 0 ? left : right) = v;
        from = to;
    }
}

bool Delaunay::clear(Index a, Crossed crossed) {
    const Index b = crossed.vertex;
    const GridPoint &pa = points_[a], &pb = points_[b];
    std::deque<std::pair<Index, Index>>& crossing = crossed.edges;
    while (!crossing.empty()) {
        const auto [v, w] = crossing.front();
        crossing.pop_front();
        Index face = 0;
        int corner = 0;
        if (!find_edge(v, w, face, corner)) return false;
        const Index other = faces_[face].n[static_cast<std::size_t>(corner)];
        const Index p = faces_[face].v[static_cast<std::size_t>(corner)];
        const Index q = faces_[other].v[static_cast<std::size_t>(corner_towards(other, face))];
        // Convex: the other diagonal p-q lies strictly between v and w.
        if (orient(points_[p], points_[q], points_[v]) >= 0 ||
            orient(points_[p], points_[q], points_[w]) <= 0) {
            // q is seen from p with v on the right, w on the left, or the quad is not convex.
            crossing.push_back({v, w});
            continue;
        }
        flip(face, corner);
        const std::int64_t sp = orient(pa, pb, points_[p]), sq = orient(pa, pb, points_[q]);
        if (p != a && q != a && p != b && q != b && ((sp < 0 && sq > 0) || (sp > 0 && sq < 0)))
            crossing.push_back({p, q});
    }
    return true;
}

bool Delaunay::constrain(Index point_a, Index point_b) {
    Index a = alias_[point_a] + 3;
    const Index end = alias_[point_b] + 3;
    while (a != end) {
        if (fix_edge(a, end)) return true;
        const std::optional<Exit> exit = leave(a, end);
        if (!exit) return false;
        Index b = exit->vertex;
        if (b == kNone) {
            std::optional<Crossed> crossed = march(a, end, *exit);
            if (!crossed) return false;
            b = crossed->vertex;
            if (!clear(a, std::move(*crossed))) return false;
        }
        if (!fix_edge(a, b)) return false;
        a = b;
    }
    return true;
}

void Delaunay::improve(const std::function<bool(const Face&)>& usable,
                       const std::function<bool(Index, Index, Index, Index)>& better, int passes) {
    for (int pass = 0; pass < passes; ++pass) {
        std::size_t flips = 0;
        for (Index face = 0; face < faces_.size(); ++face) {
            for (int corner = 0; corner < 3; ++corner) {
                const Face& f = faces_[face];
                const auto c = static_cast<std::size_t>(corner);
                const Index other = f.n[c];
                // Each edge is tried from its first face.
                if (other == kNone || other < face || (f.fixed >> corner & 1)) continue;
                const Face& g = faces_[other];
                if (!inner(f) || !inner(g) || !usable(f) || !usable(g)) continue;
                const Index p = f.v[c], a = f.v[static_cast<std::size_t>(next(corner))],
                            b = f.v[static_cast<std::size_t>(prev(corner))];
                const Index q = g.v[static_cast<std::size_t>(corner_towards(other, face))];
                if (orient(points_[p], points_[a], points_[q]) <= 0 ||
                    orient(points_[p], points_[q], points_[b]) <= 0)
                    continue;
                if (!better(a - 3, b - 3, q - 3, p - 3)) continue;
                flip(face, corner);
                ++flips;
            }
        }
        if (flips == 0) return;
    }
}

}  // namespace beltgrinding

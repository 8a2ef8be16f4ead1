#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace beltgrinding {

/// A point of the plane on an integer grid: the predicates below are then exact.
struct GridPoint {
    std::int32_t x = 0, y = 0;  ///< within +-kGridHalf
    bool operator==(const GridPoint&) const = default;
};
constexpr std::int32_t kGridHalf = 1 << 26;

/// Twice the signed area of a, b, c: above 0 if counter-clockwise. Exact.
inline std::int64_t orient(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    return (std::int64_t(b.x) - a.x) * (std::int64_t(c.y) - a.y) -
           (std::int64_t(b.y) - a.y) * (std::int64_t(c.x) - a.x);
}

/// Constrained Delaunay triangulation by incremental insertion with exact predicates (Lawson 1977;
/// constraints by edge flips after Sloan 1993). Vertices 0..2 are a surrounding triangle, point i
/// is vertex i + 3. The result depends on the input only.
class Delaunay {
  public:
    using Index = std::uint32_t;
    static constexpr Index kNone = 0xffffffffu;
    struct Face {
        std::array<Index, 3> v;  ///< counter-clockwise
        std::array<Index, 3> n;  ///< neighbour opposite to v[i], kNone at the outside
        std::uint8_t fixed = 0;  ///< bit i: the edge opposite to v[i] is a constraint
    };

    /// Inserts all points, of which equal ones become one vertex.
    explicit Delaunay(const std::vector<GridPoint>& points);

    /// The point whose vertex stands for point i (itself unless it repeats another).
    Index canonical(Index i) const { return alias_[i]; }
    /// Makes the edges of a straight chain from point a to b (through vertices that lie exactly on
    /// it) part of the triangulation. False where an earlier constraint crosses.
    bool constrain(Index a, Index b);
    /// Flips each edge that is no constraint, whose two triangles `usable` accepts and form a
    /// convex quad, if `better(a, b, c, d)` prefers diagonal c-d to a-b (points; a, c, b, d are
    /// counter-clockwise). Ends after `passes` sweeps at most.
    void improve(const std::function<bool(const Face&)>& usable,
                 const std::function<bool(Index a, Index b, Index c, Index d)>& better, int passes);

    const std::vector<Face>& faces() const { return faces_; }
    /// True if no corner of the face belongs to the surrounding triangle.
    static bool inner(const Face& f) { return f.v[0] > 2 && f.v[1] > 2 && f.v[2] > 2; }
    /// Point of corner i of an inner face.
    static Index point(const Face& f, int i) { return f.v[static_cast<std::size_t>(i)] - 3; }

  private:
    void insert(Index vertex);
    Index locate(const GridPoint& p);
    void legalise(Index face, int corner);
    void flip(Index face, int corner);
    void link(Index face, int corner, Index neighbour);
    int corner_of(Index face, Index vertex) const;
    int corner_towards(Index face, Index neighbour) const;
    bool find_edge(Index a, Index b, Index& face, int& corner) const;
    /// Makes the edge a constraint. False if there is none.
    bool fix_edge(Index a, Index b);
    /// How the straight way from a vertex leaves its fan: along the edge to a vertex that lies on
    /// the way, or (vertex: kNone) through the edge opposite to the face's corner.
    struct Exit {
        Index vertex, face;
        int corner;
    };
    std::optional<Exit> leave(Index a, Index end) const;
    /// The edges, right and left ends, that the way crosses up to the first vertex on it.
    struct Crossed {
        std::deque<std::pair<Index, Index>> edges;
        Index vertex = kNone;
    };
    /// Empty where the way crosses a constraint.
    std::optional<Crossed> march(Index a, Index end, const Exit& exit) const;
    /// Flips the edges out of the way from `a`. False where one is missing.
    bool clear(Index a, Crossed crossed);

    std::vector<GridPoint> points_;
    std::vector<Index> alias_;
    std::vector<Face> faces_;
    std::vector<Index> face_at_;  ///< some face at each vertex
    std::vector<std::pair<Index, int>> stack_;
    Index last_ = 0;
};

}  // namespace beltgrinding

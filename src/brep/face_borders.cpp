#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "beltgrinding/geometry.h"
#include "face_sides.h"

namespace beltgrinding {
namespace {

constexpr double kParallel = 0.7;     // cosine between two borders that run together
constexpr double kLeastLength = 4.0;  // of the tolerance: what touches on less has no border
constexpr int kLeastPieces = 8;       // of a free edge, each compared with the other edges

using Polyline = std::vector<Vec3>;

/// An edge as a face's boundary runs along it, the face's outside (as oriented) to the viewer and
/// its inside to the left.
struct Use {
    std::uint32_t face = 0;
    bool forward = true;
    Polyline line;
};

double length_of(const Polyline& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
    return sum;
}

Polyline polyline(const TopoDS_Edge& edge, const TopoDS_Face& face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) part = BRep_Tool::Triangulation(face, location);
    Polyline line;
    if (part.IsNull()) return line;
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, part, location);
    if (polygon.IsNull()) return line;
    const gp_Trsf& move = location.Transformation();
    for (int i = 1; i <= polygon->NbNodes(); ++i) {
        const gp_Pnt p = part->Node(polygon->Node(i)).Transformed(move);
        line.emplace_back(p.X(), p.Y(), p.Z());
    }
    if (edge.Orientation() == TopAbs_REVERSED) std::reverse(line.begin(), line.end());
    return line;
}

/// The uses of each edge, in the order of the edges' first ones; seams and poles are left out.
std::vector<std::vector<Use>> uses_of_edges(const TopoDS_Shape& shape) {
    TopTools_IndexedMapOfShape faces, edges;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    std::vector<std::vector<Use>> uses(static_cast<std::size_t>(edges.Extent()));
    for (int f = 1; f <= faces.Extent(); ++f) {
        const TopoDS_Face& face = TopoDS::Face(faces(f));
        std::map<int, int> count;
        for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next())
            ++count[edges.FindIndex(e.Current())];
        for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
            const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
            const int index = edges.FindIndex(edge);
            if (count[index] != 1 || BRep_Tool::Degenerated(edge)) continue;
            Use use{static_cast<std::uint32_t>(f - 1), edge.Orientation() != TopAbs_REVERSED,
                    polyline(edge, face)};
            if (use.line.size() > 1) uses[static_cast<std::size_t>(index - 1)].push_back(use);
        }
    }
    return uses;
}

/// What of `line` runs along `other` within the tolerance, mm: in the same way, and against it.
std::pair<double, double> along(const Polyline& line, const Polyline& other, double tolerance) {
    const double piece = length_of(line) / kLeastPieces;
    double same = 0, against = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec3 way = line[i] - line[i - 1];
        const double length = way.norm();
        if (!(length > 0)) continue;
        const int pieces = std::max(1, static_cast<int>(std::ceil(length / piece)));
        for (int k = 0; k < pieces; ++k) {
            const Vec3 p = line[i - 1] + (k + 0.5) / pieces * way;
            double nearest = tolerance, cosine = 0;
            for (std::size_t j = 1; j < other.size(); ++j) {
                const Vec3 side = other[j] - other[j - 1];
                const double size = side.squaredNorm();
                if (!(size > 0)) continue;
                const double share = std::clamp((p - other[j - 1]).dot(side) / size, 0.0, 1.0);
                const double distance = (p - other[j - 1] - share * side).norm();
                if (distance > nearest) continue;
                nearest = distance;
                cosine = side.dot(way) / (std::sqrt(size) * length);
            }
            if (cosine > kParallel) same += length / pieces;
            if (cosine < -kParallel) against += length / pieces;
        }
    }
    return {same, against};
}

/// Adds borders of free edges, those of one face only, that lie on each other.
void match_free_edges(const std::vector<const Use*>& free, double tolerance,
                      std::vector<FaceBorder>& borders) {
    struct Candidate {
        Box box;
        double length;
        const Use* use;
    };
    std::vector<Candidate> edges;
    for (const Use* use : free) {
        Box box;
        for (const Vec3& p : use->line) box.extend(p);
        edges.push_back({box, length_of(use->line), use});
    }
    std::stable_sort(edges.begin(), edges.end(), [](const Candidate& a, const Candidate& b) {
        return a.box.min().x() < b.box.min().x();
    });
    const Vec3 margin = Vec3::Constant(tolerance);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Box grown(edges[i].box.min() - margin, edges[i].box.max() + margin);
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
            if (edges[j].box.min().x() > grown.max().x()) break;
            if (edges[i].use->face == edges[j].use->face || !grown.intersects(edges[j].box))
                continue;
            const bool first = edges[i].length <= edges[j].length;
            const Use &a = *edges[i].use, &b = *edges[j].use;
            const auto [same, against] =
                first ? along(a.line, b.line, tolerance) : along(b.line, a.line, tolerance);
            if (!(std::max(same, against) > kLeastLength * tolerance)) continue;
            borders.push_back({std::min(a.face, b.face), std::max(a.face, b.face),
                               std::max(same, against), against > same, true});
        }
    }
}

}  // namespace

std::vector<FaceBorder> common_borders(const TopoDS_Shape& meshed, double tolerance) {
    const std::vector<std::vector<Use>> edges = uses_of_edges(meshed);
    std::vector<FaceBorder> borders;
    std::vector<const Use*> free;
    for (const std::vector<Use>& uses : edges) {
        if (uses.size() == 1) free.push_back(&uses.front());
        for (std::size_t i = 0; i < uses.size(); ++i)
            for (std::size_t j = i + 1; j < uses.size(); ++j)
                borders.push_back({std::min(uses[i].face, uses[j].face),
                                   std::max(uses[i].face, uses[j].face), length_of(uses[i].line),
                                   uses[i].forward != uses[j].forward, uses.size() == 2});
    }
    match_free_edges(free, tolerance, borders);
    std::stable_sort(borders.begin(), borders.end(),
                     [](const FaceBorder& a, const FaceBorder& b) { return a.length > b.length; });
    return borders;
}

}  // namespace beltgrinding

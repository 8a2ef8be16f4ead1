#include "mesh_assembly.h"

#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "mesh/topology.h"

namespace beltgrinding {
namespace {

constexpr double kSameParameters = 1e-2;  // of an edge's extent in the face's parameters

/// Takes OpenCASCADE's triangulation of a shape over into a FaceMesh.
class Assembly {
  public:
    Assembly(const TopoDS_Shape& shape, const std::vector<char>& reverse) : reverse_(reverse) {
        TopExp::MapShapes(shape, TopAbs_FACE, faces_);
        TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
        TopExp::MapShapes(shape, TopAbs_VERTEX, corners_);
        for (int i = 1; i <= corners_.Extent(); ++i)
            add_vertex(BRep_Tool::Pnt(TopoDS::Vertex(corners_(i))));
        chains_.resize(static_cast<std::size_t>(edges_.Extent()));
        for (int i = 1; i <= edges_.Extent(); ++i) {
            double first = 0, last = 0;
            const TopoDS_Edge edge = TopoDS::Edge(edges_(i));
            mesh.curves.push_back(BRep_Tool::Curve(edge, first, last));
        }
        for (int i = 1; i <= faces_.Extent(); ++i) add_face(static_cast<std::uint32_t>(i - 1));
        collapse();
    }

    AssembledMesh take() { return {std::move(mesh), std::move(without_triangles), torn}; }

  private:
    /// The segments of an edge of the shape and the vertices between them.
    struct Chain {
        std::vector<std::uint32_t> vertices;
        std::uint32_t first_segment = kNone;
    };

    std::uint32_t add_vertex(const gp_Pnt& p) {
        mesh.vertices.emplace_back(p.X(), p.Y(), p.Z());
        return same_place_.add();
    }

    void add_face(std::uint32_t number) {
        const TopoDS_Face face = TopoDS::Face(faces_(static_cast<int>(number) + 1));
        TopLoc_Location location;
        const Handle(Poly_Triangulation) part = BRep_Tool::Triangulation(face, location);
        mesh.surfaces.push_back(BRep_Tool::Surface(face));
        if (part.IsNull() || part->NbTriangles() == 0 || !part->HasUVNodes()) {
            without_triangles.push_back(number);
            return;
        }
        const gp_Trsf& move = location.Transformation();
        const auto base = static_cast<std::uint32_t>(mesh.nodes.size());
        for (int i = 1; i <= part->NbNodes(); ++i) {
            const gp_Pnt2d uv = part->UVNode(i);
            FaceMesh::Node node;
            node.face = number;
            node.u = uv.X();
            node.v = uv.Y();
            mesh.nodes.push_back(node);
        }
        std::unordered_map<std::uint64_t, std::uint32_t> sides;  // by their nodes
        sides.reserve(2 * static_cast<std::size_t>(part->NbTriangles()));
        // As if the face were forward: the two uses of a seam are told apart by their orientation.
        for (TopExp_Explorer e(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); e.More(); e.Next())
            add_border(TopoDS::Edge(e.Current()), face, number, part, location, base, sides);
        for (int i = 1; i <= part->NbNodes(); ++i) {
            FaceMesh::Node& node = mesh.nodes[base + static_cast<std::uint32_t>(i - 1)];
            if (node.vertex == kNone) node.vertex = add_vertex(part->Node(i).Transformed(move));
        }
        const bool flip = ((face.Orientation() == TopAbs_REVERSED) != move.IsNegative()) !=
                          (reverse_[number] != 0);
        for (int i = 1; i <= part->NbTriangles(); ++i) {
            std::array<int, 3> n{};
            part->Triangle(i).Get(n[0], n[1], n[2]);
            if (flip) std::swap(n[1], n[2]);
            FaceMesh::Corners t{};
            for (std::size_t k = 0; k < 3; ++k)
                t.node[k] = base + static_cast<std::uint32_t>(n[k] - 1);
            for (std::size_t k = 0; k < 3; ++k)
                t.side[k] = side_of(sides, t.node[k], t.node[(k + 1) % 3]);
            mesh.triangles.push_back(t);
        }
    }

    std::uint32_t side_of(std::unordered_map<std::uint64_t, std::uint32_t>& sides, std::uint32_t a,
                          std::uint32_t b) {
        const auto [at, is_new] =
            sides.try_emplace(edge_key(a, b), static_cast<std::uint32_t>(mesh.sides.size()));
        if (is_new) mesh.sides.push_back({a, b, kNone, kNone, kNone, kNone});
        return at->second;
    }

    void add_border(const TopoDS_Edge& edge, const TopoDS_Face& face, std::uint32_t number,
                    const Handle(Poly_Triangulation) & part, const TopLoc_Location& location,
                    std::uint32_t base, std::unordered_map<std::uint64_t, std::uint32_t>& sides) {
        const Handle(Poly_PolygonOnTriangulation) polygon =
            BRep_Tool::PolygonOnTriangulation(edge, part, location);
        if (polygon.IsNull() || polygon->NbNodes() < 2) return;
        std::vector<std::uint32_t> nodes;
        for (int i = 1; i <= polygon->NbNodes(); ++i)
            nodes.push_back(base + static_cast<std::uint32_t>(polygon->Node(i) - 1));
        const bool pole = BRep_Tool::Degenerated(edge);
        Chain& chain = chains_[static_cast<std::size_t>(edges_.FindIndex(edge) - 1)];
        if (chain.vertices.empty()) begin(chain, edge, polygon, part, location, pole);
        const bool agrees = chain.vertices.size() == nodes.size();
        if (!agrees) torn = true;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            std::uint32_t vertex = kNone;
            if (agrees) vertex = chain.vertices[k];
            if (k == 0) vertex = chain.vertices.front();
            if (k + 1 == nodes.size()) vertex = chain.vertices.back();
            if (vertex == kNone) continue;
            std::uint32_t& known = mesh.nodes[nodes[k]].vertex;
            if (known == kNone)
                known = vertex;
            else
                same_place_.join(known, vertex);
        }
        if (pole || !agrees) return;
        const auto coedge = static_cast<std::uint32_t>(mesh.coedges.size());
        const std::size_t segments = nodes.size() - 1;
        mesh.coedges.push_back(
            {number, curve_of(edge, face, mesh.nodes[nodes.front()], mesh.nodes[nodes.back()],
                              mesh.segments[chain.first_segment].t0,
                              mesh.segments[chain.first_segment + segments - 1].t1)});
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
            if (nodes[k] == nodes[k + 1]) continue;
            const auto at = static_cast<std::uint32_t>(mesh.sides.size());
            if (!sides.try_emplace(edge_key(nodes[k], nodes[k + 1]), at).second) continue;
            mesh.sides.push_back({nodes[k], nodes[k + 1],
                                  chain.first_segment + static_cast<std::uint32_t>(k), coedge,
                                  kNone, kNone});
        }
    }

    /// The edge's curve in the face's parameters that runs from node to node, of a seam's two; null
    /// if there is none.
    static Handle(Geom2d_Curve)
        curve_of(const TopoDS_Edge& edge, const TopoDS_Face& face, const FaceMesh::Node& from,
                 const FaceMesh::Node& to, double t0, double t1) {
        if (!BRep_Tool::SameParameter(edge) || !BRep_Tool::SameRange(edge)) return {};
        for (const TopoDS_Shape& use : {edge, TopoDS::Edge(edge.Reversed())}) {
            double first = 0, last = 0;
            Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(
                TopoDS::Edge(use), TopoDS::Face(face.Oriented(TopAbs_FORWARD)), first, last);
            if (curve.IsNull()) return {};
            const auto off = [&](double t, const FaceMesh::Node& n) {
                return curve->Value(t).Distance(gp_Pnt2d(n.u, n.v));
            };
            const double length = curve->Value(t0).Distance(curve->Value(0.5 * (t0 + t1)));
            const double width = gp_Pnt2d(from.u, from.v).Distance(gp_Pnt2d(to.u, to.v));
            const double near = kSameParameters * std::max({length, width, 1e-6});
            if (off(t0, from) <= near && off(t1, to) <= near) return curve;
        }
        return {};
    }

    void begin(Chain& chain, const TopoDS_Edge& edge,
               const Handle(Poly_PolygonOnTriangulation) & polygon,
               const Handle(Poly_Triangulation) & part, const TopLoc_Location& location,
               bool pole) {
        const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
        const int first = corners_.FindIndex(TopExp::FirstVertex(forward));
        const int last = corners_.FindIndex(TopExp::LastVertex(forward));
        const int n = polygon->NbNodes();
        for (int i = 1; i <= n; ++i) {
            if (first > 0 && (i == 1 || pole))
                chain.vertices.push_back(static_cast<std::uint32_t>(first - 1));
            else if (last > 0 && i == n)
                chain.vertices.push_back(static_cast<std::uint32_t>(last - 1));
            else
                chain.vertices.push_back(add_vertex(
                    part->Node(polygon->Node(i)).Transformed(location.Transformation())));
        }
        if (first == 0 && last == 0 && n > 2 && edge.Closed())
            same_place_.join(chain.vertices.front(), chain.vertices.back());
        double t0 = 0, t1 = 0;
        BRep_Tool::Range(edge, t0, t1);
        const auto parameter = [&](int i) {
            if (polygon->HasParameters()) return polygon->Parameters()->Value(i);
            return t0 + (t1 - t0) * double(i - 1) / double(n - 1);
        };
        chain.first_segment = static_cast<std::uint32_t>(mesh.segments.size());
        const auto edge_number = static_cast<std::uint32_t>(edges_.FindIndex(edge) - 1);
        for (int i = 1; i < n; ++i) {
            const auto k = static_cast<std::size_t>(i - 1);
            mesh.segments.push_back({edge_number, chain.vertices[k], chain.vertices[k + 1],
                                     parameter(i), parameter(i + 1), kNone, kNone});
        }
    }

    /// Makes one vertex of those at the same place, one node of a face's at a pole, and drops the
    /// triangles that vanish.
    void collapse() {
        for (FaceMesh::Node& node : mesh.nodes) node.vertex = same_place_.find(node.vertex);
        for (FaceMesh::Segment& s : mesh.segments) {
            s.from = same_place_.find(s.from);
            s.to = same_place_.find(s.to);
        }
        DisjointSets same_node(mesh.nodes.size());
        bool any = false;
        for (const FaceMesh::Corners& t : mesh.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t.node[k], b = t.node[(k + 1) % 3];
                if (mesh.nodes[a].vertex != mesh.nodes[b].vertex) continue;
                any = true;
                same_node.join(a, b);
            }
        }
        if (!any) return;
        for (std::uint32_t i = 0; i < mesh.nodes.size(); ++i) {
            const std::uint32_t stays = same_node.find(i);
            if (stays == i) continue;
            FaceMesh::Node& node = mesh.nodes[stays];
            node.any_u |= mesh.nodes[i].u != node.u;
            node.any_v |= mesh.nodes[i].v != node.v;
        }
        std::unordered_map<std::uint64_t, std::uint32_t> sides;
        std::vector<FaceMesh::Corners> kept;
        for (FaceMesh::Corners t : mesh.triangles) {
            for (std::uint32_t& node : t.node) node = same_node.find(node);
            if (t.node[0] == t.node[1] || t.node[1] == t.node[2] || t.node[2] == t.node[0]) {
                keep_border(t, same_node);
                continue;
            }
            kept.push_back(t);
        }
        mesh.triangles.swap(kept);
        for (FaceMesh::Side& side : mesh.sides) {
            side.from = same_node.find(side.from);
            side.to = same_node.find(side.to);
        }
        // A vanished triangle's other two sides are one now; one on a border stands for both.
        for (FaceMesh::Corners& t : mesh.triangles) {
            for (std::uint32_t& s : t.side) {
                const auto border = replaced_.find(s);
                if (border != replaced_.end()) s = border->second;
            }
        }
        for (FaceMesh::Corners& t : mesh.triangles) {
            for (std::uint32_t& s : t.side) {
                const FaceMesh::Side& side = mesh.sides[s];
                if (side.segment != kNone) continue;
                s = sides.try_emplace(edge_key(side.from, side.to), s).first->second;
            }
        }
    }

    /// A vanished triangle that lies on a border hands the border to its neighbour.
    void keep_border(const FaceMesh::Corners& t, DisjointSets& same_node) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (mesh.sides[t.side[k]].segment == kNone) continue;
            for (std::size_t l = 0; l < 3; ++l) {
                const FaceMesh::Side& other = mesh.sides[t.side[l]];
                if (l == k || other.segment != kNone ||
                    same_node.find(other.from) == same_node.find(other.to))
                    continue;
                replaced_[t.side[l]] = t.side[k];
            }
        }
    }

    FaceMesh mesh;
    std::vector<std::uint32_t> without_triangles;
    bool torn = false;
    const std::vector<char>& reverse_;
    TopTools_IndexedMapOfShape faces_, edges_, corners_;
    std::vector<Chain> chains_;
    DisjointSets same_place_;
    std::unordered_map<std::uint32_t, std::uint32_t> replaced_;  ///< sides
};

}  // namespace

AssembledMesh assemble(const TopoDS_Shape& shape, const std::vector<char>& reverse) {
    return Assembly(shape, reverse).take();
}

}  // namespace beltgrinding

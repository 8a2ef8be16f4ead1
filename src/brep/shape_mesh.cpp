#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp_Pln.hxx>
#include <map>

#include "beltgrinding/error.h"
#include "beltgrinding/shape.h"
#include "mesh/topology.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

constexpr double kAngularDeflection = 0.5;   // rad, OpenCASCADE's customary value
constexpr double kExtentsChord = 2e-3;       // chord error over the pole box's diagonal
constexpr double kSoundSine = 1e-6;          // a triangle flatter than this has no plane
constexpr std::size_t kMergeLimit = 20'000;  // faces; merging coplanar ones slows beyond
constexpr double kCoplanarAngle = 1e-5;      // rad, between facets that are merged

void append_face(const TopoDS_Face& face, bool turned, TriangleMesh& mesh) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) part = BRep_Tool::Triangulation(face, location);
    if (part.IsNull()) return;
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    const gp_Trsf& move = location.Transformation();
    for (int i = 1; i <= part->NbNodes(); ++i) {
        const gp_Pnt p = part->Node(i).Transformed(move);
        mesh.vertices.emplace_back(static_cast<float>(p.X()), static_cast<float>(p.Y()),
                                   static_cast<float>(p.Z()));
    }
    const bool flip = ((face.Orientation() == TopAbs_REVERSED) != move.IsNegative()) != turned;
    for (int i = 1; i <= part->NbTriangles(); ++i) {
        int a = 0, b = 0, c = 0;
        part->Triangle(i).Get(a, b, c);
        if (flip) std::swap(b, c);
        mesh.triangles.push_back({base + static_cast<std::uint32_t>(a - 1),
                                  base + static_cast<std::uint32_t>(b - 1),
                                  base + static_cast<std::uint32_t>(c - 1)});
    }
}

[[noreturn]] void refuse(const Standard_Failure& failure) {
    throw InputError("brep.not_triangulated", "the shape cannot be triangulated: {reason}",
                     {{"reason", failure.GetMessageString()}});
}

/// Vertices of a triangle soup welded where they are equal.
std::vector<std::uint32_t> weld_vertices(const TriangleMesh& mesh, std::vector<Vec3f>& welded) {
    std::vector<std::array<float, 3>> keys;
    keys.reserve(mesh.vertices.size());
    for (const Vec3f& v : mesh.vertices) keys.push_back({v.x(), v.y(), v.z()});
    std::vector<std::uint32_t> place = weld(keys);
    std::uint32_t places = 0;
    for (const std::uint32_t p : place) places = std::max(places, p + 1);
    welded.resize(places);
    for (std::size_t i = place.size(); i-- > 0;) welded[place[i]] = mesh.vertices[i];  // the first
    return place;
}

using EdgeKey = std::pair<std::uint32_t, std::uint32_t>;

/// Turns neighbours to the same sense by walking over the edges that two triangles share.
void orient_alike(std::vector<Triangle>& triangles) {
    std::map<EdgeKey, std::vector<std::size_t>> users;
    const auto edge = [](std::uint32_t a, std::uint32_t b) {
        return EdgeKey{std::min(a, b), std::max(a, b)};
    };
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            users[edge(triangles[t][k], triangles[t][(k + 1) % 3])].push_back(t);
    const auto runs_along = [&](std::size_t t, std::uint32_t a, std::uint32_t b) {
        for (std::size_t k = 0; k < 3; ++k)
            if (triangles[t][k] == a && triangles[t][(k + 1) % 3] == b) return true;
        return false;
    };
    std::vector<char> seen(triangles.size(), 0);
    std::vector<std::size_t> stack;
    for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
        if (seen[seed]) continue;
        seen[seed] = 1;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::size_t t = stack.back();
            stack.pop_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
                const auto& sharing = users[edge(a, b)];
                if (sharing.size() != 2) continue;
                const std::size_t other = sharing[0] == t ? sharing[1] : sharing[0];
                if (seen[other]) continue;
                seen[other] = 1;
                if (runs_along(other, a, b)) std::swap(triangles[other][1], triangles[other][2]);
                stack.push_back(other);
            }
        }
    }
}

}  // namespace

TopoDS_Shape triangulated_copy(const TopoDS_Shape& shape, const MeshingParameters& wanted) {
    const TopoDS_Shape copy = BRepBuilderAPI_Copy(shape, false, false).Shape();
    IMeshTools_Parameters parameters;
    parameters.Deflection = wanted.deflection;
    parameters.Angle = wanted.angle;
    parameters.Relative = wanted.relative;
    parameters.InParallel = true;
    BRepMesh_IncrementalMesh mesher(copy, parameters);
    return copy;
}

TriangleMesh triangles_of(const TopoDS_Shape& shape, const std::vector<char>& turned) {
    TriangleMesh mesh;
    TopTools_IndexedMapOfShape faces;
    if (!turned.empty()) TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next()) {
        const int index = turned.empty() ? 0 : faces.FindIndex(e.Current());
        append_face(TopoDS::Face(e.Current()),
                    index > 0 && turned[static_cast<std::size_t>(index - 1)] != 0, mesh);
    }
    return mesh;
}

Box tight_extents(const TopoDS_Shape& shape, const std::string& name, bool by_reader) {
    Bnd_Box poles;  // may be several times too large: only sets the chord error
    BRepBndLib::Add(shape, poles, false);
    const double diagonal = poles.IsVoid() ? 1.0 : std::sqrt(poles.SquareExtent());
    const MeshingParameters parameters{kExtentsChord * diagonal, kAngularDeflection, false};
    Box box;
    try {
        const TriangleMesh mesh =
            triangles_of(by_reader ? mesh_in_reader(shape, parameters, name, true, RunContext())
                                   : triangulated_copy(shape, parameters));
        for (const Vec3f& v : mesh.vertices) box.extend(v.cast<double>());
    } catch (const Standard_Failure& failure) {
        refuse(failure);
    }
    return box;
}

TriangleMesh triangulate(const Shape& shape, double deflection, const RunContext& context,
                         const std::vector<std::size_t>& faces) {
    if (!(deflection > 0) || !std::isfinite(deflection))
        throw InputError("brep.deflection", "deflection must be above 0 mm, not {deflection:f}",
                         {{"deflection", deflection}});
    const Shape::Impl& impl = shape.impl();
    TopoDS_Shape whole = impl.shape;
    if (!faces.empty()) {
        BRep_Builder builder;
        TopoDS_Compound some;
        builder.MakeCompound(some);
        for (const std::size_t face : faces) {
            if (face >= shape.face_count())
                throw InputError(
                    "brep.no_such_face", "{shape} has no face {face}; it has {count} faces",
                    {{"shape", impl.name}, {"face", face + 1}, {"count", shape.face_count()}});
            builder.Add(some, impl.face(face));
        }
        whole = some;
    }
    TopTools_IndexedMapOfShape used;
    TopExp::MapShapes(whole, TopAbs_FACE, used);
    std::vector<char> turned, reversed;
    for (int i = 1; i <= used.Extent(); ++i) {
        const auto face = static_cast<std::size_t>(impl.faces.FindIndex(used(i)) - 1);
        const bool loose = !shape.bounds_solid(face);
        if (loose && reversed.empty()) reversed = shape.reversed(context);
        turned.push_back(loose && reversed[face] != 0 ? 1 : 0);
    }
    TriangleMesh mesh;
    try {
        mesh = triangles_of(mesh_in_reader(whole, {deflection, kAngularDeflection, false},
                                           impl.name, impl.foreign, context),
                            turned);
    } catch (const Standard_Failure& failure) {
        refuse(failure);
    }
    if (mesh.triangles.empty())
        throw InputError("brep.no_triangles",
                         "{shape}: triangulation gives no triangle; repair the shape",
                         {{"shape", impl.name}});
    return mesh;
}

Shape faces_of_mesh(const TriangleMesh& mesh) {
    std::vector<Vec3f> points;
    const std::vector<std::uint32_t> welded = weld_vertices(mesh, points);
    std::vector<Triangle> sound;
    for (const Triangle& t : mesh.triangles) {
        if (t[0] >= welded.size() || t[1] >= welded.size() || t[2] >= welded.size())
            throw InputError("brep.mesh_triangle_without_vertex",
                             "the mesh has a triangle with a vertex that does not exist");
        const Triangle w{welded[t[0]], welded[t[1]], welded[t[2]]};
        const Vec3 a = points[w[0]].cast<double>(), b = points[w[1]].cast<double>(),
                   c = points[w[2]].cast<double>();
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const double twice_area = (b - a).cross(c - a).norm();
        if (std::isfinite(twice_area) && twice_area > kSoundSine * longest * longest && longest > 0)
            sound.push_back(w);
    }
    if (sound.empty())
        throw InputError("brep.mesh_not_sound",
                         "the mesh has no sound triangle: nothing to make a surface of");
    orient_alike(sound);

    try {
        BRep_Builder builder;
        std::vector<TopoDS_Vertex> vertices(points.size());
        std::map<EdgeKey, TopoDS_Edge> edges;
        std::map<EdgeKey, int> uses;
        const auto point = [&](std::uint32_t i) {
            return gp_Pnt(points[i].x(), points[i].y(), points[i].z());
        };
        TopoDS_Shell shell;
        builder.MakeShell(shell);
        for (const Triangle& t : sound) {
            TopoDS_Wire wire;
            builder.MakeWire(wire);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                const EdgeKey key{std::min(a, b), std::max(a, b)};
                for (const std::uint32_t v : {key.first, key.second})
                    if (vertices[v].IsNull())
                        builder.MakeVertex(vertices[v], point(v), Precision::Confusion());
                TopoDS_Edge& edge = edges[key];
                if (edge.IsNull()) {
                    edge = BRepBuilderAPI_MakeEdge(vertices[key.first], vertices[key.second]);
                    if (edge.IsNull())
                        throw InputError("brep.mesh_edge_too_short",
                                         "the mesh has an edge shorter than 1e-7 mm: check its "
                                         "unit, or weld its vertices");
                }
                uses[key] += 1;
                builder.Add(wire, edge.Oriented(a < b ? TopAbs_FORWARD : TopAbs_REVERSED));
            }
            wire.Closed(true);
            const gp_Vec normal =
                gp_Vec(point(t[0]), point(t[1])).Crossed(gp_Vec(point(t[0]), point(t[2])));
            TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln(point(t[0]), gp_Dir(normal)));
            builder.MakeFace(face, BRep_Tool::Surface(face), Precision::Confusion());
            builder.Add(face, wire);
            builder.Add(shell, face);
        }
        const bool closed =
            std::all_of(uses.begin(), uses.end(), [](const auto& u) { return u.second == 2; });
        shell.Closed(closed);
        TopoDS_Shape result = shell;
        if (closed) {
            TopoDS_Solid solid;
            builder.MakeSolid(solid);
            builder.Add(solid, shell);
            GProp_GProps volume;
            BRepGProp::VolumeProperties(solid, volume);
            if (volume.Mass() < 0) {
                builder.MakeSolid(solid);
                builder.Add(solid, shell.Reversed());
            }
            result = solid;
        }
        if (sound.size() <= kMergeLimit) {
            ShapeUpgrade_UnifySameDomain unify(result, true, true, false);
            unify.SetAngularTolerance(kCoplanarAngle);
            unify.Build();
            if (!unify.Shape().IsNull()) result = unify.Shape();
        }
        return make_shape(result, "mesh");
    } catch (const Standard_Failure& failure) {
        throw InputError("brep.mesh_to_faces", "the mesh cannot be made into faces: {reason}",
                         {{"reason", failure.GetMessageString()}});
    }
}

}  // namespace beltgrinding

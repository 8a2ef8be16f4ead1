#include "brep/surface_mesh.h"

#include <GeomAdaptor_Surface.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "mesh_assembly.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

constexpr double kLongest = 1.41421356237;  // of the spacing: halves are then 0.7 of it or longer
constexpr double kAngle = 0.3;              // rad between neighbouring facets
constexpr int kAttempts = 3;        // at a sound triangulation, each with half the deflection
constexpr double kAreaError = 0.1;  // of a face: what a coarse chord may lack, a lost hole does not
constexpr std::size_t kBlock = 4096;
constexpr double kParallel = 1e-12;  // of the derivatives' product: no normal there

/// Unit normal of each node's surface, its sign as the parametrisation has it; zero where there is
/// none.
std::vector<Vec3> surface_normals(const FaceMesh& mesh, const RunContext& context) {
    std::vector<Vec3> normals(mesh.nodes.size(), Vec3::Zero());
    parallel_blocks(mesh.nodes.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        std::uint32_t face = kNone;
        std::optional<GeomAdaptor_Surface> surface;
        for (std::size_t i = begin; i < end; ++i) {
            const FaceMesh::Node& node = mesh.nodes[i];
            if (node.any_u || node.any_v) continue;
            if (node.face != face) {
                face = node.face;
                surface.emplace(mesh.surfaces[face]);
            }
            try {
                gp_Pnt p;
                gp_Vec du, dv;
                surface->D1(node.u, node.v, p, du, dv);
                const gp_Vec n = du.Crossed(dv);
                const double size = n.Magnitude();
                if (size > kParallel * du.Magnitude() * dv.Magnitude())
                    normals[i] = Vec3(n.X(), n.Y(), n.Z()) / size;
            } catch (const Standard_Failure&) {
            }
        }
    });
    return normals;
}

/// The faces at each vertex with their outward normals. The triangles tell which side is outside,
/// and the normal where the surface has none.
void find_meetings(const FaceMesh& mesh, const RunContext& context, SurfaceMesh& out) {
    std::vector<Vec3> normals = surface_normals(mesh, context);
    std::vector<Vec3> facets(mesh.nodes.size(), Vec3::Zero());
    std::vector<double> agreement(mesh.surfaces.size(), 0.0);
    std::vector<char> used(mesh.nodes.size(), 0);
    for (const FaceMesh::Corners& t : mesh.triangles) {
        const auto at = [&](std::size_t k) { return mesh.vertices[mesh.nodes[t.node[k]].vertex]; };
        const Vec3 twice = (at(1) - at(0)).cross(at(2) - at(0));
        for (const std::uint32_t n : t.node) {
            facets[n] += twice;
            agreement[mesh.nodes[n].face] += twice.dot(normals[n]);
            used[n] = 1;
        }
    }
    struct Found {
        std::uint32_t vertex, face, node;
    };
    std::vector<Found> found;
    for (std::uint32_t i = 0; i < mesh.nodes.size(); ++i)
        if (used[i]) found.push_back({mesh.nodes[i].vertex, mesh.nodes[i].face, i});
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return std::tie(a.vertex, a.face, a.node) < std::tie(b.vertex, b.face, b.node);
    });
    for (std::size_t i = 0; i < found.size();) {
        Vec3 sum = Vec3::Zero(), facet = Vec3::Zero();
        std::size_t j = i;
        for (; j < found.size() && found[j].vertex == found[i].vertex &&
               found[j].face == found[i].face;
             ++j) {
            sum += agreement[found[j].face] < 0 ? -normals[found[j].node] : normals[found[j].node];
            facet += facets[found[j].node];
        }
        const Vec3 n = sum.norm() > 0.5 ? sum : facet;
        out.meetings.push_back({found[i].vertex, found[i].face, n.normalized().cast<float>()});
        i = j;
    }
}

/// Numbers the vertices that triangles use from 0.
void compact(const FaceMesh& mesh, SurfaceMesh& out) {
    std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
    for (SurfaceMesh::Meeting& m : out.meetings) {
        if (number[m.vertex] == kNone) {
            number[m.vertex] = static_cast<std::uint32_t>(out.vertices.size());
            out.vertices.push_back(mesh.vertices[m.vertex]);
        }
        m.vertex = number[m.vertex];
    }
    out.triangles.reserve(mesh.triangles.size());
    out.face.reserve(mesh.triangles.size());
    for (const FaceMesh::Corners& t : mesh.triangles) {
        Triangle corner{};
        for (std::size_t k = 0; k < 3; ++k) corner[k] = number[mesh.nodes[t.node[k]].vertex];
        out.triangles.push_back(corner);
        out.face.push_back(mesh.nodes[t.node[0]].face);
    }
}

/// Faces whose triangles do not have the area of their surface.
std::vector<std::uint32_t> spoilt_faces(const Shape& shape, const FaceMesh& mesh) {
    std::vector<double> area(shape.face_count(), 0.0);
    for (const FaceMesh::Corners& t : mesh.triangles) {
        const auto at = [&](std::size_t k) { return mesh.vertices[mesh.nodes[t.node[k]].vertex]; };
        area[mesh.nodes[t.node[0]].face] += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    }
    std::vector<std::uint32_t> spoilt;
    for (std::uint32_t f = 0; f < area.size(); ++f) {
        const double exact = shape.face_area(f);
        if (area[f] > 0 && std::abs(area[f] - exact) > kAreaError * exact) spoilt.push_back(f);
    }
    return spoilt;
}

void require_length(double value, const char* code, const char* form) {
    if (!(value > 0) || !std::isfinite(value)) throw InputError(code, form, {{"value", value}});
}

}  // namespace

SurfaceMesh surface_mesh(const Shape& shape, const SurfaceMeshOptions& options,
                         const RunContext& context) {
    require_length(options.deflection, "brep.mesh_deflection",
                   "the mesh's deflection must be above 0 mm, not {value:f}");
    require_length(options.spacing, "brep.mesh_spacing",
                   "the mesh's spacing must be above 0 mm, not {value:f}");
    const Shape::Impl& impl = shape.impl();
    std::vector<char> fine(shape.face_count(), 0), reverse = shape.reversed(context);
    for (const std::size_t f : options.fine_faces) {
        if (f >= fine.size())
            throw InputError("brep.no_such_face",
                             "{shape} has no face {face}; it has {count} faces",
                             {{"shape", impl.name}, {"face", f + 1}, {"count", fine.size()}});
        fine[f] = 1;
    }
    SurfaceMesh out;
    try {
        // A contour that the chords make cross another spoils the face; finer chords mostly do not.
        double deflection = options.deflection;
        AssembledMesh assembly;
        std::vector<std::uint32_t> spoilt;
        for (int attempt = 0; attempt < kAttempts; ++attempt, deflection *= 0.5) {
            const TopoDS_Shape copy = mesh_in_reader(impl.shape, {deflection, kAngle, false},
                                                     impl.name, impl.foreign, context);
            context.report(0.4);
            assembly = assemble(copy, reverse);
            spoilt = spoilt_faces(shape, assembly.mesh);
            if (spoilt.empty()) break;
        }
        for (const std::uint32_t f : spoilt)
            out.warnings.push_back({"brep.face_area_of_triangles",
                                    "the triangles of face {face} of {shape} do not have the "
                                    "face's area; look at its contours",
                                    {{"face", f + 1}, {"shape", impl.name}}});
        context.report(0.45);
        for (const std::uint32_t f : assembly.without_triangles)
            out.warnings.push_back(
                {"brep.face_without_triangles",
                 "face {face} of {shape} has no triangles; the mesh is open there",
                 {{"face", f + 1}, {"shape", impl.name}}});
        if (assembly.torn)
            out.warnings.push_back(
                {"brep.torn",
                 "two faces divide a common edge differently; the mesh is open there",
                 {}});
        FaceMesh& mesh = assembly.mesh;
        if (mesh.triangles.empty())
            throw InputError("brep.no_triangles",
                             "{shape}: triangulation gives no triangle; repair the shape",
                             {{"shape", impl.name}});
        refine(mesh, fine, kLongest * options.spacing, context);
        context.report(0.8);
        if (mesh.on_chords > 0)
            out.warnings.push_back(
                {"brep.on_chords",
                 "{count} vertices lie on chords: no curve or surface runs there",
                 {{"count", mesh.on_chords}}});
        find_meetings(mesh, context, out);
        compact(mesh, out);
    } catch (const Standard_Failure& failure) {
        throw InputError("brep.not_meshed", "{shape} cannot be meshed: {reason}; repair the shape",
                         {{"shape", impl.name}, {"reason", failure.GetMessageString()}});
    }
    context.report(1.0);
    return out;
}

}  // namespace beltgrinding

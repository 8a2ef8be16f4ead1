#include <BRepAdaptor_Curve2d.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "beltgrinding/shape.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

constexpr double kIntegral = 1e-10;   // relative, asked of the adaptive rule
constexpr double kAreasAgree = 1e-3;  // relative: a rule that fails is off by more
constexpr double kAsFar = 1e-6;       // relative: feet that are no farther apart are one circle's
constexpr double kInside = 1e-9;      // in the surface's parameters

Vec3 vec(const gp_XYZ& p) {
    return {p.X(), p.Y(), p.Z()};
}

constexpr int kPieces = 16;  // of a smooth border
// Gauss and Legendre's rule of five points.
constexpr std::array kNodes = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                               0.9061798459386640};
constexpr std::array kWeights = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                 0.4786286704993665, 0.2369268850561891};

struct Foot {
    double distance, u, v;
};

/// The feet of a point on a surface, the nearest first; none where a whole curve is as near.
std::vector<Foot> feet(const Handle(Geom_Surface) & surface, const gp_Pnt& point) {
    const GeomAPI_ProjectPointOnSurf projection(point, surface);
    std::vector<Foot> found;
    if (!projection.IsDone()) return found;
    for (int i = 1; i <= projection.NbPoints(); ++i) {
        Foot foot{};
        foot.distance = projection.Distance(i);
        projection.Parameters(i, foot.u, foot.v);
        found.push_back(foot);
    }
    std::sort(found.begin(), found.end(),
              [](const Foot& a, const Foot& b) { return a.distance < b.distance; });
    const bool round =
        found.size() > 1 && found.back().distance > 0.0 &&
        found.back().distance - found.front().distance < kAsFar * found.back().distance;
    return round ? std::vector<Foot>{} : found;
}

/// The centroid of a plane face, by Green's theorem along its borders: OpenCASCADE's rules are off
/// by 1e-5 of the size where arcs trim it. None where a border is not known in the plane.
std::optional<gp_Pnt> plane_centroid(const TopoDS_Face& face, const BRepAdaptor_Surface& surface) {
    double area = 0.0;
    gp_XY first(0.0, 0.0);  // moments
    for (TopExp_Explorer e(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); e.More(); e.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
        if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) continue;
        const BRepAdaptor_Curve2d border(edge, face);
        const double sign = edge.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0;
        TColStd_Array1OfReal ends(1, border.NbIntervals(GeomAbs_CN) + 1);
        border.Intervals(ends, GeomAbs_CN);
        for (int k = ends.Lower(); k < ends.Upper(); ++k) {
            const double step = (ends(k + 1) - ends(k)) / kPieces;
            for (int i = 0; i < kPieces; ++i) {
                for (std::size_t g = 0; g < kNodes.size(); ++g) {
                    gp_Pnt2d at;
                    gp_Vec2d along;
                    border.D1(ends(k) + step * (i + 0.5 + 0.5 * kNodes[g]), at, along);
                    const double weight = sign * 0.5 * step * kWeights[g];
                    const double turn = at.X() * along.Y() - at.Y() * along.X();
                    area += weight * turn / 2.0;
                    first += at.XY() * (weight * turn / 3.0);
                }
            }
        }
    }
    if (!(std::abs(area) > 0.0)) return std::nullopt;
    return surface.Value(first.X() / area, first.Y() / area);
}

/// The place of the face at u, v, where the face is there and its normal is known.
std::optional<FaceCentre> at(const TopoDS_Face& face, const BRepTopAdaptor_FClass2d& borders,
                             const BRepAdaptor_Surface& surface, double u, double v) {
    if (borders.Perform(gp_Pnt2d(u, v), Standard_True) != TopAbs_IN) return std::nullopt;
    gp_Pnt point;
    gp_Vec along_u, along_v;
    surface.D1(u, v, point, along_u, along_v);
    const Vec3 normal = vec(along_u.Crossed(along_v).XYZ());
    if (!(normal.norm() > 0.0)) return std::nullopt;
    const double sign = face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0;
    FaceCentre found;
    found.point = vec(point.XYZ());
    found.normal = sign * normal.normalized();
    return found;
}

}  // namespace

std::optional<FaceCentre> Shape::face_centre(std::size_t face) const {
    const double area = face_area(face);
    try {
        const TopoDS_Face& its = impl_->face(face);
        GProp_GProps whole;
        BRepGProp::SurfaceProperties(TopoDS::Face(its.Oriented(TopAbs_FORWARD)), whole, kIntegral);
        if (std::abs(std::abs(whole.Mass()) - area) > kAreasAgree * area) return std::nullopt;
        const BRepAdaptor_Surface surface(its);
        gp_Pnt middle = whole.CentreOfMass();
        if (surface.GetType() == GeomAbs_Plane)
            middle = plane_centroid(its, surface).value_or(middle);
        const BRepTopAdaptor_FClass2d borders(its, kInside);
        std::optional<FaceCentre> found;
        for (const Foot& foot : feet(BRep_Tool::Surface(its), middle))
            if ((found = at(its, borders, surface, foot.u, foot.v))) break;
        if (!found) {
            double u[2], v[2];
            BRepTools::UVBounds(its, u[0], u[1], v[0], v[1]);
            found = at(its, borders, surface, 0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
        }
        if (!found) found.emplace();
        found->centroid = vec(middle.XYZ());
        return found;
    } catch (const Standard_Failure&) {
        return std::nullopt;
    }
}

}  // namespace beltgrinding

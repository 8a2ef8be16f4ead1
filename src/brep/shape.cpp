#include "beltgrinding/shape.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <ShapeFix_Edge.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <cmath>

#include "beltgrinding/error.h"
#include "face_sampler.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

constexpr double kLargestExtent = 10e3;   // mm; beyond it a wrong unit is likelier than a part
constexpr double kSmallestExtent = 0.1;   // mm
constexpr double kZeroArea = 1e-9;        // mm2
constexpr double kAreaTolerance = 1e-5;   // asked of the adaptive rule, which misses it tenfold
constexpr double kAreasAgree = 2e-4;      // relative difference of two rules that are both right
constexpr double kJudgeSamples = 150;     // samples along a square face's side
constexpr double kJudgeTolerance = 5e-4;  // relative, of the area by samples
constexpr double kRelativeVolume = 1e-9;  // of the box: below it a volume has no sign

double sampled_area(const TopoDS_Face& face, double guess) {
    FaceRequest request;
    request.face = face;
    request.area = guess;
    request.spacing = std::sqrt(guess) / kJudgeSamples;
    const double coarse = sample_face(request, RunContext()).sampled_area;
    request.spacing /= 2;
    const double fine = sample_face(request, RunContext()).sampled_area;
    return fine + (fine - coarse) / 3;  // the error falls with the square of the spacing
}

/// OpenCASCADE offers a fixed Gauss rule, good where the face is smooth and simply trimmed, and an
/// adaptive one that can fail on extrusions of unsmooth curves. Each is off by up to several
/// percent on some real face; where they differ, samples of the face decide.
double integrate_area(const TopoDS_Face& face) {
    if (BRep_Tool::Surface(face).IsNull()) return 0;
    GProp_GProps fixed, adaptive;
    BRepGProp::SurfaceProperties(face, fixed);
    BRepGProp::SurfaceProperties(face, adaptive, kAreaTolerance);
    const double f = std::abs(fixed.Mass()), a = std::abs(adaptive.Mass());
    if (std::abs(f - a) <= kAreasAgree * a || !(std::max(f, a) > kZeroArea)) return a;
    try {
        const double judge = sampled_area(face, std::max(f, a));
        if (std::abs(a - judge) <= kJudgeTolerance * judge) return a;
        return judge;
    } catch (const InputError&) {
        return a;
    }
}

}  // namespace

void add_missing_curves(const TopoDS_Shape& shape) {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i) {
        const TopoDS_Face face = TopoDS::Face(faces(i));
        for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
            const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
            double first = 0, last = 0;
            try {
                if (BRep_Tool::CurveOnSurface(edge, face, first, last).IsNull() &&
                    !BRep_Tool::Surface(face).IsNull())
                    ShapeFix_Edge().FixAddPCurve(edge, face, false);
            } catch (const Standard_Failure&) {
                // The sampler names the face when it finds the curve missing.
            }
        }
    }
}

Shape make_shape(const TopoDS_Shape& shape, const std::string& name, MissingCurves curves) {
    if (shape.IsNull())
        throw InputError("brep.null_shape",
                         "{shape}: the file gives no shape (null shape); export the part again",
                         {{"shape", name}});
    auto impl = std::make_shared<Shape::Impl>();
    impl->shape = shape;
    impl->name = name;
    TopExp::MapShapes(shape, TopAbs_FACE, impl->faces);
    if (impl->faces.IsEmpty())
        throw InputError("brep.no_faces",
                         "{shape}: the shape has no faces; a solid, shell or face is needed",
                         {{"shape", name}});
    impl->solid_of_face.assign(static_cast<std::size_t>(impl->faces.Extent()), -1);
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
        for (TopExp_Explorer face(solid.Current(), TopAbs_FACE); face.More(); face.Next()) {
            const int index = impl->faces.FindIndex(face.Current());
            if (index > 0)
                impl->solid_of_face[static_cast<std::size_t>(index - 1)] =
                    static_cast<int>(impl->solids.size());
        }
        impl->solids.push_back(solid.Current());
    }
    impl->solid_sign.assign(impl->solids.size(), 0);
    if (curves == MissingCurves::kAdd) add_missing_curves(shape);
    return Shape(std::move(impl));
}

bool Shape::Impl::inside_out(std::size_t face) const {
    const int solid = solid_of_face[face];
    if (solid < 0) return false;
    const std::lock_guard<std::mutex> lock(mutex);
    signed char& sign = solid_sign[static_cast<std::size_t>(solid)];
    if (sign == 0) {
        sign = 1;
        try {
            GProp_GProps volume;
            const TopoDS_Shape& s = solids[static_cast<std::size_t>(solid)];
            BRepGProp::VolumeProperties(s, volume);
            Bnd_Box box;
            BRepBndLib::Add(s, box);
            const double diagonal = box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
            if (volume.Mass() < -kRelativeVolume * std::pow(diagonal, 3)) sign = -1;
        } catch (const Standard_Failure&) {
            // No volume can be told: the faces' own orientation stands.
        }
    }
    return sign < 0;
}

std::size_t Shape::face_count() const {
    return impl_->solid_of_face.size();
}

bool Shape::bounds_solid(std::size_t face) const {
    return impl_->solid_of_face.at(face) >= 0;
}

double Shape::face_area(std::size_t face) const {
    if (face >= face_count())
        throw InputError("brep.no_such_face", "{shape} has no face {face}; it has {count} faces",
                         {{"shape", impl_->name}, {"face", face + 1}, {"count", face_count()}});
    {
        const std::lock_guard<std::mutex> lock(impl_->mutex);
        if (const auto known = impl_->areas.find(face); known != impl_->areas.end())
            return known->second;
    }
    double area = 0;
    try {
        area = integrate_area(TopoDS::Face(impl_->face(face).Oriented(TopAbs_FORWARD)));
    } catch (const Standard_Failure& failure) {
        throw InputError(
            "brep.area_unknown",
            "face {face} of {shape}: its area cannot be found: {reason}; repair the shape",
            {{"face", face + 1}, {"shape", impl_->name}, {"reason", failure.GetMessageString()}});
    }
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->areas[face] = area;
    return area;
}

std::string Shape::surface_type(std::size_t face) const {
    if (face >= face_count())
        throw InputError("brep.no_such_face", "{shape} has no face {face}; it has {count} faces",
                         {{"shape", impl_->name}, {"face", face + 1}, {"count", face_count()}});
    if (BRep_Tool::Surface(impl_->face(face)).IsNull()) return "none";
    switch (BRepAdaptor_Surface(impl_->face(face), false).GetType()) {
        case GeomAbs_Plane:
            return "plane";
        case GeomAbs_Cylinder:
            return "cylinder";
        case GeomAbs_Cone:
            return "cone";
        case GeomAbs_Sphere:
            return "sphere";
        case GeomAbs_Torus:
            return "torus";
        case GeomAbs_BezierSurface:
            return "bezier";
        case GeomAbs_BSplineSurface:
            return "bspline";
        case GeomAbs_SurfaceOfRevolution:
            return "revolution";
        case GeomAbs_SurfaceOfExtrusion:
            return "extrusion";
        case GeomAbs_OffsetSurface:
            return "offset";
        default:
            return "other";
    }
}

Box Shape::extents() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    if (!impl_->extents)
        impl_->extents =
            std::make_unique<Box>(tight_extents(impl_->shape, impl_->name, impl_->foreign));
    return *impl_->extents;
}

bool Shape::valid() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    if (!impl_->valid) {
        try {
            impl_->valid = BRepCheck_Analyzer(impl_->shape).IsValid();
        } catch (const Standard_Failure&) {
            impl_->valid = false;
        }
    }
    return *impl_->valid;
}

std::vector<Fact> Shape::warnings() const {
    std::vector<Fact> found = impl_->odd_things(*this);
    const std::vector<Fact> sides = side_warnings({});
    found.insert(found.end(), sides.begin(), sides.end());
    return found;
}

std::vector<Fact> Shape::Impl::odd_things(const Shape& of) const {
    {
        const std::lock_guard<std::mutex> lock(mutex);
        if (warnings) return *warnings;
    }
    const Box box = of.extents();
    std::vector<Fact> found;
    if (!box.isEmpty()) {
        const double size = box.sizes().maxCoeff();
        if (size > kLargestExtent)
            found.push_back({"brep.too_large",
                             "{shape} is {size:.4g} mm large, more than 10 m: check its unit",
                             {{"shape", name}, {"size", size}}});
        if (size < kSmallestExtent)
            found.push_back(
                {"brep.too_small",
                 "{shape} is only {size:.4g} mm large, less than 0.1 mm: check its unit",
                 {{"shape", name}, {"size", size}}});
    }
    if (!of.valid())
        found.push_back({"brep.not_valid",
                         "{shape} is not a valid shape by OpenCASCADE's check: results near its "
                         "faults may be wrong",
                         {{"shape", name}}});
    std::size_t loose = 0;
    for (std::size_t i = 0; i < of.face_count(); ++i) {
        loose += solid_of_face[i] < 0;
        try {
            if (of.face_area(i) < kZeroArea)
                found.push_back({"brep.face_without_area",
                                 "face {face} of {shape} has no area and is left out",
                                 {{"face", i + 1}, {"shape", name}}});
        } catch (const InputError& error) {
            found.push_back(error.fact());
        }
    }
    if (loose > 0 && loose < of.face_count())
        found.push_back({"brep.loose_faces",
                         "{shape}: {count} of its faces belong to no solid",
                         {{"shape", name}, {"count", loose}}});
    const std::lock_guard<std::mutex> lock(mutex);
    warnings = std::make_unique<std::vector<Fact>>(found);
    return found;
}

}  // namespace beltgrinding

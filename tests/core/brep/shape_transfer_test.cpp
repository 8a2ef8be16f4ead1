#include "shape_transfer.h"

#include <gtest/gtest.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <cstring>
#include <string>

#include "support.h"

namespace beltgrinding {
namespace {

constexpr double kTolerance = 1e-6;  // mm

/// Axes whose directions are nobody's round numbers: normalising them again changes last bits.
gp_Ax3 skew(int i) {
    return gp_Ax3(gp_Pnt(0.1 * i, 0.7, -1.3), gp_Dir(0.3 + 0.17 * i, 0.7, 0.11 * i + 0.05),
                  gp_Dir(0.2, 0.9 - 0.13 * i, 0.4));
}

gp_Trsf skew_motion(int i) {
    gp_Trsf turn, shift;
    turn.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), skew(i).Direction()), 0.1 + 0.37 * i);
    shift.SetTranslation(gp_Vec(0.1, 0.2 * i, 0.3));
    return shift * turn;
}

/// Every kind of surface and curve whose numbers OpenCASCADE's format changes, under locations of
/// locations.
TopoDS_Compound everything() {
    BRep_Builder builder;
    TopoDS_Compound inner, outer;
    builder.MakeCompound(inner);
    builder.MakeCompound(outer);
    for (int i = 0; i < 40; ++i) {
        const gp_Ax2 axes = skew(i).Ax2();
        builder.Add(inner, BRepPrimAPI_MakeTorus(axes, 5, 2).Shape());
        builder.Add(inner, BRepPrimAPI_MakeCone(axes, 3, 1, 4).Shape().Moved(skew_motion(i)));
        const Handle(Geom_Curve) arc(GC_MakeArcOfCircle(gp_Circ(axes, 3), 0.1, 1.9, true).Value());
        const gp_Dir along = skew(i + 7).Direction();
        const Handle(Geom_Surface)
            surfaces[] = {new Geom_RectangularTrimmedSurface(
                              new Geom_SurfaceOfLinearExtrusion(arc, along), 0.2, 1.5, 0.0, 2.0),
                          new Geom_RectangularTrimmedSurface(
                              new Geom_SurfaceOfRevolution(arc, gp_Ax1(gp_Pnt(9, 9, 9), along)),
                              0.1, 1, 0.3, 1.2),
                          new Geom_RectangularTrimmedSurface(
                              new Geom_OffsetSurface(new Geom_CylindricalSurface(skew(i), 2), 0.1),
                              0.0, 1.0, 0.0, 1.0)};
        for (const Handle(Geom_Surface) & surface : surfaces)
            builder.Add(inner, BRepBuilderAPI_MakeFace(surface, kTolerance).Face());
        const Handle(Geom2d_Curve) ellipse = new Geom2d_TrimmedCurve(
            new Geom2d_Ellipse(gp_Ax2d(gp_Pnt2d(0, 0), gp_Dir2d(0.3, 0.1 * i + 0.7)), 0.6, 0.3), 0,
            2);
        builder.Add(inner,
                    BRepBuilderAPI_MakeEdge(
                        ellipse, Handle(Geom_Surface)(new Geom_CylindricalSurface(skew(i), 2)))
                        .Edge());
    }
    for (int i = 0; i < 5; ++i)
        builder.Add(outer, inner.Moved(skew_motion(i)).Moved(skew_motion(i + 3)));
    return outer;
}

std::string points(const TopoDS_Shape& shape) {
    std::string bytes;
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i) {
        const gp_Pnt p = BRep_Tool::Surface(TopoDS::Face(faces(i)))->Value(0.3, 0.7);
        const double xyz[] = {p.X(), p.Y(), p.Z()};
        bytes.append(reinterpret_cast<const char*>(xyz), sizeof xyz);
    }
    return bytes;
}

TEST(ShapeTransfer, KeepsEveryBit) {
    const TopoDS_Compound shape = everything();
    const std::string bytes = pack_shape(shape);
    const TopoDS_Shape again = unpack_shape(bytes);
    EXPECT_TRUE(bytes == pack_shape(again));
    EXPECT_TRUE(points(shape) == points(again));
}

TEST(ShapeTransfer, RefusesWhatIsNoWholeShape) {
    const std::string bytes = pack_shape(BRepPrimAPI_MakeBox(1, 2, 3).Shape());
    EXPECT_THROW(unpack_shape(""), Standard_Failure);
    EXPECT_THROW(unpack_shape(bytes.substr(0, 5)), Standard_Failure);
    EXPECT_THROW(unpack_shape(bytes.substr(0, bytes.size() / 3)), Standard_Failure);
    EXPECT_THROW(unpack_shape(bytes.substr(0, bytes.size() - 1)), Standard_Failure);
    EXPECT_THROW(unpack_shape(bytes + "x"), Standard_Failure);
}

}  // namespace
}  // namespace beltgrinding

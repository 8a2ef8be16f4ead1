#include <gtest/gtest.h>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Pln.hxx>

#include <algorithm>
#include <cmath>
#include <limits>

#include "beltgrinding/error.h"
#include "support.h"

namespace beltgrinding {
namespace {

/// The faces of `solid`, each a copy of its own that shares no edge, those of `reversed` (from 0)
/// the other way round.
Shape exploded(const TopoDS_Shape& solid, const std::vector<std::size_t>& reversed) {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(solid, TopAbs_FACE, faces);
    BRep_Builder builder;
    TopoDS_Compound all;
    builder.MakeCompound(all);
    for (int i = 1; i <= faces.Extent(); ++i) {
        TopoDS_Shape face = BRepBuilderAPI_Copy(faces(i)).Shape();
        if (std::count(reversed.begin(), reversed.end(), std::size_t(i - 1)) > 0) face.Reverse();
        builder.Add(all, face);
    }
    return make_shape(all, "loose");
}

std::vector<std::size_t> numbers(const std::vector<char>& set) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < set.size(); ++i)
        if (set[i] != 0) found.push_back(i);
    return found;
}

std::vector<std::string> codes(const Shape& shape) {
    std::vector<std::string> found;
    for (const Fact& fact : shape.warnings()) found.emplace_back(fact.code);
    return found;
}

using Numbers = std::vector<std::size_t>;
using Codes = std::vector<std::string>;

TEST(FaceSides, FacesWithoutShellAreTurnedOutwards) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(30, 20, 10).Shape();
    for (const Numbers& reversed : {Numbers{}, Numbers{2}, Numbers{0, 1, 4}, Numbers{0, 1, 2, 3, 4},
                                    Numbers{0, 1, 2, 3, 4, 5}}) {
        const Shape shape = exploded(box, reversed);
        EXPECT_EQ(numbers(shape.reversed()), reversed);
        EXPECT_EQ(codes(shape), reversed.empty() ? Codes{} : Codes{"brep.turned"});
        const HeightField field = test::sample(shape, 1.0);
        for (std::size_t i = 0; i < field.size(); ++i)
            ASSERT_GT(field.normal[i].cast<double>().dot(field.point[i] - Vec3(15, 10, 5)), 0.0);
    }
}

TEST(FaceSides, TrianglesFollow) {
    const Shape shape = exploded(BRepPrimAPI_MakeBox(30, 20, 10).Shape(), {1, 3});
    const TriangleMesh mesh = triangulate(shape, 0.1);
    double volume = 0;
    for (const Triangle& t : mesh.triangles) {
        const auto p = [&](std::size_t k) { return mesh.vertices[t[k]].cast<double>().eval(); };
        volume += p(0).dot(p(1).cross(p(2))) / 6.0;
    }
    EXPECT_NEAR(volume, 6000, 1e-6);
    const TriangleMesh one = triangulate(shape, 0.1, {}, {3, 1});
    for (const Triangle& t : one.triangles) {
        const Vec3 a = one.vertices[t[0]].cast<double>(), b = one.vertices[t[1]].cast<double>(),
                   c = one.vertices[t[2]].cast<double>();
        EXPECT_GT((b - a).cross(c - a).dot(a - Vec3(15, 10, 5)), 0.0);
    }
}

TEST(FaceSides, CurvedFacesWithSeamsAndAHole) {
    const TopoDS_Shape ring = BRepPrimAPI_MakeTorus(30, 8).Shape();
    EXPECT_EQ(numbers(exploded(ring, {0}).reversed()), Numbers{0});
    const gp_Pln across(gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, -1, 0), gp_Dir(1, 0, 0)));
    const TopoDS_Shape bush =
        BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(across, 4, 10, 0, 30).Shape(),
                              gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)))
            .Shape();
    for (std::size_t face = 0; face < 4; ++face)
        EXPECT_EQ(numbers(exploded(bush, {face}).reversed()), Numbers{face});
}

TEST(FaceSides, ACavityLooksInwards) {
    BRep_Builder builder;
    TopoDS_Compound both;
    builder.MakeCompound(both);
    for (const double radius : {10.0, 4.0}) {
        TopTools_IndexedMapOfShape faces;
        TopExp::MapShapes(BRepPrimAPI_MakeSphere(radius).Shape(), TopAbs_FACE, faces);
        builder.Add(both, faces(1));
    }
    EXPECT_EQ(numbers(make_shape(both, "hollow").reversed()), Numbers{1});
}

TEST(FaceSides, WhatNothingTellsStaysAsItIsGivenAndIsTold) {
    const TopoDS_Face plane = BRepBuilderAPI_MakeFace(gp_Pln(), 0, 5, 0, 5);
    const Shape down = make_shape(plane.Reversed(), "sheet");
    EXPECT_EQ(numbers(down.reversed()), Numbers{});
    EXPECT_EQ(codes(down), Codes{"brep.side_in_doubt"});
    EXPECT_EQ(codes(down.flipped(true, {})), Codes{});  // somebody has looked
    // A bore's wall alone looks at its axis: open at both ends, it encloses nothing.
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(BRepPrimAPI_MakeCylinder(4, 8).Shape(), TopAbs_FACE, faces);
    const Shape bore = make_shape(faces(1).Reversed(), "bore");
    EXPECT_EQ(numbers(bore.reversed()), Numbers{});
    EXPECT_EQ(codes(bore), Codes{"brep.side_in_doubt"});
    // Two halves of a sheet that disagree: as most of the area is given.
    BRep_Builder builder;
    TopoDS_Compound both;
    builder.MakeCompound(both);
    builder.Add(both, BRepBuilderAPI_MakeFace(gp_Pln(), 0, 5, 0, 5).Shape());
    builder.Add(both, BRepBuilderAPI_MakeFace(gp_Pln(), 5, 7, 0, 5).Shape().Reversed());
    const Shape halves = make_shape(both, "halves");
    EXPECT_EQ(numbers(halves.reversed()), Numbers{1});
    EXPECT_EQ(codes(halves), (Codes{"brep.turned", "brep.side_in_doubt"}));
}

TEST(FaceSides, FlipsAreTheUsers) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(30, 20, 10).Shape();
    const Shape shape = exploded(box, {1});
    EXPECT_EQ(numbers(shape.flipped(false, {4}).reversed()), (Numbers{1, 4}));
    EXPECT_EQ(numbers(shape.flipped(true, {4}).reversed()), (Numbers{0, 2, 3, 5}));
    EXPECT_EQ(codes(shape.flipped(false, {4})), (Codes{"brep.turned", "brep.flipped_inwards"}));
    EXPECT_THROW(shape.flipped(false, {6}), InputError);
    EXPECT_THROW(make_shape(box, "solid").flipped(false, {0}), InputError);
    EXPECT_EQ(numbers(make_shape(box, "solid").flipped(true, {}).reversed()), Numbers{});
}

TEST(FaceSides, ABandWithOneSideIsToldOf) {
    // A Moebius band of facets.
    TriangleMesh mesh;
    constexpr int kSteps = 24;
    for (int i = 0; i <= kSteps; ++i) {
        const double turn = 2 * 3.14159265358979 * i / kSteps;
        for (const double side : {-1.0, 1.0}) {
            const double r = 10 + 2 * side * std::cos(turn / 2);
            mesh.vertices.emplace_back(float(r * std::cos(turn)), float(r * std::sin(turn)),
                                       float(2 * side * std::sin(turn / 2)));
        }
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
        mesh.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
    }
    const auto found = codes(shape_from_mesh(mesh));
    EXPECT_NE(std::find(found.begin(), found.end(), "brep.sides_contrary"), found.end());
}

TEST(FaceSides, RealPartInLooseFaces) {
    const auto data = test::shared_data();
    if (data.empty()) GTEST_SKIP() << "shared data absent (set BELTGRINDING_SHARED)";
    for (const char* file : {"cad/key_k1_alias.stp", "cad/blade_marine_solid_derived.step",
                             "cad/crank_arm.brep", "cad/propeller_3blade.step"}) {
        const Shape part = Shape::read((data / file).string());
        Numbers reversed;
        for (std::size_t face = 0; face < part.face_count(); ++face)
            if (face * 7 % 3 == 1) reversed.push_back(face);
        const Shape shape = exploded(part.impl().shape, reversed);
        ASSERT_EQ(shape.face_count(), part.face_count());
        EXPECT_EQ(numbers(shape.reversed()), reversed) << file;
    }
}

TEST(ScaledShape, IsSoManyTimesLarger) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(30, 20, 10).Shape();
    const std::string text = make_shape(box, "box").write_brep();
    for (const Shape& shape :
         {Shape::from_brep(text, "box", 25.4), Shape::read_brep(text, "box", {}, 25.4)}) {
        ASSERT_EQ(shape.face_count(), 6u);
        EXPECT_NEAR(shape.extents().sizes().x(), 30 * 25.4, 1e-3);
        for (std::size_t face = 0; face < 6; ++face)
            EXPECT_NEAR(shape.face_area(face), 25.4 * 25.4 * make_shape(box, "box").face_area(face),
                        1e-6);
    }
    for (const double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(Shape::from_brep(text, "box", scale), InputError);
        EXPECT_THROW(Shape::read_brep(text, "box", {}, scale), InputError);
    }
}

}  // namespace
}  // namespace beltgrinding

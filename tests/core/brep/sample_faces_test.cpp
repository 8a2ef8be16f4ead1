#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>

#include "beltgrinding/error.h"
#include "support.h"

namespace beltgrinding {
namespace {

using std::numbers::pi;
using test::check_mesh;
using test::even_share;
using test::sample;
using test::total_area;

void expect_sound(const HeightField& field, double area, double mesh_tolerance) {
    const test::MeshCheck mesh = check_mesh(field);
    EXPECT_NEAR(total_area(field), area, 1e-3 * area);
    EXPECT_NEAR(mesh.area, area, mesh_tolerance * area);
    EXPECT_EQ(mesh.open_inside, 0u);
    EXPECT_EQ(mesh.crowded, 0u);
    EXPECT_EQ(mesh.turned, 0u);
    EXPECT_EQ(mesh.across_faces, 0u);
    EXPECT_EQ(mesh.inverted, 0u);
    EXPECT_EQ(mesh.without_triangle, 0u);
    for (std::size_t i = 0; i < field.size(); ++i) {
        ASSERT_NEAR(field.normal[i].norm(), 1.0, 1e-5);
        ASSERT_GT(field.area[i], 0.0f);
        ASSERT_EQ(field.height[i], 0.0);
    }
}

Shape box() {
    return make_shape(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "box");
}

TEST(SampleFaces, BoxIsAnExactGridUpToItsEdges) {
    const HeightField field = sample(box(), 0.5);
    expect_sound(field, 2200, 1e-9);
    EXPECT_EQ(even_share(field), 1.0);
    EXPECT_EQ(field.size(), 2u * (21 * 41 + 41 * 61 + 21 * 61));
    const Vec3 middle(5, 10, 15), half(5, 10, 15);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3 q = (field.point[i] - middle).cwiseQuotient(half);
        int axis = 0;
        field.normal[i].cwiseAbs().maxCoeff(&axis);
        ASSERT_NEAR(q[axis], field.normal[i][axis], 1e-12);  // on the face, pointing out
        const int on = (q.cwiseAbs().array() > 1 - 1e-9).count();
        ASSERT_EQ((field.flags[i] & kOnBoundary) != 0, on > 1);
        const double share = on == 1 ? 1.0 : on == 2 ? 0.5 : 0.25;
        ASSERT_NEAR(field.area[i], 0.25 * share, 1e-6);
    }
}

TEST(SampleFaces, HoledPlaneEndsAtItsTrimmingEdges) {
    TopoDS_Wire outer = BRepBuilderAPI_MakePolygon(gp_Pnt(0, 0, 0), gp_Pnt(20, 0, 0),
                                                   gp_Pnt(25, 15, 0), gp_Pnt(0, 12, 0), true);
    BRepBuilderAPI_MakeFace maker(gp_Pln(), outer);
    TopoDS_Wire hole = BRepBuilderAPI_MakeWire(
        BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(9, 6, 0), gp_Dir(0, 0, -1)), 3.0)));
    maker.Add(hole);
    const Shape shape = make_shape(maker.Face(), "plate");
    const HeightField field = sample(shape, 0.3);
    const double corner = 0.5 * (20 * 15 + 25 * 12);  // shoelace
    EXPECT_NEAR(shape.face_area(0), corner - 9 * pi, 1e-3);
    expect_sound(field, corner - 9 * pi, 1e-3);
    EXPECT_GT(even_share(field), 0.99);
    EXPECT_EQ(check_mesh(field).euler, 0);  // a disc with one hole
    std::size_t on_hole = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const double r = (field.point[i] - Vec3(9, 6, 0)).norm();
        ASSERT_GT(r, 3 - 1e-9);
        if (r < 3 + 1e-9) {
            ++on_hole;
            ASSERT_TRUE(field.flags[i] & kOnBoundary);
        }
    }
    EXPECT_EQ(on_hole, std::size_t(std::lround(6 * pi / 0.3)));
}

TEST(SampleFaces, CylinderHasNoGapAtItsSeam) {
    const HeightField field =
        sample(make_shape(BRepPrimAPI_MakeCylinder(5, 12).Shape(), "cylinder"), 0.4);
    expect_sound(field, 2 * pi * 25 + 2 * pi * 5 * 12, 2e-3);
    // Lateral face: open at its two rims only; Euler characteristic 0 of a band, twice 1 of a disc.
    EXPECT_EQ(check_mesh(field).euler, 2);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const double r = field.point[i].head<2>().norm();
        const bool rim =
            r > 5 - 1e-9 && (field.point[i].z() < 1e-9 || field.point[i].z() > 12 - 1e-9);
        ASSERT_EQ((field.flags[i] & kOnBoundary) != 0, rim);
        if (std::abs(field.normal[i].z()) < 0.5f) {
            ASSERT_NEAR(field.normal[i].cast<double>().head<2>().dot(field.point[i].head<2>()), 5,
                        1e-5);
        }
    }
    EXPECT_GT(even_share(field), 0.97);
}

TEST(SampleFaces, SphereIsClosedAtSeamAndPoles) {
    const HeightField field = sample(make_shape(BRepPrimAPI_MakeSphere(10).Shape(), "ball"), 0.5);
    expect_sound(field, 400 * pi, 2e-3);
    const test::MeshCheck mesh = check_mesh(field);
    EXPECT_EQ(mesh.open, 0u);
    EXPECT_EQ(mesh.euler, 2);
    std::size_t poles = 0;
    double worst = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        poles += (field.flags[i] & kDegenerate) != 0;
        const Vec3 radial = field.point[i].normalized();
        const double off = (field.normal[i].cast<double>() - radial).norm();
        worst = std::max(worst, field.flags[i] & kDegenerate ? 0.0 : off);
        if (field.flags[i] & kDegenerate) {
            EXPECT_LT(off, 0.02);  // from neighbours half a millimetre off
        }
    }
    EXPECT_LT(worst, 1e-6);
    EXPECT_EQ(poles, 2u);
    EXPECT_GT(even_share(field), 0.9);
}

TEST(SampleFaces, TorusIsClosedAtBothSeams) {
    const HeightField field = sample(make_shape(BRepPrimAPI_MakeTorus(10, 3).Shape(), "ring"), 0.4);
    expect_sound(field, 4 * pi * pi * 30, 5e-3);
    const test::MeshCheck mesh = check_mesh(field);
    EXPECT_EQ(mesh.open, 0u);
    EXPECT_EQ(mesh.euler, 0);
    EXPECT_GT(even_share(field), 0.85);
}

TEST(SampleFaces, ConeKeepsItsApex) {
    const HeightField field =
        sample(make_shape(BRepPrimAPI_MakeCone(6, 0, 8).Shape(), "cone"), 0.3);
    expect_sound(field, pi * 36 + pi * 6 * 10, 5e-3);
    std::size_t apex = 0;
    for (std::size_t i = 0; i < field.size(); ++i)
        if (field.flags[i] & kDegenerate) {
            ++apex;
            EXPECT_NEAR(field.point[i].z(), 8, 1e-9);
            EXPECT_GT(field.normal[i].z(), 0.5f);
        }
    EXPECT_EQ(apex, 1u);
}

TEST(SampleFaces, LocalAreasFollowTheSurface) {
    // On a sphere as B-spline, whose parametrisation is uneven, each sample's area must match its
    // own surroundings: an integral over any half of it must come out.
    const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(10).Shape();
    const HeightField field =
        sample(make_shape(BRepBuilderAPI_NurbsConvert(ball).Shape(), "nurbs ball"), 0.25);
    for (const Vec3& axis :
         {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(-0.6, 0, 0.8), Vec3(0, 0.6, -0.8)}) {
        double moment = 0;
        for (std::size_t i = 0; i < field.size(); ++i)
            moment += field.area[i] * std::pow(std::max(0.0, field.point[i].dot(axis)), 4);
        const double exact = 2 * pi * std::pow(10.0, 6) / 5;
        EXPECT_NEAR(moment, exact, 1e-3 * exact) << axis.transpose();
    }
}

TEST(SampleFaces, LooseFaceFollowsItsOrientationAndFlip) {
    const TopoDS_Face plane = BRepBuilderAPI_MakeFace(gp_Pln(), 0, 5, 0, 5);
    const Shape up = make_shape(plane, "sheet"), down = make_shape(plane.Reversed(), "sheet");
    EXPECT_FALSE(up.bounds_solid(0));
    EXPECT_EQ(sample(up, 0.5).normal[0].z(), 1.0f);
    EXPECT_EQ(sample(up, 0.5, {}, true).normal[0].z(), -1.0f);
    const HeightField field = sample(down, 0.5);
    EXPECT_EQ(field.normal[0].z(), -1.0f);
    expect_sound(field, 25, 1e-9);
}

TEST(SampleFaces, InsideOutSolidStillPointsOut) {
    const Shape shape = make_shape(BRepPrimAPI_MakeSphere(4).Shape().Reversed(), "ball");
    const HeightField field = sample(shape, 0.5);
    for (std::size_t i = 0; i < field.size(); ++i)
        ASSERT_GT(field.normal[i].cast<double>().dot(field.point[i]), 3.5);
    EXPECT_EQ(check_mesh(field).inverted, 0u);
}

TEST(SampleFaces, KeepsTheFaceIndexOfASelection) {
    const Shape shape = box();
    const HeightField field = sample(shape, 1.0, {4, 1});
    EXPECT_NEAR(total_area(field), shape.face_area(4) + shape.face_area(1), 1e-3);
    for (const std::uint32_t f : field.face) ASSERT_TRUE(f == 4 || f == 1);
}

TEST(SampleFaces, SpacingLargerThanTheFaceStillCoversIt) {
    for (const TopoDS_Shape& s :
         {BRepPrimAPI_MakeBox(1, 1, 1).Shape(), BRepPrimAPI_MakeSphere(1).Shape(),
          BRepPrimAPI_MakeCylinder(1, 1).Shape(), BRepPrimAPI_MakeTorus(3, 1).Shape()}) {
        const Shape shape = make_shape(s, "small");
        double area = 0;
        for (std::size_t i = 0; i < shape.face_count(); ++i) area += shape.face_area(i);
        EXPECT_NEAR(total_area(sample(shape, 50)), area, 1e-3 * area);
    }
}

TEST(SampleFaces, SameBitsOnOneThread) {
    const Shape shape = make_shape(BRepPrimAPI_MakeTorus(10, 3).Shape(), "ring");
    const HeightField many = sample(shape, 0.3);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const HeightField single = sample(shape, 0.3);
    ASSERT_EQ(many.size(), single.size());
    EXPECT_EQ(0, std::memcmp(many.point.data(), single.point.data(), many.size() * sizeof(Vec3)));
    EXPECT_EQ(0, std::memcmp(many.area.data(), single.area.data(), many.size() * sizeof(float)));
    EXPECT_EQ(many.triangles, single.triangles);
}

std::string message(const std::function<void()>& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no InputError";
}

TEST(SampleFaces, RefusesWhatDoesNotFitAndSaysWhatWould) {
    SamplingOptions options;
    options.spacing = 0.01;
    options.max_bytes = 10'000'000;
    const std::string text = message([&] { sample_faces(box(), {}, options); });
    EXPECT_NE(text.find("0.01 mm"), std::string::npos) << text;
    const std::size_t at = text.find("a spacing of ", 5);
    ASSERT_NE(at, std::string::npos) << text;
    options.spacing = std::stod(text.substr(at + 13));
    EXPECT_NO_THROW(sample_faces(box(), {}, options));
}

TEST(SampleFaces, NamesWrongInput) {
    for (const double spacing : {0.0, -1.0, std::nan(""), double(INFINITY)})
        EXPECT_NE(message([&] { sample(box(), spacing); }).find("spacing"), std::string::npos);
    EXPECT_NE(message([&] { sample(box(), 1, {6}); }).find("no face 7"), std::string::npos);
    EXPECT_NE(message([&] { sample(box(), 1, {2, 2}); }).find("face 3"), std::string::npos);
    RunContext context;
    context.cancel();
    EXPECT_THROW(sample_faces(box(), {}, {}, context), Cancelled);
}

/// The largest bulge of the surface over an edge of the triangles, mm; (n2 - n1) . (p2 - p1) / 8.
double largest_bulge(const HeightField& field) {
    double largest = 0;
    for (const Triangle& t : field.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            const Vec3 turn = (field.normal[b] - field.normal[a]).cast<double>();
            largest = std::max(largest, std::abs(turn.dot(field.point[b] - field.point[a])) / 8);
        }
    return largest;
}

TEST(SampleFaces, PrecisionBoundsTheChordsOnEveryRadius) {
    for (const double radius : {0.1, 0.3, 1.0, 5.0}) {
        const Shape shape = make_shape(BRepPrimAPI_MakeCylinder(radius, 20).Shape(), "rod");
        for (const double precision : {0.01, 0.002}) {
            SamplingOptions options;
            options.spacing = 0.5;
            options.precision = precision;
            const HeightField field = sample_faces(shape, {0}, options);
            const double area = 2 * pi * radius * 20;
            EXPECT_NEAR(total_area(field), area, 1e-5 * area);
            EXPECT_LE(largest_bulge(field), 1.1 * precision) << radius;
            const double wanted = std::clamp(std::sqrt(8 * precision * radius), 0.0125, 0.5);
            const double expected = area / (wanted * 0.5);
            EXPECT_NEAR(static_cast<double>(field.size()), expected, 0.2 * expected) << radius;
            const test::MeshCheck mesh = check_mesh(field);
            EXPECT_EQ(mesh.open_inside + mesh.turned + mesh.inverted + mesh.without_triangle, 0u);
        }
    }
}

/// A leading edge of radius 0.2 mm in one surface with its two flanks, 30 mm long.
Shape leading_edge() {
    const double turn = pi / 3;
    TColgp_Array1OfPnt outline(1, 61);
    for (int i = 0; i <= 60; ++i) {
        const double along = (i - 30) * 0.1, arc = 0.2 * turn;
        const double angle = std::clamp(along / 0.2, -turn, turn);
        const double rest = along - std::clamp(along, -arc, arc);
        outline(i + 1) = gp_Pnt(0.2 * std::sin(angle) + rest * std::cos(turn), 0,
                                0.2 * std::cos(angle) - std::abs(rest) * std::sin(turn));
    }
    const Handle(Geom_BSplineCurve) curve = GeomAPI_PointsToBSpline(outline).Curve();
    const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(curve);
    return make_shape(BRepPrimAPI_MakePrism(edge, gp_Vec(0, 30, 0)).Shape(), "edge");
}

TEST(SampleFaces, LiesDenselyAtALeadingEdgeOnly) {
    SamplingOptions options;
    options.spacing = 0.5;
    const Shape shape = leading_edge();
    options.edge_spacing = 0.5;  // no finer than elsewhere
    const HeightField coarse = sample_faces(shape, {}, options);
    options.edge_spacing = 0.05;
    const HeightField fine = sample_faces(shape, {}, options);
    const HeightField again = sample_faces(shape, {}, options);
    EXPECT_GT(largest_bulge(coarse), 0.04);
    EXPECT_LT(largest_bulge(fine), 0.004);
    EXPECT_NEAR(total_area(fine), total_area(coarse), 1e-4 * total_area(coarse));
    EXPECT_LT(fine.size(), 6 * coarse.size());
    EXPECT_EQ(fine.spacing, 0.5);
    ASSERT_EQ(again.size(), fine.size());
    EXPECT_EQ(std::memcmp(again.point.data(), fine.point.data(), fine.size() * sizeof(Vec3)), 0);
    const test::MeshCheck mesh = check_mesh(fine);
    EXPECT_EQ(mesh.open_inside + mesh.turned + mesh.inverted + mesh.without_triangle, 0u);
    for (std::size_t i = 0; i < fine.size(); ++i) ASSERT_GT(fine.area[i], 0.0f);
}

TEST(SampleFaces, HasARowOnEveryCrownWhateverTheSpacing) {
    const Shape shape = leading_edge().flipped(true, {});  // out of the blade
    for (const double spacing : {0.3, 0.4, 0.5, 0.7, 1.0}) {
        SamplingOptions options;
        options.spacing = spacing;
        const HeightField field = sample_faces(shape, {}, options);
        std::size_t on_crown = 0;
        for (const Vec3f& normal : field.normal) on_crown += normal.z() > 0.985F ? 1 : 0;
        EXPECT_GT(static_cast<double>(on_crown), 20.0 / spacing) << spacing;
        EXPECT_LT(largest_bulge(field), 0.017) << spacing;
        EXPECT_NEAR(total_area(field), 30.0 * 6.0, 0.01 * 180.0) << spacing;
    }
    // A round of more than a millimetre shows at 0.5 mm as it is, and hollows are left alone.
    SamplingOptions options;
    options.spacing = 0.5;
    const Shape rod = make_shape(BRepPrimAPI_MakeCylinder(1.1, 20).Shape(), "rod");
    const HeightField field = sample_faces(rod, {0}, options);
    EXPECT_LT(field.size(), 2.0 * 2.0 * pi * 1.1 * 20 / 0.25);
}

TEST(SampleFaces, RefusesAPrecisionThatMemoryDoesNotAllow) {
    SamplingOptions options;
    options.spacing = 0.5;
    options.precision = 1e-4;
    options.max_bytes = 4'000'000;
    const Shape shape = make_shape(BRepPrimAPI_MakeCylinder(5, 20).Shape(), "rod");
    try {
        sample_faces(shape, {0}, options);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("precision"), std::string::npos) << error.what();
    }
    options.precision = -1;
    EXPECT_THROW(sample_faces(shape, {0}, options), InputError);
}

TEST(SampleFaces, TellsParametersOnRequest) {
    const Shape shape = make_shape(BRepPrimAPI_MakeCylinder(10, 40).Shape(), "cylinder");
    std::size_t round = 0;
    while (shape.surface_type(round) != "cylinder") ++round;
    SamplingOptions options;
    options.spacing = 1.0;
    SamplingReport report;
    const HeightField without = sample_faces(shape, {round}, options, {}, &report);
    EXPECT_TRUE(report.parameters.empty());
    options.parameters = true;
    const HeightField field = sample_faces(shape, {round}, options, {}, &report);
    ASSERT_EQ(report.parameters.size(), field.size());
    ASSERT_EQ(report.period.size(), 1u);
    EXPECT_NEAR(report.period[0][0], 2 * pi, 1e-12);
    EXPECT_EQ(report.period[0][1], 0.0);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const auto [u, v] = report.parameters[i];
        const Vec3 expected(10 * std::cos(u), 10 * std::sin(u), v);
        EXPECT_LT((field.point[i] - expected).norm(), 1e-9);
    }
}

}  // namespace
}  // namespace beltgrinding

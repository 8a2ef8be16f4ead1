#include "inspection/ground_mesh.h"

#include <gtest/gtest.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numbers>

#include "beltgrinding/error.h"
#include "brep/surface_mesh.h"
#include "shape_impl.h"
#include "support/param_name.h"

namespace beltgrinding {
namespace {

using std::numbers::pi;

struct Ground {
    HeightField field;
    SurfaceMesh surface;
    GroundMesh mesh;
};

Ground ground(const Shape& shape, double spacing, const std::function<double(const Vec3&)>& height,
              const std::vector<std::size_t>& faces = {}, double deflection = 0.01) {
    SamplingOptions sampling;
    sampling.spacing = spacing;
    Ground g;
    g.field = sample_faces(shape, faces, sampling);
    for (std::size_t i = 0; i < g.field.size(); ++i) g.field.height[i] = height(g.field.point[i]);
    SurfaceMeshOptions options;
    options.spacing = spacing;
    options.deflection = deflection;
    options.fine_faces = faces;
    for (std::size_t f = 0; faces.empty() && f < shape.face_count(); ++f)
        options.fine_faces.push_back(f);
    g.surface = surface_mesh(shape, options);
    g.mesh = ground_mesh(g.surface, g.field);
    return g;
}

Ground ground(const TopoDS_Shape& shape, double spacing, double height,
              const std::vector<std::size_t>& faces = {}) {
    return ground(
        make_shape(shape, "shape"), spacing, [=](const Vec3&) { return height; }, faces);
}

void expect_closed(const GroundMesh& mesh, long long euler) {
    EXPECT_TRUE(mesh.check.closed());
    EXPECT_EQ(mesh.check.euler, euler);
    EXPECT_EQ(mesh.check.components, 1u);
    EXPECT_EQ(mesh.flat, 0u);
    EXPECT_EQ(mesh.flipped, 0u);
    EXPECT_GT(mesh.check.volume, 0.0);
}

TEST(GroundMesh, ABoxGroundAllRoundIsTheLargerBox) {
    const Ground g = ground(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), 0.7, 0.3);
    expect_closed(g.mesh, 2);
    EXPECT_NEAR(g.mesh.check.volume, 10.6 * 20.6 * 30.6, 1e-6);
    EXPECT_NEAR(g.mesh.design_check.volume, 6000, 1e-8);
    for (const Vec3& v : g.mesh.vertices) {
        const Vec3 half = v - Vec3(5, 10, 15);
        const double outside = std::max(
            {std::abs(half.x()) - 5.3, std::abs(half.y()) - 10.3, std::abs(half.z()) - 15.3});
        EXPECT_NEAR(outside, 0.0, 1e-9);
    }
}

TEST(GroundMesh, OneFaceOfABoxTakesItsBordersWithIt) {
    const Shape box = make_shape(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "box");
    const auto slope = [](const Vec3& p) { return -0.1 - 0.004 * p.y() - 0.003 * p.z(); };
    const Ground g = ground(box, 0.7, slope, {0});  // the face at x = 0
    expect_closed(g.mesh, 2);
    const double removed = 20 * 30 * (0.1 + 0.004 * 10 + 0.003 * 15);
    EXPECT_NEAR(g.mesh.check.volume - g.mesh.design_check.volume, -removed, 1e-6);
    EXPECT_NEAR(g.mesh.expected_volume, -removed, 1e-4);
    std::size_t on_face = 0;
    for (std::size_t v = 0; v < g.mesh.vertices.size(); ++v) {
        const Vec3& p = g.mesh.vertices[v];
        if (g.mesh.standing[v] == MeshVertex::kDesign) {
            EXPECT_TRUE(std::isnan(g.mesh.deviation[v]));
            EXPECT_NEAR(p.x(), 10.0, 1e-12);
            continue;
        }
        ++on_face;
        EXPECT_NEAR(p.x(), -slope(p), 1e-9);
        EXPECT_NEAR(g.mesh.deviation[v], slope(p), 1e-6);
    }
    EXPECT_GT(on_face, 20 * 30 / (0.7 * 0.7) * 0.7);
}

TEST(GroundMesh, RoundShapesKeepTheirTopologyAndGrowByTheHeight) {
    struct Case {
        const char* name;
        TopoDS_Shape shape;
        long long euler;
        double volume;  // mm3, of the ground part
    };
    const double h = 0.2;
    const double cone_side = std::hypot(8.0, 12.0);  // its apex moves by h / sin(half angle)
    const double apex = h * cone_side / 8, base = 8 + h * (cone_side + 8) / 12;
    const Case cases[] = {
        {"sphere", BRepPrimAPI_MakeSphere(8).Shape(), 2, 4.0 / 3 * pi * std::pow(8 + h, 3)},
        {"cylinder", BRepPrimAPI_MakeCylinder(5, 12).Shape(), 2,
         pi * std::pow(5 + h, 2) * (12 + 2 * h)},
        {"torus", BRepPrimAPI_MakeTorus(10, 3).Shape(), 0, 2 * pi * pi * 10 * std::pow(3 + h, 2)},
        {"cone", BRepPrimAPI_MakeCone(8, 0, 12).Shape(), 2, pi / 3 * base * base * (12 + apex + h)},
        {"pipe",
         BRepAlgoAPI_Cut(
             BRepPrimAPI_MakeBox(20, 20, 10).Shape(),
             BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(10, 10, -1), gp_Dir(0, 0, 1)), 5, 12).Shape())
             .Shape(),
         0, (20.4 * 20.4 - pi * std::pow(5 - h, 2)) * 10.4},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const Ground g = ground(c.shape, 0.4, h);
        expect_closed(g.mesh, c.euler);
        // Facets of 0.57 mm on a radius of 3 mm cut off a sagitta of 0.013 mm at most.
        EXPECT_NEAR(g.mesh.check.volume, c.volume, 0.005 * c.volume);
        EXPECT_EQ(g.mesh.limited, 0u);
        EXPECT_TRUE(g.mesh.warnings.empty());
    }
}

TEST(GroundMesh, EveryVertexOfASphereLiesExactlyAtTheHeight) {
    const Ground g = ground(BRepPrimAPI_MakeSphere(8).Shape(), 0.5, -0.25);
    for (const Vec3& v : g.mesh.vertices) EXPECT_NEAR(v.norm(), 7.75, 1e-6);
    for (const SurfaceMesh::Meeting& m : g.surface.meetings)
        EXPECT_GT(m.normal.cast<double>().dot(g.surface.vertices[m.vertex].normalized()), 0.98);
}

TEST(GroundMesh, FineFacesHaveEdgesOfTheSpacingAndOthersAreLeftCoarse) {
    const Shape box = make_shape(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "box");
    const Ground g = ground(box, 0.5, [](const Vec3&) { return 0.1; }, {0});
    std::size_t coarse = 0;
    for (std::size_t i = 0; i < g.surface.triangles.size(); ++i) {
        const Triangle& t = g.surface.triangles[i];
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(
                longest, (g.surface.vertices[t[k]] - g.surface.vertices[t[(k + 1) % 3]]).norm());
        if (g.surface.face[i] != 0) {
            ++coarse;
            continue;
        }
        EXPECT_LE(longest, 1.4143 * 0.5);
    }
    EXPECT_LT(coarse, 2000u);
}

TEST(GroundMesh, SamplesThatMissedLeaveTheVertexOnTheDesign) {
    const Shape box = make_shape(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), "box");
    Ground g = ground(box, 0.5, [](const Vec3&) { return 0.2; }, {0});
    for (std::size_t i = 0; i < g.field.size(); ++i) {
        if (g.field.point[i].y() < 5) continue;
        g.field.flags[i] |= kMissed;
        g.field.height[i] = 0;
    }
    const GroundMesh mesh = ground_mesh(g.surface, g.field);
    EXPECT_GT(mesh.missed, 0u);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (mesh.standing[v] == MeshVertex::kDesign) continue;
        const double y = g.surface.vertices[v].y();
        if (y > 5.6) {
            EXPECT_EQ(mesh.standing[v], MeshVertex::kMissed);
            EXPECT_EQ(mesh.vertices[v], g.surface.vertices[v]);
        } else if (y < 4.4) {
            EXPECT_NEAR(mesh.vertices[v].x(), -0.2, 1e-12);
        }
    }
    EXPECT_FALSE(mesh.warnings.empty());
}

TEST(GroundMesh, AThinEdgeMovesByTheMitreLimitAtMost) {
    BRepBuilderAPI_MakePolygon wire;  // a blade's trailing edge of 6 degrees
    wire.Add(gp_Pnt(0, -1, 0));
    wire.Add(gp_Pnt(19, 0, 0));
    wire.Add(gp_Pnt(0, 1, 0));
    wire.Close();
    const TopoDS_Face profile = BRepBuilderAPI_MakeFace(wire.Wire()).Face();
    const TopoDS_Shape wedge = BRepPrimAPI_MakePrism(profile, gp_Vec(0, 0, 10)).Shape();
    const Ground g = ground(wedge, 0.5, 0.1);
    EXPECT_TRUE(g.mesh.check.closed());
    EXPECT_GT(g.mesh.limited, 0u);
    double farthest = 0;
    for (std::size_t v = 0; v < g.mesh.vertices.size(); ++v)
        farthest = std::max(farthest, (g.mesh.vertices[v] - g.surface.vertices[v]).norm());
    EXPECT_GT(farthest, 0.3);
    EXPECT_LT(farthest, 0.3 * std::sqrt(3.0));
}

TEST(GroundMesh, AnOpenShellGivesAnOpenMeshAndSaysSo) {
    const Ground g = ground(
        BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0, 10, 0, 10).Face(), 0.5,
        0.1);
    EXPECT_FALSE(g.mesh.check.closed());
    EXPECT_GT(g.mesh.check.border_edges, 50u);
    EXPECT_EQ(g.mesh.check.euler, 1);
    ASSERT_EQ(g.mesh.warnings.size(), 1u);
    EXPECT_NE(g.mesh.warnings[0].sentence().find("open"), std::string::npos);
}

TEST(GroundMesh, WithoutGroundNothingIsDisplaced) {
    const Ground g = ground(BRepPrimAPI_MakeSphere(8).Shape(), 0.6, 0.2);
    const GroundMesh design = ground_mesh(g.surface, g.field, false);
    EXPECT_EQ(design.check.volume, g.mesh.design_check.volume);
    for (std::size_t v = 0; v < design.vertices.size(); ++v)
        EXPECT_EQ(design.vertices[v], g.surface.vertices[v]);
}

TEST(GroundMesh, BadOptionsAreRefused) {
    const Shape box = make_shape(BRepPrimAPI_MakeBox(1, 1, 1).Shape(), "box");
    SurfaceMeshOptions options;
    options.spacing = 0;
    EXPECT_THROW(surface_mesh(box, options), InputError);
    options.spacing = 1;
    options.fine_faces = {6};
    EXPECT_THROW(surface_mesh(box, options), InputError);
    EXPECT_THROW(check_mesh({Vec3::Zero()}, {{0, 0, 1}}), InputError);
}

struct Part {
    const char* file;
    std::size_t components;
    bool closed;
};

class RealPart : public testing::TestWithParam<Part> {};

TEST_P(RealPart, GivesAMeshAsClosedAsItself) {
    const char* shared = std::getenv("BELTGRINDING_SHARED");
    const Part& part = GetParam();
    const auto file = std::filesystem::path(shared ? shared : "") / "data" / part.file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "shared data absent";
    const Shape shape = Shape::read(file.string());
    const double size = shape.extents().sizes().maxCoeff();
    const Ground g = ground(
        shape, size / 100, [](const Vec3&) { return 0.0; }, {0, 1, 2, shape.face_count() - 1},
        size / 2000);
    EXPECT_EQ(g.mesh.check.closed(), part.closed);
    EXPECT_EQ(g.mesh.check.components, part.components);
    EXPECT_EQ(g.mesh.check.non_manifold_edges, 0u);
    EXPECT_EQ(g.mesh.check.turned_edges, 0u);
    EXPECT_LE(g.mesh.flat, g.mesh.triangles.size() / 2000);
    double area = 0;
    for (std::size_t f = 0; f < shape.face_count(); ++f) area += shape.face_area(f);
    EXPECT_NEAR(g.mesh.check.area, area, 0.005 * area);
    EXPECT_GT(g.mesh.check.volume, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Cad, RealPart,
                         testing::Values(Part{"cad/blade_marine_solid_derived.step", 1, true},
                                         Part{"cad/ball_valve_lever.step", 4, true},
                                         Part{"cad/crank_arm.brep", 2, true},
                                         Part{"cad/housing_with_spout.brep", 1, true},
                                         Part{"cad/impeller_kj66.step", 11, true},
                                         Part{"cad/propeller_3blade.step", 1, true},
                                         Part{"cad/pump_cover.brep", 1, true},
                                         Part{"cad/key_k1_alias.stp", 1, true},
                                         Part{"cad_nasty/nut_tiny_faces.brep", 1, true},
                                         Part{"cad/casting_3flange_open_shell.stp", 1, false}),
                         [](const auto& test) { return param_name(test.param.file); });

}  // namespace
}  // namespace beltgrinding

#include <gtest/gtest.h>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>

#include <fstream>
#include <functional>
#include <numbers>

#include "beltgrinding/error.h"
#include "support.h"

namespace beltgrinding {
namespace {

std::string message(const std::function<void()>& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no InputError";
}

bool contains(const std::vector<Fact>& all, const std::string& part) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Fact& f) { return f.sentence().find(part) != std::string::npos; });
}

TEST(Shape, SurvivesItsOwnText) {
    const Shape first = make_shape(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "box");
    const Shape second = Shape::from_brep(first.write_brep(), "copy");
    ASSERT_EQ(second.face_count(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(second.face_area(i), first.face_area(i), 1e-9);
        EXPECT_EQ(second.surface_type(i), "plane");
        EXPECT_TRUE(second.bounds_solid(i));
    }
    EXPECT_TRUE(second.extents().sizes().isApprox(Vec3(10, 20, 30), 1e-6));
    EXPECT_TRUE(second.warnings().empty());
}

TEST(Shape, NamesWhatCannotBeRead) {
    EXPECT_NE(message([] { Shape::read("/nowhere/part.step"); }).find("/nowhere/part.step"),
              std::string::npos);
    EXPECT_NE(message([] { Shape::from_brep("no shape", "clip"); }).find("clip"),
              std::string::npos);
    EXPECT_NE(message([] { Shape::from_brep("", "clip"); }).find("clip"), std::string::npos);
    TopoDS_Compound empty;
    BRep_Builder().MakeCompound(empty);
    EXPECT_NE(message([&] { make_shape(empty, "void"); }).find("void: the shape has no faces"),
              std::string::npos);
    EXPECT_NE(message([] { make_shape(TopoDS_Shape(), "null"); }).find("null shape"),
              std::string::npos);
    for (const char* suffix : {".step", ".igs", ".brep", ".dwg"}) {
        const std::filesystem::path path =
            std::filesystem::temp_directory_path() / ("beltgrinding_rubbish" + std::string(suffix));
        std::ofstream(path) << "this is not a shape\n";
        EXPECT_NE(message([&] { Shape::read(path.string()); }).find(path.string()),
                  std::string::npos)
            << suffix;
        std::filesystem::remove(path);
    }
}

TEST(Shape, WarnsOfMistakenUnits) {
    EXPECT_TRUE(contains(make_shape(BRepPrimAPI_MakeBox(2e4, 1e3, 1e3).Shape(), "barn").warnings(),
                         "more than 10 m"));
    EXPECT_TRUE(contains(make_shape(BRepPrimAPI_MakeBox(.01, .02, .03).Shape(), "mite").warnings(),
                         "less than 0.1 mm"));
}

TEST(Shape, TriangulatesOutwards) {
    const Shape ball = make_shape(BRepPrimAPI_MakeSphere(5).Shape(), "ball");
    const TriangleMesh mesh = triangulate(ball, 0.005);
    double volume = 0;
    for (const Triangle& t : mesh.triangles)
        volume += mesh.vertices[t[0]].cast<double>().dot(mesh.vertices[t[1]].cast<double>().cross(
                      mesh.vertices[t[2]].cast<double>())) /
                  6;
    EXPECT_NEAR(volume, 500 * std::numbers::pi / 3, 0.01 * 500);
    EXPECT_THROW(triangulate(ball, 0), InputError);
    EXPECT_THROW(triangulate(ball, NAN), InputError);
}

/// A cube as twelve loose triangles (each with its own corners, as in an STL file).
TriangleMesh cube() {
    TriangleMesh mesh;
    const TriangleMesh welded =
        triangulate(make_shape(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), "cube"), 1);
    for (const Triangle& t : welded.triangles) {
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto v : t) mesh.vertices.push_back(welded.vertices[v]);
        mesh.triangles.push_back({base, base + 1, base + 2});
    }
    return mesh;
}

TEST(ShapeFromMesh, MakesASolidOfMergedFaces) {
    TriangleMesh mesh = cube();
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);  // one turned over
    const Shape shape = shape_from_mesh(mesh);
    ASSERT_EQ(shape.face_count(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_TRUE(shape.bounds_solid(i));
        EXPECT_NEAR(shape.face_area(i), 100, 1e-6);
    }
    const HeightField field = test::sample(shape, 0.5);
    for (std::size_t i = 0; i < field.size(); ++i)
        ASSERT_GT((field.point[i] - Vec3(5, 5, 5)).dot(field.normal[i].cast<double>()), 4.99);
}

TEST(ShapeFromMesh, KeepsAnOpenSheetLooseAndDropsSlivers) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {10, 10, 1}, {0, 10, 0}, {5, 0, 0}, {NAN, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {0, 0, 1}, {0, 1, 5}};
    const Shape shape = shape_from_mesh(mesh);
    EXPECT_EQ(shape.face_count(), 2u);
    EXPECT_FALSE(shape.bounds_solid(0));
    mesh.triangles = {{0, 4, 1}};
    EXPECT_THROW(shape_from_mesh(mesh), InputError);
    mesh.triangles = {{0, 1, 77}};
    EXPECT_THROW(shape_from_mesh(mesh), InputError);
    EXPECT_THROW(shape_from_mesh({}), InputError);
}

}  // namespace
}  // namespace beltgrinding

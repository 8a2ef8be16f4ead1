#include <gtest/gtest.h>

#include "beltgrinding/error.h"
#include "shape_transfer.h"
#include "support.h"
#include "support/param_name.h"

namespace beltgrinding {
namespace {

struct Part {
    const char* file;
    std::size_t faces;
    double spacing;  // mm
    double size;     // mm, largest extent of its mesh as data/INDEX.md gives it; 0: not checked
};

class RealPart : public testing::TestWithParam<Part> {};

TEST_P(RealPart, GivesASoundField) {
    const auto data = test::shared_data();
    if (data.empty()) GTEST_SKIP() << "shared data absent (set BELTGRINDING_SHARED)";
    const Part& part = GetParam();
    const Shape shape = Shape::read((data / part.file).string());
    ASSERT_EQ(shape.face_count(), part.faces);
    const std::string bytes = pack_shape(shape.impl().shape);
    EXPECT_TRUE(bytes == pack_shape(unpack_shape(bytes)));  // to the last bit
    SamplingOptions options;
    options.spacing = part.spacing;
    SamplingReport report;
    const HeightField field = sample_faces(shape, {}, options, {}, &report);

    // Noses take more samples; a corner or a crease does not have its whole face sampled finer.
    options.edge_spacing = part.spacing;
    EXPECT_LE(field.size(), 3 * sample_faces(shape, {}, options).size());

    std::vector<double> area(shape.face_count(), 0.0);
    for (std::size_t i = 0; i < field.size(); ++i) {
        ASSERT_TRUE(field.point[i].allFinite());
        ASSERT_NEAR(field.normal[i].norm(), 1.0, 1e-5);
        ASSERT_GE(field.area[i], 0.0f);
        area[field.face[i]] += field.area[i];
    }
    ASSERT_EQ(report.face_area.size(), part.faces);
    for (std::size_t f = 0; f < part.faces; ++f)
        EXPECT_NEAR(area[f], report.face_area[f], 1e-3 * report.face_area[f] + 1e-9)
            << "face " << f + 1;
    const test::MeshCheck mesh = test::check_mesh(field);
    EXPECT_EQ(mesh.across_faces, 0u);
    EXPECT_EQ(mesh.crowded, 0u);
    EXPECT_EQ(mesh.turned, 0u);
    // At a leading edge sharper than the spacing a sample's normal is not its triangle's.
    EXPECT_LE(mesh.inverted, field.triangles.size() / 5000);
    double total = 0;
    for (const double a : report.face_area) total += a;
    EXPECT_NEAR(mesh.area, total, 0.03 * total);
    if (part.size > 0) {
        EXPECT_NEAR(shape.extents().sizes().maxCoeff(), part.size, 0.01 * part.size);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cad, RealPart,
    testing::Values(Part{"cad/blade_airfoil_periodic.igs", 1, 0.5, 108},
                    Part{"cad/blade_marine_lower.iges", 1, 0.7, 0},
                    Part{"cad/blade_marine_solid_derived.step", 4, 0.7, 103.2},
                    Part{"cad/blade_marine_tip.iges", 1, 0.3, 22.47},
                    Part{"cad/propeller_3blade.step", 51, 0.5, 70},
                    Part{"cad/impeller_kj66.step", 92, 0.7, 116},
                    Part{"cad/housing_with_spout.brep", 323, 1.0, 139.6},
                    Part{"cad/ball_valve_lever.step", 422, 1.0, 157.1},
                    Part{"cad/crank_arm.brep", 53, 0.7, 153.9},
                    Part{"cad/hammer_claw.brep", 45, 100, 38430},
                    Part{"cad/pump_cover.brep", 8, 2.0, 319.9},
                    Part{"cad/casting_3flange_open_shell.stp", 53, 0.7, 0},
                    Part{"cad_nasty/key_k1_inch_solid.stp", 52, 0.5, 127},
                    Part{"cad_nasty/nut_tiny_faces.brep", 25, 0.5, 59.95},
                    Part{"cad_nasty/open_shell_99_bspline.brep", 99, 0.3, 31},
                    Part{"cad_nasty/spring_invalid.igs", 6, 0.5, 72.5},
                    Part{"cad_nasty/assembly_inch_scaled_25x.stp", 160, 20, 5080},
                    Part{"cad_nasty/pipes_corrupted_zero_area.stp", 79, 4, 25470}),
    [](const auto& test) { return param_name(test.param.file); });

std::vector<Fact> warnings_of(const std::filesystem::path& path) {
    return Shape::read(path.string()).warnings();
}

bool any_with(const std::vector<Fact>& all, const std::string& part) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Fact& f) { return f.sentence().find(part) != std::string::npos; });
}

TEST(NastyParts, AreWarnedOfOrRefused) {
    const auto data = test::shared_data();
    if (data.empty()) GTEST_SKIP() << "shared data absent (set BELTGRINDING_SHARED)";
    try {
        Shape::read((data / "cad_nasty/reads_as_null_shape.stp").string());
        ADD_FAILURE() << "a null shape was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("reads_as_null_shape.stp"), std::string::npos);
    }
    const auto pipes = warnings_of(data / "cad_nasty/pipes_corrupted_zero_area.stp");
    EXPECT_TRUE(any_with(pipes, "face 78 of"));
    EXPECT_TRUE(any_with(pipes, "not a valid shape"));
    EXPECT_TRUE(any_with(pipes, "more than 10 m"));
    EXPECT_TRUE(any_with(warnings_of(data / "cad_nasty/open_shell_99_bspline.brep"), "is outside"));
    EXPECT_TRUE(any_with(warnings_of(data / "cad_nasty/spring_invalid.igs"), "not a valid shape"));
    EXPECT_TRUE(any_with(warnings_of(data / "cad/hammer_claw.brep"), "more than 10 m"));
}

}  // namespace
}  // namespace beltgrinding

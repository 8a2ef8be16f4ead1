#include "beltgrinding/stock.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "beltgrinding/error.h"
#include "beltgrinding/mesh_reader.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// An axis-parallel box, outward.
TriangleMesh box(const Vec3f& low, const Vec3f& high) {
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) {
        mesh.vertices.push_back({(k & 1) != 0 ? high.x() : low.x(),
                                 (k & 2) != 0 ? high.y() : low.y(),
                                 (k & 4) != 0 ? high.z() : low.z()});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

HeightField plate_at(double z) {
    HeightField field = testing::plate(20.0, 10.0, 0.5);
    for (Vec3& p : field.point) p += Vec3(5.0, 5.0, z);
    return field;
}

std::string error_of(HeightField field, const TriangleMesh& mesh) {
    try {
        apply_mesh(field, mesh, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Stock, AllowanceIsEverywhere) {
    HeightField field = testing::plate(10.0, 10.0, 1.0);
    const StockReport report = apply_allowance(field, 0.4);
    EXPECT_NEAR(report.volume, 40.0, 1e-5);
    for (const double h : field.height) EXPECT_EQ(h, 0.4);
    EXPECT_EQ(apply_allowance(field, -0.1).defective, field.size());
    EXPECT_THROW(apply_allowance(field, std::nan("")), InputError);
}

TEST(Stock, SealedSolidGivesExactHeights) {
    HeightField field = plate_at(9.4);
    const StockReport report = apply_mesh(field, box({0, 0, 0}, {30, 20, 10}), {});
    EXPECT_EQ(report.missed, 0u);
    EXPECT_EQ(report.defective, 0u);
    for (const double h : field.height) EXPECT_NEAR(h, 0.6, 1e-5);
    EXPECT_NEAR(report.volume, 0.6 * 200.0, 1e-2);
}

TEST(Stock, StockBelowTheDesignIsDefective) {
    HeightField field = plate_at(10.3);
    const StockReport report = apply_mesh(field, box({0, 0, 0}, {30, 20, 10}), {});
    EXPECT_EQ(report.defective, field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_NEAR(field.height[i], -0.3, 1e-5);
        EXPECT_TRUE(field.flags[i] & kDefective);
    }
}

// A box that lies above the design with a gap below it is no stock of this surface.
TEST(Stock, MaterialBeyondAGapDoesNotCount) {
    HeightField field = plate_at(-2.0);
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    EXPECT_NE(error_of(field, mesh).find("no ray meets"), std::string::npos);
    const TriangleMesh below = box({0, 0, -10}, {30, 20, -2.5});
    for (Triangle t : below.triangles) {
        for (auto& v : t) v += 8;
        mesh.triangles.push_back(t);
    }
    mesh.vertices.insert(mesh.vertices.end(), below.vertices.begin(), below.vertices.end());
    apply_mesh(field, mesh, {});
    for (const double h : field.height) EXPECT_NEAR(h, -0.5, 1e-5);
}

TEST(Stock, AScanWithAHoleAndDoubledSurfaceIsSound) {
    TriangleMesh scan;  // an open sheet at z = 10 over x < 15, scanned twice, 0.02 mm apart
    for (const float z : {10.0F, 10.02F}) {
        const auto base = static_cast<std::uint32_t>(scan.vertices.size());
        scan.vertices.insert(scan.vertices.end(), {{0, 0, z}, {15, 0, z}, {15, 20, z}, {0, 20, z}});
        scan.triangles.push_back({base, base + 1, base + 2});
        scan.triangles.push_back({base, base + 2, base + 3});
    }
    HeightField field = plate_at(9.5);
    const StockReport report = apply_mesh(field, scan, {});
    std::size_t missed = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field.point[i].x() > 15.01) {
            EXPECT_TRUE(field.flags[i] & kMissed);
            EXPECT_EQ(field.height[i], 0.0);
            ++missed;
        } else if (field.point[i].x() < 14.99) {
            EXPECT_NEAR(field.height[i], 0.52, 1e-5);
        }
    }
    EXPECT_GE(report.missed, missed);
    EXPECT_FALSE(report.warnings.empty());
}

// The wall of a step under the sample: nearly along the ray, above or below the design.
TEST(Stock, AGrazedWallIsNoSurfaceIfToldSo) {
    for (const bool above : {true, false}) {
        HeightField field = plate_at(above ? 9.5F : 10.5F);
        const auto x = static_cast<float>(field.point[field.size() / 2].x());
        TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
        const float low = above ? 9.5F : 10.0F;
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {{x - 0.01F, 0, low},
                                                   {x - 0.01F, 20, low},
                                                   {x + 0.01F, 20, low + 0.5F},
                                                   {x + 0.01F, 0, low + 0.5F}});
        for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}}) {
            mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
            mesh.triangles.push_back({base + t[0], base + t[2], base + t[1]});
        }
        const double height = above ? 0.5 : -0.5;
        StockOptions options;
        options.least_cosine = 0.1;
        apply_mesh(field, mesh, options);
        for (const double h : field.height) EXPECT_NEAR(h, height, 1e-5);
        apply_mesh(field, mesh, {});
        EXPECT_GT(std::abs(field.height[field.size() / 2] - height), 0.1);
    }
    HeightField field = plate_at(9.5);
    StockOptions options;
    options.least_cosine = 1.0;
    EXPECT_THROW(apply_mesh(field, box({0, 0, 0}, {30, 20, 10}), options), InputError);
}

TEST(Stock, SearchDistancesLimitTheRays) {
    HeightField field = plate_at(2.0);
    StockOptions options;
    options.search_above = 5.0;
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    EXPECT_THROW(apply_mesh(field, mesh, options), InputError);
    options.search_above = 9.0;
    EXPECT_EQ(apply_mesh(field, mesh, options).missed, 0u);
}

TEST(Stock, FarFromTheOriginNothingIsLost) {
    HeightField field = plate_at(9.4);
    const Vec3 shift(123456.0, -65432.0, 0.0);
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    for (Vec3& p : field.point) p += shift;
    for (Vec3f& v : mesh.vertices) v += shift.cast<float>();
    apply_mesh(field, mesh, {});
    for (const double h : field.height) EXPECT_NEAR(h, 0.6, 1e-5);
}

TEST(Stock, SaysWhichUnitWouldFit) {
    TriangleMesh metres = box({0, 0, 0}, {30, 20, 10});
    for (Vec3f& v : metres.vertices) v *= 0.001F;
    EXPECT_NE(error_of(plate_at(9.4), metres).find("metres"), std::string::npos);
    EXPECT_NE(error_of(plate_at(9.4), box({500, 0, 0}, {530, 20, 10})).find("apart"),
              std::string::npos);
}

TEST(Stock, RefusesBrokenMeshes) {
    const HeightField field = plate_at(9.0);
    EXPECT_NE(error_of(field, {}).find("no triangle"), std::string::npos);
    TriangleMesh mesh = box({0, 0, 0}, {30, 20, 10});
    mesh.vertices[3].x() = std::nanf("");
    EXPECT_NE(error_of(field, mesh).find("vertex 3"), std::string::npos);
    mesh = box({0, 0, 0}, {30, 20, 10});
    mesh.triangles[2][1] = 99;
    EXPECT_NE(error_of(field, mesh).find("triangle 2"), std::string::npos);
}

std::filesystem::path shared(const char* file) {
    const char* root = std::getenv("BELTGRINDING_SHARED");
    return std::filesystem::path(root != nullptr ? root : "../shared") / "data" / file;
}

TEST(MeshReader, ReadsARealScanInMetres) {
    const auto path = shared("mesh/DAC_580813_scan.ply");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data: " << path;
    const TriangleMesh mesh = read_mesh(path.string(), 1000.0);
    EXPECT_EQ(mesh.triangles.size(), 179041u);
    Box extents;
    for (const Vec3f& v : mesh.vertices) extents.extend(v.cast<double>());
    EXPECT_NEAR(extents.sizes().x(), 757.9, 0.2);
}

TEST(MeshReader, WeldsAnStl) {
    const auto path = shared("mesh/DAC_580813_cad.stl");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data: " << path;
    const TriangleMesh mesh = read_mesh(path.string(), 1000.0);
    EXPECT_EQ(mesh.triangles.size(), 34596u);
    EXPECT_EQ(mesh.vertices.size(), 17298u);
}

std::string written(const std::string& name, const std::string& content) {
    const std::string path = (std::filesystem::temp_directory_path() / name).string();
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

TEST(MeshReader, ReadsPlyOfEveryFormat) {
    const std::string header =
        "comment made by hand\nelement vertex 4\nproperty double x\nproperty uchar grey\n"
        "property double y\nproperty float z\nelement face 1\nproperty uchar quality\n"
        "property list uchar int vertex_indices\nend_header\n";
    const std::string ascii = written("quad.ply", "ply\nformat ascii 1.0\n" + header +
                                                      "0 9 0 0\n2 9 0 0\n2 9 1 0.5\n0 9 1 0.5\n"
                                                      "7 4 0 1 2 3\n");
    std::string little = "ply\nformat binary_little_endian 1.0\n" + header;
    std::string big = "ply\nformat binary_big_endian 1.0\n" + header;
    const auto put = [&](auto value) {
        std::array<char, sizeof(value)> bytes;
        std::memcpy(bytes.data(), &value, sizeof(value));
        little.append(bytes.begin(), bytes.end());
        big.append(bytes.rbegin(), bytes.rend());
    };
    for (const auto& [x, y, z] : {std::array{0.0, 0.0, 0.0}, std::array{2.0, 0.0, 0.0},
                                  std::array{2.0, 1.0, 0.5}, std::array{0.0, 1.0, 0.5}}) {
        put(x), put(std::uint8_t{9}), put(y), put(static_cast<float>(z));
    }
    put(std::uint8_t{7}), put(std::uint8_t{4});
    for (std::int32_t i = 0; i < 4; ++i) put(i);
    for (const std::string& path :
         {ascii, written("little.ply", little), written("big.ply", big)}) {
        const TriangleMesh mesh = read_mesh(path, 10.0);
        ASSERT_EQ(mesh.vertices.size(), 4u) << path;
        EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(20.0f, 10.0f, 5.0f)) << path;
        EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}})) << path;
        std::filesystem::remove(path);
    }
}

TEST(MeshReader, SaysWhatIsWrongWithAPly) {
    const std::string vertices =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
    for (const auto& [content, culprit] : std::map<std::string, std::string>{
             {"ply\n", "no PLY header"},
             {"ply\nformat ascii 1.0\nelement vertex many\nend_header\n", "'many'"},
             {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
              "x, y and z"},
             {vertices + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "not there"},
             {vertices + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "vertex index"},
             {vertices + "0 0 0\n1 0 zero\n", "'zero'"},
             {vertices + "0 0 0\n1 0 0\n", "ends before"},
             {vertices + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "not finite"}}) {
        const std::string path = written("wrong.ply", content);
        try {
            read_mesh(path);
            FAIL() << content;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(culprit), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("wrong.ply"), std::string::npos);
        }
        std::filesystem::remove(path);
    }
}

TEST(MeshReader, NamesTheFileThatIsNoMesh) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("beltgrinding-" + std::to_string(::getpid()) + ".stl");
    for (const char* content : {"", "solid", "solid x\nfacet normal 0 0", "\x80\x01garbage"}) {
        std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
        try {
            read_mesh(path.string());
            ADD_FAILURE() << content;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
        }
    }
    std::filesystem::remove(path);
    EXPECT_THROW(read_mesh("absent.stl"), InputError);
}

}  // namespace
}  // namespace beltgrinding

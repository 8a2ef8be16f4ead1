#include "beltgrinding/mesh_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

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
        for (const char byte : bytes) little.push_back(byte);
        for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte) big.push_back(*byte);
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

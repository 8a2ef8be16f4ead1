#include "meshio/mesh_writer.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "beltgrinding/error.h"
#include "beltgrinding/mesh_reader.h"
#include "meshio/mesh_3mf.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

/// What `write` writes; its memory is marked before, so that a byte left out shows.
template <class Write>
std::string written(Write&& write) {
    std::string bytes;
    write([&bytes](std::size_t size) {
        bytes.assign(size, '\xAA');
        return bytes.data();
    });
    return bytes;
}

TEST(DeviationPly, HasTheSizeThatItsHeaderSays) {
    const HeightField field = testing::plate(4.0, 3.0, 1.0, 0.2);
    const std::string ply =
        written([&](const FileMemory& memory) { deviation_ply(field, {}, true, "", memory); });
    const std::size_t body = ply.find("end_header\n") + 11;
    EXPECT_EQ(ply.size() - body, 20 * field.size() + 13 * field.triangles.size());
    EXPECT_NE(ply.find("property float deviation"), std::string::npos);
    float z = 0;
    std::memcpy(&z, ply.data() + body + 8, 4);
    EXPECT_FLOAT_EQ(z, 0.2F);
    const std::string plain =
        written([&](const FileMemory& memory) { mesh_ply(field, false, memory); });
    std::memcpy(&z, plain.data() + plain.find("end_header\n") + 11 + 8, 4);
    EXPECT_FLOAT_EQ(z, 0.0F);
}

TEST(MeshStl, FillsItsHeader) {
    GroundMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const std::string stl = written([&](const FileMemory& memory) { mesh_stl(mesh, memory); });
    ASSERT_EQ(stl.size(), 134U);
    EXPECT_EQ(stl.find('\xAA'), std::string::npos);
    EXPECT_EQ(stl.substr(0, 30), std::string("belt-ground part, millimetres\0", 30));
}

TEST(ThreeMf, LeavesTheProgramsLocaleAsItWas) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    ASSERT_NE(std::setlocale(LC_ALL, "C.UTF-8"), nullptr);
    const std::string ours = std::setlocale(LC_ALL, nullptr);
    const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Triangle faces[] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const std::string path = ::testing::TempDir() + "locale.3mf";
    try {
        const std::string bytes = write_3mf(corners, faces);
        EXPECT_EQ(std::setlocale(LC_ALL, nullptr), ours);
        std::ofstream(path, std::ios::binary) << bytes;
        EXPECT_EQ(read_mesh(path).triangles.size(), 4u);
        EXPECT_EQ(std::setlocale(LC_ALL, nullptr), ours);
        std::ofstream(path, std::ios::binary) << "no 3MF at all";
        EXPECT_THROW(read_mesh(path), InputError);
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "mesh.no_lib3mf");
    }
    EXPECT_EQ(std::setlocale(LC_ALL, nullptr), ours);
    std::filesystem::remove(path);
    std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace beltgrinding

#include "meshio/mesh_writer.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "beltgrinding/error.h"
#include "beltgrinding/mesh_reader.h"
#include "meshio/mesh_3mf.h"
#include "support/synthetic_field.h"
#include "support/unsound_fields.h"

namespace beltgrinding {
namespace {

/// What `write` writes; its memory is marked before, so that a byte left out shows.
template <class Write>
std::string written(Write&& write) {
    std::string bytes;
    std::size_t given = 0;
    write([&](std::size_t size, std::size_t whole) {
        if (given == 0) bytes.assign(whole, '\xAA');
        EXPECT_LE(given + size, whole);
        return bytes.data() + std::exchange(given, given + size);
    });
    EXPECT_EQ(given, bytes.size());
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

/// Bytes of a value, as files have them.
template <class T>
std::string bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

TEST(DeviationPly, IsWhatOneWritesVertexByVertex) {
    HeightField field = testing::cylinder(30.0, 40.0, 50.0, 0.07, 0.0);
    ASSERT_GT(field.size(), 1U << 18U);  // more than one piece
    for (std::size_t i = 0; i < field.size(); ++i) {
        field.height[i] = 1e-3 * std::sin(0.37 * static_cast<double>(i)) * double(i % 300);
        if (i % 17 == 0) field.flags[i] |= kMissed;
    }
    const ColourScale scale{{-0.05, 0.1}, 0.25};
    for (const bool ground : {true, false}) {
        const std::string ply = written(
            [&](const FileMemory& memory) { deviation_ply(field, scale, ground, "a", memory); });
        std::string expected = ply.substr(0, ply.find("end_header\n") + 11);
        EXPECT_NE(expected.find(", run a"), std::string::npos);
        for (std::size_t i = 0; i < field.size(); ++i) {
            const Vec3f at = (ground ? field.top(i) : field.point[i]).cast<float>();
            for (const float part : at) expected += bytes_of(part);
            const bool missed = (field.flags[i] & kMissed) != 0;
            const std::uint32_t c = missed ? scale.missed_colour() : scale.colour(field.height[i]);
            for (const unsigned shift : {24U, 16U, 8U, 0U})
                expected += static_cast<char>(c >> shift & 255U);
            expected += bytes_of(missed ? std::numeric_limits<float>::quiet_NaN()
                                        : static_cast<float>(field.height[i]));
        }
        for (const Triangle& t : field.triangles) {
            expected += '\3';
            for (const std::uint32_t v : t) expected += bytes_of(v);
        }
        EXPECT_TRUE(ply == expected);
    }
}

TEST(MeshPly, OfNothingIsAHeader) {
    const HeightField empty;
    for (const bool coloured : {true, false}) {
        const std::string ply = written([&](const FileMemory& memory) {
            if (coloured)
                deviation_ply(empty, {}, true, "", memory);
            else
                mesh_ply(empty, true, memory);
        });
        EXPECT_NE(ply.find("element vertex 0\n"), std::string::npos);
        EXPECT_EQ(ply.find("end_header\n") + 11, ply.size());
    }
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

TEST(MeshWriter, AnUnsoundFieldIsRefused) {
    const HeightField plate = testing::plate(4.0, 3.0, 1.0, 0.2);
    testing::expect_unsound_refused(plate, [](HeightField& f) {
        written([&](const FileMemory& memory) { deviation_ply(f, {}, true, "", memory); });
    });
    testing::expect_unsound_refused(plate, [](HeightField& f) {
        written([&](const FileMemory& memory) { mesh_ply(f, true, memory); });
    });
}

}  // namespace
}  // namespace beltgrinding

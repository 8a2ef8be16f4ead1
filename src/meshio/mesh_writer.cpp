#include "meshio/mesh_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

static_assert(std::endian::native == std::endian::little, "STL and PLY are written little-endian");

constexpr std::size_t kOfTask = 1U << 15U;  // vertices or triangles
constexpr std::size_t kStlHeader = 80, kStlTriangle = 50;
constexpr std::size_t kPlyPlain = 12, kPlyColoured = 20, kPlyFace = 13;  // bytes

template <class T>
void put(char*& out, const T& value) {
    std::memcpy(out, &value, sizeof(T));
    out += sizeof(T);
}

void put(char*& out, const Vec3f& value) {
    for (const float v : value) put(out, v);
}

Vec3f place(const HeightField& field, std::size_t i, bool ground) {
    return (ground ? field.top(i) : field.point[i]).cast<float>();
}

/// A binary PLY of `vertex(i)`; unless `colours` is null also of these and `deviation(i)`.
template <class Vertex, class Deviation>
void ply(const char* title, std::size_t vertices, Vertex vertex,
         const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>* colours,
         Deviation deviation, const FileMemory& memory) {
    const bool coloured = colours != nullptr;
    const std::string head =
        std::string("ply\nformat binary_little_endian 1.0\ncomment ") + title +
        ", millimetres\nelement vertex " + std::to_string(vertices) +
        "\nproperty float x\nproperty float y\nproperty float z\n" +
        (coloured ? "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    "property uchar alpha\nproperty float deviation\n"
                  : "") +
        "element face " + std::to_string(triangles.size()) +
        "\nproperty list uchar int vertex_indices\nend_header\n";
    const std::size_t size = coloured ? kPlyColoured : kPlyPlain;
    char* const first = memory(head.size() + size * vertices + kPlyFace * triangles.size());
    std::copy(head.begin(), head.end(), first);
    char* const points = first + head.size();
    parallel_blocks(vertices, kOfTask, {}, [&](std::size_t begin, std::size_t end) {
        char* out = points + size * begin;
        for (std::size_t v = begin; v < end; ++v) {
            put(out, vertex(v));
            if (!coloured) continue;
            for (const unsigned shift : {24U, 16U, 8U, 0U})
                put(out, static_cast<std::uint8_t>((*colours)[v] >> shift & 255U));
            put(out, deviation(v));
        }
    });
    char* const faces = points + size * vertices;
    parallel_blocks(triangles.size(), kOfTask, {}, [&](std::size_t begin, std::size_t end) {
        char* out = faces + kPlyFace * begin;
        for (std::size_t t = begin; t < end; ++t) {
            put(out, std::uint8_t{3});
            for (const std::uint32_t v : triangles[t]) put(out, v);
        }
    });
}

}  // namespace

void mesh_stl(const GroundMesh& mesh, const FileMemory& memory) {
    char* out = memory(kStlHeader + 4 + kStlTriangle * mesh.triangles.size());
    std::memset(out, 0, kStlHeader);
    constexpr char kTitle[] = "belt-ground part, millimetres";  // must not begin with "solid"
    std::memcpy(out, kTitle, sizeof kTitle);
    out += kStlHeader;
    put(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        put(out, (b - a).cross(c - a).normalized().cast<float>().eval());
        for (const Vec3* p : {&a, &b, &c}) put(out, p->cast<float>().eval());
        put(out, std::uint16_t{0});
    }
}

void mesh_ply(const GroundMesh& mesh, const ColourScale* scale, const FileMemory& memory) {
    const auto vertex = [&](std::size_t v) { return mesh.vertices[v].cast<float>().eval(); };
    const auto deviation = [&](std::size_t v) { return mesh.deviation[v]; };
    std::vector<std::uint32_t> colours;
    if (scale) colours = mesh_colours(mesh, *scale);
    ply("belt-ground part", mesh.vertices.size(), vertex, mesh.triangles,
        scale ? &colours : nullptr, deviation, memory);
}

void deviation_ply(const HeightField& field, const ColourScale& scale, bool ground,
                   const std::string& run, const FileMemory& memory) {
    const auto vertex = [&](std::size_t i) { return place(field, i, ground); };
    const auto deviation = [&](std::size_t i) {
        return (field.flags[i] & kMissed) != 0 ? std::numeric_limits<float>::quiet_NaN()
                                               : static_cast<float>(field.height[i]);
    };
    const std::vector<std::uint32_t> colours = deviation_colours(field, scale);
    const std::string title = "belt-grinding deviation" + (run.empty() ? "" : ", run " + run);
    ply(title.c_str(), field.size(), vertex, field.triangles, &colours, deviation, memory);
}

void mesh_ply(const HeightField& field, bool ground, const FileMemory& memory) {
    const auto vertex = [&](std::size_t i) { return place(field, i, ground); };
    ply(
        "belt-grinding deviation", field.size(), vertex, field.triangles, nullptr,
        [](std::size_t) { return 0.0F; }, memory);
}

}  // namespace beltgrinding

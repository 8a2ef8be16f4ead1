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

constexpr std::size_t kOfTask = 1U << 15U;   // vertices or triangles
constexpr std::size_t kOfPiece = 1U << 18U;  // the same: tasks for several threads
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

/// Hands out memory for `count` records of `size` bytes, a piece at a time, and has each filled by
/// `put_record(place, index)`.
template <class PutRecord>
void in_pieces(std::size_t count, std::size_t size, std::size_t whole, const FileMemory& memory,
               PutRecord put_record) {
    for (std::size_t first = 0; first < count; first += kOfPiece) {
        const std::size_t some = std::min(kOfPiece, count - first);
        char* const piece = memory(size * some, whole);
        parallel_blocks(some, kOfTask, {}, [&](std::size_t begin, std::size_t end) {
            char* out = piece + size * begin;
            for (std::size_t k = begin; k < end; ++k) put_record(out, first + k);
        });
    }
}

/// A binary PLY of `vertex(i)`; `coloured`: also of `colour(i)` and `deviation(i)`.
template <class Vertex, class Triangles, class Colour, class Deviation>
void ply(const char* title, std::size_t vertices, Vertex vertex, const Triangles& triangles,
         bool coloured, Colour colour, Deviation deviation, const FileMemory& memory) {
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
    const std::size_t whole = head.size() + size * vertices + kPlyFace * triangles.size();
    std::copy(head.begin(), head.end(), memory(head.size(), whole));
    in_pieces(vertices, size, whole, memory, [&](char*& out, std::size_t v) {
        put(out, vertex(v));
        if (!coloured) return;
        const std::uint32_t packed = colour(v);
        for (const unsigned shift : {24U, 16U, 8U, 0U})
            put(out, static_cast<std::uint8_t>(packed >> shift & 255U));
        put(out, deviation(v));
    });
    in_pieces(triangles.size(), kPlyFace, whole, memory, [&](char*& out, std::size_t t) {
        put(out, std::uint8_t{3});
        for (const std::uint32_t v : triangles[t]) put(out, v);
    });
}

}  // namespace

void mesh_stl(const GroundMesh& mesh, const FileMemory& memory) {
    const std::size_t size = kStlHeader + 4 + kStlTriangle * mesh.triangles.size();
    char* out = memory(size, size);
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
    const auto colour = [&](std::size_t v) { return colours[v]; };
    ply("belt-ground part", mesh.vertices.size(), vertex, mesh.triangles, scale != nullptr, colour,
        deviation, memory);
}

void deviation_ply(const HeightField& field, const ColourScale& scale, bool ground,
                   const std::string& run, const FileMemory& memory) {
    field.validate();
    scale.validate();
    const auto vertex = [&](std::size_t i) { return place(field, i, ground); };
    const auto missed = [&](std::size_t i) { return (field.flags[i] & kMissed) != 0; };
    const auto colour = [&](std::size_t i) {
        return missed(i) ? scale.missed_colour() : scale.colour(field.height[i]);
    };
    const auto deviation = [&](std::size_t i) {
        return missed(i) ? std::numeric_limits<float>::quiet_NaN()
                         : static_cast<float>(field.height[i]);
    };
    const std::string title = "belt-grinding deviation" + (run.empty() ? "" : ", run " + run);
    ply(title.c_str(), field.size(), vertex, field.triangles, true, colour, deviation, memory);
}

void mesh_ply(const HeightField& field, bool ground, const FileMemory& memory) {
    field.validate();
    const auto vertex = [&](std::size_t i) { return place(field, i, ground); };
    const auto none = [](std::size_t) { return 0U; };
    const auto nothing = [](std::size_t) { return 0.0F; };
    ply("belt-grinding deviation", field.size(), vertex, field.triangles, false, none, nothing,
        memory);
}

}  // namespace beltgrinding

#include <bit>
#include <cstring>
#include <limits>
#include <string>

#include "beltgrinding/deviation.h"

namespace beltgrinding {
namespace {

static_assert(std::endian::native == std::endian::little, "the PLY is written little-endian");

template <class T>
void put(char*& out, const T& value) {
    std::memcpy(out, &value, sizeof(T));
    out += sizeof(T);
}

Vec3f vertex(const HeightField& field, std::size_t i, bool ground) {
    return (ground ? field.top(i) : field.point[i]).cast<float>();
}

std::string header(const HeightField& field, const char* vertex_properties) {
    return "ply\nformat binary_little_endian 1.0\ncomment belt-grinding deviation, millimetres\n"
           "element vertex " +
           std::to_string(field.size()) +
           "\nproperty float x\nproperty float y\nproperty float z\n" + vertex_properties +
           "element face " + std::to_string(field.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

void put_triangles(char*& out, const HeightField& field) {
    for (const Triangle& t : field.triangles) {
        put(out, std::uint8_t{3});
        for (const std::uint32_t v : t) put(out, v);
    }
}

constexpr std::size_t kFaceBytes = 13;

}  // namespace

std::string deviation_ply(const HeightField& field, const ColourScale& scale, bool ground) {
    const std::string head =
        header(field,
               "property uchar red\nproperty uchar green\nproperty uchar blue\n"
               "property uchar alpha\nproperty float deviation\n");
    const std::vector<std::uint32_t> colours = deviation_colours(field, scale);
    std::string text(head.size() + 20 * field.size() + kFaceBytes * field.triangles.size(), '\0');
    char* out = text.data();
    std::memcpy(out, head.data(), head.size());
    out += head.size();
    for (std::size_t i = 0; i < field.size(); ++i) {
        put(out, vertex(field, i, ground));
        for (const unsigned shift : {24U, 16U, 8U, 0U}) {
            put(out, static_cast<std::uint8_t>(colours[i] >> shift & 255U));
        }
        const bool missed = (field.flags[i] & kMissed) != 0;
        put(out,
            missed ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(field.height[i]));
    }
    put_triangles(out, field);
    return text;
}

std::string mesh_ply(const HeightField& field, bool ground) {
    const std::string head = header(field, "");
    std::string text(head.size() + 12 * field.size() + kFaceBytes * field.triangles.size(), '\0');
    char* out = text.data();
    std::memcpy(out, head.data(), head.size());
    out += head.size();
    for (std::size_t i = 0; i < field.size(); ++i) put(out, vertex(field, i, ground));
    put_triangles(out, field);
    return text;
}

}  // namespace beltgrinding

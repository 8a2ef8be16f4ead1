#include <bit>
#include <cmath>
#include <cstring>

#include "inspection/ground_mesh.h"

namespace beltgrinding {
namespace {

static_assert(std::endian::native == std::endian::little, "STL and PLY are written little-endian");

constexpr std::uint32_t kDesignColour = 0xB9BDC4FF;
constexpr std::size_t kStlHeader = 80, kStlTriangle = 50;

template <class T>
void put(char*& out, const T& value) {
    std::memcpy(out, &value, sizeof(T));
    out += sizeof(T);
}

}  // namespace

std::vector<std::uint32_t> mesh_colours(const GroundMesh& mesh, const ColourScale& scale) {
    std::vector<std::uint32_t> colours(mesh.vertices.size(), kDesignColour);
    for (std::size_t v = 0; v < colours.size(); ++v) {
        if (mesh.standing[v] == MeshVertex::kMissed) colours[v] = scale.missed_colour();
        if (mesh.standing[v] == MeshVertex::kGround) colours[v] = scale.colour(mesh.deviation[v]);
    }
    return colours;
}

std::string mesh_stl(const GroundMesh& mesh) {
    std::string text(kStlHeader + 4 + kStlTriangle * mesh.triangles.size(), '\0');
    constexpr char kTitle[] = "belt-ground part, millimetres";  // must not begin with "solid"
    std::memcpy(text.data(), kTitle, sizeof kTitle);
    char* out = text.data() + kStlHeader;
    put(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        put(out, (b - a).cross(c - a).normalized().cast<float>().eval());
        for (const Vec3* p : {&a, &b, &c}) put(out, p->cast<float>().eval());
        put(out, std::uint16_t{0});
    }
    return text;
}

std::string mesh_ply(const GroundMesh& mesh, const ColourScale* scale) {
    const std::string head =
        "ply\nformat binary_little_endian 1.0\ncomment belt-ground part, millimetres\n"
        "element vertex " +
        std::to_string(mesh.vertices.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\n" +
        (scale ? "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                 "property uchar alpha\nproperty float deviation\n"
               : "") +
        "element face " + std::to_string(mesh.triangles.size()) +
        "\nproperty list uchar int vertex_indices\nend_header\n";
    const std::vector<std::uint32_t> colours =
        scale ? mesh_colours(mesh, *scale) : std::vector<std::uint32_t>();
    std::string text(
        head.size() + (scale ? 20 : 12) * mesh.vertices.size() + 13 * mesh.triangles.size(), '\0');
    std::memcpy(text.data(), head.data(), head.size());
    char* out = text.data() + head.size();
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        put(out, mesh.vertices[v].cast<float>().eval());
        if (!scale) continue;
        for (const unsigned shift : {24U, 16U, 8U, 0U})
            put(out, static_cast<std::uint8_t>(colours[v] >> shift & 255U));
        put(out, mesh.deviation[v]);
    }
    for (const Triangle& t : mesh.triangles) {
        put(out, std::uint8_t{3});
        for (const std::uint32_t v : t) put(out, v);
    }
    return text;
}

}  // namespace beltgrinding

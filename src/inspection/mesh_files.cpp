#include <algorithm>
#include <bit>
#include <charconv>
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

void put_text(std::string& text, const char* words) {
    text += words;
}

/// The shortest decimal text that reads back as the same number.
void put_number(std::string& text, double value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, static_cast<float>(value),
                                   std::chars_format::fixed);
    text.append(digits, end.ptr);
}

void put_number(std::string& text, std::uint32_t value) {
    char digits[16];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void put_colour(std::string& text, std::uint32_t packed) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    text += '#';
    for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[packed >> shift & 15U];
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

std::string mesh_3mf_model(const GroundMesh& mesh, const ColourScale* scale) {
    std::string text;
    text.reserve(64 * mesh.vertices.size() + 64 * mesh.triangles.size());
    put_text(
        text,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" "
        "xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
        "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n"
        "<resources>\n");
    std::vector<std::uint32_t> palette, index;
    if (scale) {
        const std::vector<std::uint32_t> colours = mesh_colours(mesh, *scale);
        palette = colours;
        std::sort(palette.begin(), palette.end());
        palette.erase(std::unique(palette.begin(), palette.end()), palette.end());
        for (const std::uint32_t c : colours)
            index.push_back(static_cast<std::uint32_t>(
                std::lower_bound(palette.begin(), palette.end(), c) - palette.begin()));
        put_text(text, "<m:colorgroup id=\"1\">\n");
        for (const std::uint32_t c : palette) {
            put_text(text, "<m:color color=\"");
            put_colour(text, c);
            put_text(text, "\"/>\n");
        }
        put_text(text, "</m:colorgroup>\n");
    }
    put_text(text, "<object id=\"2\" type=\"model\"");
    if (scale) put_text(text, " pid=\"1\" pindex=\"0\"");
    put_text(text, ">\n<mesh>\n<vertices>\n");
    for (const Vec3& v : mesh.vertices) {
        put_text(text, "<vertex x=\"");
        put_number(text, v.x());
        put_text(text, "\" y=\"");
        put_number(text, v.y());
        put_text(text, "\" z=\"");
        put_number(text, v.z());
        put_text(text, "\"/>\n");
    }
    put_text(text, "</vertices>\n<triangles>\n");
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            put_text(text, k == 0 ? "<triangle v1=\"" : k == 1 ? "\" v2=\"" : "\" v3=\"");
            put_number(text, t[k]);
        }
        if (scale) {
            put_text(text, "\" pid=\"1");
            for (std::size_t k = 0; k < 3; ++k) {
                put_text(text, k == 0 ? "\" p1=\"" : k == 1 ? "\" p2=\"" : "\" p3=\"");
                put_number(text, index[t[k]]);
            }
        }
        put_text(text, "\"/>\n");
    }
    put_text(text,
             "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"2\"/>\n"
             "</build>\n</model>\n");
    return text;
}

}  // namespace beltgrinding

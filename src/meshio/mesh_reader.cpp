#include "beltgrinding/mesh_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "beltgrinding/error.h"
#include "foreign/file_check.h"
#include "foreign/reader.h"
#include "mesh/sense.h"
#include "meshio/mesh_bytes.h"

namespace beltgrinding {
namespace {

bool is_ply(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    char magic[3] = {};
    return file.read(magic, 3) && std::string_view(magic, 3) == "ply";
}

/// "STL" of "part.stl"; "mesh" where there is no suffix.
std::string format_of(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    if (suffix.size() < 2) return "mesh";
    suffix.erase(0, 1);
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return suffix;
}

/// By the reader's process: assimp ends it on some damaged files, lib3mf unpacks without end.
RawMesh read_foreign(const std::string& path, const RunContext& context) {
    const std::string format = format_of(path);
    const bool three_mf = format == "3MF";
    std::optional<MeshBytes> mesh;
    try {
        mesh = unpack_mesh(ask_reader({three_mf ? "3MF" : "MESH", path, ""}, context));
    } catch (const ReaderFault& fault) {
        try {
            refuse_file(fault, format, three_mf ? "lib3mf" : "assimp");
        } catch (const InputError& error) {
            throw error.within({"cad.file", "{file}: ", {{"file", path}}});
        }
    }
    if (!mesh)
        throw InputError(
            "mesh.not_a_mesh",
            "{file}: what was read of it is no mesh: a triangle names a vertex that is "
            "not there; export it again",
            {{"file", path}});
    RawMesh raw;
    raw.triangles = std::move(mesh->triangles);
    raw.unit = mesh->unit;
    raw.vertices.reserve(mesh->vertices.size());
    for (const Vec3f& v : mesh->vertices) raw.vertices.push_back(v.cast<double>());
    raw.turned = turn_outward(raw.vertices, raw.triangles);
    return raw;
}

constexpr double kLargest = 10e3, kSmallest = 0.1;  // mm: what is beyond has another unit

std::vector<Fact> odd_things(const std::string& path, const RawMesh& raw, double scale) {
    std::vector<Fact> found;
    if (raw.turned > 0)
        found.push_back({"mesh.turned",
                         "{file}: {count} closed pieces of the mesh are inside out; they are "
                         "turned",
                         {{"file", path}, {"count", raw.turned}}});
    Box box;
    for (const Vec3& v : raw.vertices) box.extend(v);
    const double size = scale * box.sizes().maxCoeff();
    if (size > kLargest || size < kSmallest)
        found.push_back({"mesh.size",
                         "{file}: the mesh is {size:.4g} mm large; check its unit",
                         {{"file", path}, {"size", size}}});
    return found;
}

}  // namespace

TriangleMesh read_mesh(const std::string& path, double unit_mm, const Frame& work_from_mesh,
                       const RunContext& context, MeshReport* report) {
    if (!std::isfinite(unit_mm) || unit_mm <= 0.0) {
        throw InputError("mesh.unit",
                         "{file}: the unit of the mesh must be a positive number of millimetres",
                         {{"file", path}});
    }
    if (!is_readable_file(path))
        throw InputError("mesh.no_such_file", "{file}: there is no such file", {{"file", path}});
    const bool ply = format_of(path) == "PLY" || is_ply(path);
    RawMesh raw = ply ? read_ply(path) : read_foreign(path, context);
    if (raw.triangles.empty())
        throw InputError("mesh.no_triangle", "{file}: the mesh has no triangle", {{"file", path}});
    const double scale = unit_mm == 1.0 && raw.unit > 0.0 ? raw.unit : unit_mm;
    if (report != nullptr) *report = {scale, odd_things(path, raw, scale)};
    TriangleMesh mesh;
    mesh.triangles = std::move(raw.triangles);
    mesh.vertices.reserve(raw.vertices.size());
    for (const Vec3& vertex : raw.vertices) {
        const auto moved = Vec3(work_from_mesh * Vec3(scale * vertex)).cast<float>().eval();
        if (!moved.allFinite()) {
            throw InputError("mesh.vertex_not_finite", "{file}: vertex {vertex} is not finite",
                             {{"file", path}, {"vertex", mesh.vertices.size()}});
        }
        mesh.vertices.push_back(moved);
    }
    return mesh;
}

}  // namespace beltgrinding

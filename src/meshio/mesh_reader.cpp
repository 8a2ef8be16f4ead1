#include "beltgrinding/mesh_reader.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "beltgrinding/error.h"
#include "meshio/mesh_3mf.h"

namespace beltgrinding {
namespace {

RawMesh read_by_assimp(const std::string& path) {
    Assimp::Importer importer;
    const aiScene* scene = nullptr;
    try {
        importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                    aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        // JoinIdenticalVertices compares all attributes: without normals and colours it welds.
        importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                                    aiComponent_NORMALS | aiComponent_COLORS |
                                        aiComponent_TEXCOORDS |
                                        aiComponent_TANGENTS_AND_BITANGENTS);
        scene = importer.ReadFile(
            path, aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_SortByPType |
                      aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices);
    } catch (const std::exception& error) {
        throw InputError("mesh.not_readable", "{file}: cannot be read as a mesh: {reason}",
                         {{"file", path}, {"reason", error.what()}});
    }
    if (scene == nullptr) {
        throw InputError("mesh.not_readable", "{file}: cannot be read as a mesh: {reason}",
                         {{"file", path}, {"reason", importer.GetErrorString()}});
    }
    RawMesh mesh;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& part = *scene->mMeshes[m];
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            mesh.vertices.emplace_back(part.mVertices[v].x, part.mVertices[v].y,
                                       part.mVertices[v].z);
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) continue;
            Triangle t{};
            for (unsigned k = 0; k < 3; ++k) {
                if (face.mIndices[k] >= part.mNumVertices) {
                    throw InputError("mesh.triangle_without_vertex",
                                     "{file}: triangle {triangle} names a vertex that is not there",
                                     {{"file", path}, {"triangle", f}});
                }
                t[k] = base + face.mIndices[k];
            }
            mesh.triangles.push_back(t);
        }
    }
    return mesh;
}

bool is_ply(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    char magic[3] = {};
    return file.read(magic, 3) && std::string_view(magic, 3) == "ply";
}

bool is_3mf(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return suffix == ".3mf";
}

/// By lib3mf, which says what is wrong with a damaged package; assimp ends the process.
RawMesh read_3mf_file(const std::string& path) {
    std::optional<RawMesh> mesh = read_3mf(path);
    return mesh ? std::move(*mesh) : read_by_assimp(path);
}

}  // namespace

TriangleMesh read_mesh(const std::string& path, double unit_mm, const Frame& work_from_mesh) {
    if (!std::isfinite(unit_mm) || unit_mm <= 0.0) {
        throw InputError("mesh.unit",
                         "{file}: the unit of the mesh must be a positive number of millimetres",
                         {{"file", path}});
    }
    if (!std::filesystem::is_regular_file(path))
        throw InputError("mesh.no_such_file", "{file}: there is no such file", {{"file", path}});
    const bool ply = std::filesystem::path(path).extension() == ".ply" || is_ply(path);
    RawMesh raw = ply ? read_ply(path) : is_3mf(path) ? read_3mf_file(path) : read_by_assimp(path);
    if (raw.triangles.empty())
        throw InputError("mesh.no_triangle", "{file}: the mesh has no triangle", {{"file", path}});
    TriangleMesh mesh;
    mesh.triangles = std::move(raw.triangles);
    mesh.vertices.reserve(raw.vertices.size());
    for (const Vec3& vertex : raw.vertices) {
        const auto moved = Vec3(work_from_mesh * Vec3(unit_mm * vertex)).cast<float>().eval();
        if (!moved.allFinite()) {
            throw InputError("mesh.vertex_not_finite", "{file}: vertex {vertex} is not finite",
                             {{"file", path}, {"vertex", mesh.vertices.size()}});
        }
        mesh.vertices.push_back(moved);
    }
    return mesh;
}

}  // namespace beltgrinding

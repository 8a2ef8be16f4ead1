#include "tasks.h"

#ifndef BELTGRINDING_READS_MESHES

namespace beltgrinding {

std::optional<std::string> do_mesh_task(std::string_view, const std::string&, const std::string&) {
    return std::nullopt;
}

}  // namespace beltgrinding

#else

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <utility>

#include "beltgrinding/error.h"
#include "meshio/mesh_bytes.h"
#include "three_mf.h"

namespace beltgrinding {
namespace {

MeshBytes read_by_assimp(const std::string& path) {
    auto* importer = new Assimp::Importer;  // never destroyed: of a damaged file that could fail
    const aiScene* scene = nullptr;
    std::string reason;
    try {
        importer->SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                     aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        // JoinIdenticalVertices compares all attributes: without normals and colours it welds.
        importer->SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                                     aiComponent_NORMALS | aiComponent_COLORS |
                                         aiComponent_TEXCOORDS |
                                         aiComponent_TANGENTS_AND_BITANGENTS);
        // A robot's meshes (DAE) are used as they lie, whichever axis their file calls up, as RViz
        // does.
        importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
        scene = importer->ReadFile(
            path, aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_SortByPType |
                      aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices);
        reason = importer->GetErrorString();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        reason = error.what();
    }
    if (scene == nullptr) {
        throw InputError("mesh.not_readable", "{file}: cannot be read as a mesh: {reason}",
                         {{"file", path}, {"reason", reason}});
    }
    MeshBytes mesh;
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

/// By lib3mf, which says what is wrong with a damaged package, where it is there.
MeshBytes read_3mf_file(const std::string& path) {
    std::optional<MeshBytes> mesh = read_3mf(path);
    return mesh ? std::move(*mesh) : read_by_assimp(path);
}

}  // namespace

std::optional<std::string> do_mesh_task(std::string_view task, const std::string& path,
                                        const std::string& input) {
    if (task == "MESH") return pack_mesh(read_by_assimp(path));
    if (task == "3MF") return pack_mesh(read_3mf_file(path));
    if (task == "WRITE-3MF") {
        const std::optional<MeshBytes> mesh = unpack_mesh(input);
        if (!mesh)
            throw InputError("mesh.three_mf_no_mesh",
                             "the 3MF file cannot be made: a triangle names a vertex that is not "
                             "there");
        return write_3mf_file(*mesh);
    }
    return std::nullopt;
}

}  // namespace beltgrinding

#endif

#include "meshio/mesh_bytes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "foreign/answer.h"

namespace beltgrinding {
namespace {

template <class T>
void put_all(std::string& bytes, const std::vector<T>& values) {
    put_bytes(bytes, std::uint64_t(values.size()));
    bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
}

template <class T>
bool take_all(std::string_view& bytes, std::vector<T>& values) {
    std::uint64_t count = 0;
    if (!take_bytes(bytes, count) || count > bytes.size() / sizeof(T)) return false;
    const std::size_t size = sizeof(T) * static_cast<std::size_t>(count);
    values.resize(static_cast<std::size_t>(count));
    if (size > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), size);
    bytes.remove_prefix(size);
    return true;
}

}  // namespace

std::string pack_mesh(const MeshBytes& mesh) {
    std::string bytes;
    put_all(bytes, mesh.vertices);
    put_all(bytes, mesh.triangles);
    put_all(bytes, mesh.colours);
    put_bytes(bytes, mesh.unit);
    return bytes;
}

std::optional<MeshBytes> unpack_mesh(std::string_view bytes) {
    MeshBytes mesh;
    if (!take_all(bytes, mesh.vertices) || !take_all(bytes, mesh.triangles) ||
        !take_all(bytes, mesh.colours) || !take_bytes(bytes, mesh.unit) || !bytes.empty())
        return std::nullopt;
    if (!(mesh.unit >= 0.0 && std::isfinite(mesh.unit))) return std::nullopt;
    if (!mesh.colours.empty() && mesh.colours.size() != mesh.vertices.size()) return std::nullopt;
    for (const Triangle& t : mesh.triangles)
        if (std::max({t[0], t[1], t[2]}) >= mesh.vertices.size()) return std::nullopt;
    return mesh;
}

}  // namespace beltgrinding

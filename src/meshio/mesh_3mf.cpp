#include "meshio/mesh_3mf.h"

#include "beltgrinding/error.h"
#include "foreign/reader.h"
#include "meshio/mesh_bytes.h"

namespace beltgrinding {
namespace {

[[noreturn]] void refuse(const ReaderFault& fault) {
    switch (fault.kind) {
        case ReaderFault::Kind::kTime:
            throw InputError("mesh.three_mf_timeout",
                             "making the 3MF file took more than {limit:.3g} s and was given up; "
                             "write STL or PLY, or set {variable} higher",
                             {{"limit", fault.limit}, {"variable", fault.variable}});
        case ReaderFault::Kind::kSignal:
            throw InputError("mesh.three_mf_crash",
                             "the 3MF file cannot be made: lib3mf ended with {signal}; write STL "
                             "or PLY",
                             {{"signal", fault.signal}});
        default:
            throw InputError("mesh.three_mf_memory",
                             "making the 3MF file needs more memory than the {limit:.0f} MB "
                             "allowed; write STL or PLY, or set {variable} higher",
                             {{"limit", fault.limit}, {"variable", fault.variable}});
    }
}

}  // namespace

std::string write_3mf(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                      std::span<const std::uint32_t> colours) {
    MeshBytes mesh;
    mesh.vertices.reserve(vertices.size());
    for (const Vec3& vertex : vertices) {
        if (!vertex.allFinite())
            throw InputError("mesh.not_finite",
                             "the file cannot be made: vertex {vertex} of the mesh is not finite",
                             {{"vertex", mesh.vertices.size()}});
        mesh.vertices.push_back(vertex.cast<float>());
    }
    mesh.triangles.assign(triangles.begin(), triangles.end());
    mesh.colours.assign(colours.begin(), colours.end());
    try {
        return ask_reader({"WRITE-3MF", "", pack_mesh(mesh)}, RunContext());
    } catch (const ReaderFault& fault) {
        refuse(fault);
    }
}

}  // namespace beltgrinding

#include "shape_answer.h"

#include <BRepBuilderAPI_Copy.hxx>
#include <Standard_Failure.hxx>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "beltgrinding/error.h"
#include "foreign/answer.h"
#include "foreign/reader.h"
#include "shape_impl.h"
#include "shape_transfer.h"

namespace beltgrinding {
namespace {

struct TriedHead {
    std::array<double, 6> extents{};  ///< mm, least then greatest x, y, z
    std::uint64_t faces = 0, solids = 0;
    std::uint32_t valid = 0;
    std::uint32_t meshed = 0;  ///< 0: no extents
};

template <class T>
void put_all(std::string& bytes, const std::vector<T>& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
}

/// `count` values off the front; false where there are fewer.
template <class T>
bool take_all(std::string_view& bytes, std::uint64_t count, std::vector<T>& values) {
    if (count > bytes.size() / sizeof(T)) return false;
    const auto size = static_cast<std::size_t>(count);
    values.resize(size);
    if (size > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), sizeof(T) * size);
    bytes.remove_prefix(sizeof(T) * size);
    return true;
}

[[noreturn]] void refuse_meshing(const ReaderFault& fault, double deflection) {
    switch (fault.kind) {
        case ReaderFault::Kind::kTime:
            throw InputError(
                "brep.meshing_timeout",
                "triangulating it to {deflection:.3g} mm took more than {limit:.3g} s "
                "and was given up: the shape is damaged, or very large; repair or "
                "simplify it, or set {variable} higher",
                {{"deflection", deflection}, {"limit", fault.limit}, {"variable", fault.variable}});
        case ReaderFault::Kind::kMemory:
        case ReaderFault::Kind::kSize:
            throw InputError(
                "brep.meshing_memory",
                "triangulating it to {deflection:.3g} mm needs more memory than the "
                "{limit:.0f} MB allowed: the shape is damaged, or very large; repair "
                "or simplify it, or set {variable} higher",
                {{"deflection", deflection}, {"limit", fault.limit}, {"variable", fault.variable}});
        default:
            throw InputError("brep.meshing_crash",
                             "it cannot be triangulated: OpenCASCADE ended with {signal}; repair "
                             "the shape",
                             {{"signal", fault.signal}});
    }
}

[[noreturn]] void refuse_faces(const ReaderFault& fault) {
    switch (fault.kind) {
        case ReaderFault::Kind::kTime:
            throw InputError("brep.faces_timeout",
                             "making faces of the mesh took more than {limit:.3g} s and was given "
                             "up; take a coarser mesh, or set {variable} higher",
                             {{"limit", fault.limit}, {"variable", fault.variable}});
        case ReaderFault::Kind::kMemory:
        case ReaderFault::Kind::kSize:
            throw InputError("brep.faces_memory",
                             "making faces of the mesh needs more memory than the {limit:.0f} MB "
                             "allowed; take a coarser mesh, or set {variable} higher",
                             {{"limit", fault.limit}, {"variable", fault.variable}});
        default:
            throw InputError("brep.faces_crash",
                             "the mesh cannot be made into faces: OpenCASCADE ended with {signal}; "
                             "repair the mesh",
                             {{"signal", fault.signal}});
    }
}

}  // namespace

std::string pack_tried(const std::optional<TriedShape>& tried) {
    TriedHead head;
    if (tried) {
        head.faces = tried->areas.size();
        head.solids = tried->signs.size();
        head.valid = tried->valid;
        head.meshed = tried->extents.has_value();
        if (tried->extents) {
            const Vec3 least = tried->extents->min(), most = tried->extents->max();
            head.extents = {least.x(), least.y(), least.z(), most.x(), most.y(), most.z()};
        }
    }
    std::string bytes;
    put_bytes(bytes, head);
    if (tried) {
        put_all(bytes, tried->areas);
        put_all(bytes, tried->signs);
    }
    return bytes;
}

std::optional<TriedShape> unpack_tried(std::string_view& bytes) {
    TriedHead head;
    if (!take_bytes(bytes, head)) throw Standard_Failure("no facts");
    if (head.faces == 0) return std::nullopt;
    TriedShape tried;
    tried.valid = head.valid != 0;
    const auto& e = head.extents;
    for (const double x : e)
        if (!std::isfinite(x)) throw Standard_Failure("extents that are no numbers");
    if (head.meshed != 0) tried.extents = Box(Vec3(e[0], e[1], e[2]), Vec3(e[3], e[4], e[5]));
    if (!take_all(bytes, head.faces, tried.areas) || !take_all(bytes, head.solids, tried.signs))
        throw Standard_Failure("half of the facts");
    return tried;
}

std::string pack_triangles(const TriangleMesh& mesh) {
    std::string bytes;
    put_bytes(bytes, std::uint64_t(mesh.vertices.size()));
    put_all(bytes, mesh.vertices);
    put_all(bytes, mesh.triangles);
    return bytes;
}

std::optional<TriangleMesh> unpack_triangles(std::string_view bytes) {
    std::uint64_t vertices = 0;
    TriangleMesh mesh;
    if (!take_bytes(bytes, vertices) || !take_all(bytes, vertices, mesh.vertices) ||
        bytes.size() % sizeof(Triangle) != 0 ||
        !take_all(bytes, bytes.size() / sizeof(Triangle), mesh.triangles))
        return std::nullopt;
    return mesh;
}

Shape unpack_shape_answer(std::string_view bytes, const std::string& name) {
    std::optional<TriedShape> tried = unpack_tried(bytes);
    Shape shape = make_shape(unpack_shape(bytes), name, MissingCurves::kAreDone);
    if (!tried) return shape;
    const Shape::Impl& impl = shape.impl();  // nobody else has it yet
    if (tried->areas.size() != shape.face_count() || tried->signs.size() != impl.solids.size())
        throw Standard_Failure("facts of another shape");
    impl.foreign = true;
    impl.valid = tried->valid;
    if (tried->extents) impl.extents = std::make_unique<Box>(*tried->extents);
    for (std::size_t face = 0; face < tried->areas.size(); ++face)
        if (tried->areas[face] != kNoArea) impl.areas[face] = tried->areas[face];
    impl.solid_sign = std::move(tried->signs);
    return shape;
}

TopoDS_Shape mesh_in_reader(const TopoDS_Shape& shape, const MeshingParameters& parameters,
                            const std::string& name, bool foreign, const RunContext& context) {
    ReaderRequest request;
    request.task = "TRIANGULATE";
    put_bytes(request.input, parameters);
    // Without the triangles that it may carry, which the copy there leaves out as well.
    request.input += pack_shape(BRepBuilderAPI_Copy(shape, false, false).Shape());
    try {
        return unpack_shape(ask_reader(request, context));
    } catch (const InputError& error) {
        if (foreign || !is_without_reader(error)) throw;
        return triangulated_copy(shape, parameters);
    } catch (const ReaderFault& fault) {
        // Killed before it began.
        if (!foreign && fault.kind == ReaderFault::Kind::kSignal && !fault.told)
            return triangulated_copy(shape, parameters);
        try {
            refuse_meshing(fault, parameters.deflection);
        } catch (const InputError& error) {
            throw error.within({"cad.shape", "{shape}: ", {{"shape", name}}});
        }
    }
}

Shape shape_from_mesh(const TriangleMesh& mesh, const RunContext& context) {
    if (!has_reader()) return faces_of_mesh(mesh);
    try {
        return unpack_shape_answer(ask_reader({"FACES", "", pack_triangles(mesh)}, context),
                                   "mesh");
    } catch (const ReaderFault& fault) {
        refuse_faces(fault);
    } catch (const Standard_Failure& failure) {
        throw InputError("brep.mesh_to_faces", "the mesh cannot be made into faces: {reason}",
                         {{"reason", failure.GetMessageString()}});
    }
}

}  // namespace beltgrinding

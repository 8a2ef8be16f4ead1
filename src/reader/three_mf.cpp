#include "three_mf.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "beltgrinding/error.h"

// All of it only in builds that read meshes.
#ifdef BELTGRINDING_READS_MESHES

#ifdef BELTGRINDING_LIB3MF
#include <lib3mf/Model/COM/NMR_DLLInterfaces.h>
#endif

namespace beltgrinding {

#ifndef BELTGRINDING_LIB3MF

std::optional<MeshBytes> read_3mf(const std::string&) {
    return std::nullopt;
}

std::string write_3mf_file(const MeshBytes&) {
    throw InputError(
        "mesh.no_lib3mf",
        "this build writes no 3MF: lib3mf was not there when it was made; write STL or PLY");
}

#else

namespace {

void require(HRESULT result, const char* what) {
    if (result != 0) {
        throw InputError(
            "mesh.not_3mf",
            "the 3MF file cannot be made: lib3mf refuses the mesh's {what} (error {error})",
            {{"what", what}, {"error", static_cast<std::uint32_t>(result)}});
    }
}

/// Any object of lib3mf's, released at the end of its life.
class Object {
  public:
    Object() = default;
    ~Object() {
        if (pointer_) NMR::lib3mf_release(pointer_);
    }
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    NMR::PLib3MFBase** slot() { return &pointer_; }
    operator NMR::PLib3MFBase*() const { return pointer_; }

  private:
    NMR::PLib3MFBase* pointer_ = nullptr;
};

/// What lib3mf writes to: it goes back to fill in sizes.
struct Buffer {
    std::string bytes;
    std::size_t at = 0;
};

BOOL put(const BYTE* data, DWORD count, void* user) {
    auto& buffer = *static_cast<Buffer*>(user);
    buffer.bytes.resize(std::max(buffer.bytes.size(), buffer.at + count));
    std::memcpy(buffer.bytes.data() + buffer.at, data, count);
    buffer.at += count;
    return 0;
}

BOOL seek(ULONG64 position, void* user) {
    static_cast<Buffer*>(user)->at = std::size_t(position);
    return 0;
}

NMR::MODELMESHCOLOR_SRGB colour_of(std::uint32_t packed) {
    const auto byte = [packed](unsigned shift) {
        return static_cast<BYTE>(packed >> shift & 255U);
    };
    return {byte(24), byte(16), byte(8), byte(0)};
}

}  // namespace

std::string write_3mf_file(const MeshBytes& whole_mesh) {
    const std::vector<std::uint32_t>& colours = whole_mesh.colours;
    std::vector<NMR::MODELMESHVERTEX> points(whole_mesh.vertices.size());
    for (std::size_t v = 0; v < points.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            points[v].m_fPosition[axis] = whole_mesh.vertices[v][axis];
    const std::vector<Triangle>& triangles = whole_mesh.triangles;
    std::vector<NMR::MODELMESHTRIANGLE> faces(triangles.size());
    for (std::size_t t = 0; t < faces.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) faces[t].m_nIndices[k] = triangles[t][k];

    Object model, mesh, item, writer;
    require(NMR::lib3mf_createmodel(model.slot()), "model");
    require(NMR::lib3mf_model_setunit(model, NMR::MODELUNIT_MILLIMETER), "unit");
    require(NMR::lib3mf_model_setlanguageutf8(model, "en-US"), "language");
    require(NMR::lib3mf_model_addmeshobject(model, mesh.slot()), "mesh");
    require(NMR::lib3mf_meshobject_setgeometry(mesh, points.data(), DWORD(points.size()),
                                               faces.data(), DWORD(faces.size())),
            "triangles");
    if (!colours.empty()) {
        std::vector<NMR::MODELMESH_TRIANGLECOLOR_SRGB> corners(faces.size());
        for (std::size_t t = 0; t < faces.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                corners[t].m_Colors[k] = colour_of(colours[triangles[t][k]]);
        Object properties, whole;
        require(NMR::lib3mf_meshobject_createpropertyhandler(mesh, properties.slot()), "colours");
        require(NMR::lib3mf_propertyhandler_setgradientcolorarray(properties, corners.data()),
                "colours");
        NMR::MODELMESHCOLOR_SRGB first = colour_of(colours[0]);
        require(NMR::lib3mf_object_createdefaultpropertyhandler(mesh, whole.slot()), "colours");
        require(NMR::lib3mf_defaultpropertyhandler_setcolor(whole, &first), "colours");
    }
    require(NMR::lib3mf_model_addbuilditem(model, mesh, nullptr, item.slot()), "build item");
    require(NMR::lib3mf_model_querywriter(model, "3mf", writer.slot()), "writer");
    Buffer file;
    require(NMR::lib3mf_writer_writetocallback(writer, reinterpret_cast<void*>(put),
                                               reinterpret_cast<void*>(seek), &file),
            "file");
    return std::move(file.bytes);
}

namespace {

double millimetres_of(DWORD unit) {
    switch (unit) {
        case NMR::MODELUNIT_MICROMETER:
            return 1e-3;
        case NMR::MODELUNIT_CENTIMETER:
            return 10.0;
        case NMR::MODELUNIT_INCH:
            return 25.4;
        case NMR::MODELUNIT_FOOT:
            return 304.8;
        case NMR::MODELUNIT_METER:
            return 1000.0;
        default:
            return 1.0;
    }
}

}  // namespace

std::optional<MeshBytes> read_3mf(const std::string& path) {
    Object model, reader, merged, meshes;
    const auto read = [&](HRESULT result) {
        if (result == 0) return;
        DWORD code = 0;
        LPCSTR words = nullptr;
        if (reader) NMR::lib3mf_getlasterror(reader, &code, &words);
        throw InputError("mesh.not_readable", "{file}: cannot be read as a mesh: {reason}",
                         {{"file", path}, {"reason", words && *words ? words : "no 3MF"}});
    };
    read(NMR::lib3mf_createmodel(model.slot()));
    read(NMR::lib3mf_model_queryreader(model, "3mf", reader.slot()));
    read(NMR::lib3mf_reader_readfromfileutf8(reader, path.c_str()));
    DWORD unit = 0;
    read(NMR::lib3mf_model_getunit(model, &unit));
    // What is built, where it is built: objects of objects become one.
    read(NMR::lib3mf_model_mergetomodel(model, merged.slot()));
    read(NMR::lib3mf_model_getmeshobjects(merged, meshes.slot()));
    MeshBytes whole;
    whole.unit = millimetres_of(unit);
    for (BOOL more = 0;;) {
        read(NMR::lib3mf_resourceiterator_movenext(meshes, &more));
        if (!more) return whole;
        Object part;
        read(NMR::lib3mf_resourceiterator_getcurrent(meshes, part.slot()));
        DWORD points = 0, faces = 0;
        read(NMR::lib3mf_meshobject_getvertexcount(part, &points));
        read(NMR::lib3mf_meshobject_gettrianglecount(part, &faces));
        std::vector<NMR::MODELMESHVERTEX> at(points);
        std::vector<NMR::MODELMESHTRIANGLE> of(faces);
        if (points > 0) read(NMR::lib3mf_meshobject_getvertices(part, at.data(), points, nullptr));
        if (faces > 0)
            read(NMR::lib3mf_meshobject_gettriangleindices(part, of.data(), faces, nullptr));
        const auto base = static_cast<std::uint32_t>(whole.vertices.size());
        for (const auto& p : at)
            whole.vertices.emplace_back(p.m_fPosition[0], p.m_fPosition[1], p.m_fPosition[2]);
        for (const auto& t : of) {  // lib3mf has refused indices beyond the vertices
            whole.triangles.push_back(
                {base + t.m_nIndices[0], base + t.m_nIndices[1], base + t.m_nIndices[2]});
        }
    }
}

#endif

}  // namespace beltgrinding

#endif

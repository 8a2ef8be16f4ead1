// What the host makes of the reader's answer (src/foreign/answer.cpp, src/meshio/mesh_bytes.cpp,
// src/brep/shape_answer.cpp, shape_transfer.cpp), from any bytes. Of a shape's answer only
// OpenCASCADE's own part is given: a checksum stands before it, and the reader has read it.

#include <Standard_Failure.hxx>
#include <algorithm>
#include <cstring>

#include <TopoDS_Shape.hxx>
#include "brep/shape_tasks.h"
#include "foreign/answer.h"
#include "meshio/mesh_bytes.h"
#include "shape_answer.h"
#include "shape_transfer.h"
#include "target.h"

namespace {

using namespace beltgrinding;

void read_tried(std::string_view bytes) {
    try {
        if (const auto tried = unpack_tried(bytes)) must(!tried->areas.empty());
    } catch (const Standard_Failure&) {
    }
}

/// A face's structure as OpenCASCADE writes it, and `numbers` after it.
void read_numbers(std::string_view numbers) {
    static const std::string packed = [] {
        const char* text =
#include "face_brep.inc"
            ;
        return pack_shape(read_brep_text(text));
    }();
    std::uint64_t size = 0;
    std::memcpy(&size, packed.data(), sizeof size);
    std::string bytes = packed.substr(0, sizeof size + size);
    bytes += numbers;
    try {
        unpack_shape(bytes);
    } catch (const Standard_Failure&) {
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = text_of(data, size);
    if (const auto error = unpack_error(bytes)) must(unpack_error(pack_error(*error)).has_value());
    if (const auto mesh = unpack_mesh(bytes)) {
        must(12 * mesh->vertices.size() <= size && 12 * mesh->triangles.size() <= size);
        for (const Triangle& t : mesh->triangles)
            must(std::max({t[0], t[1], t[2]}) < mesh->vertices.size());
    }
    unpack_triangles(bytes);
    read_tried(bytes);
    read_numbers(bytes);
    return 0;
}

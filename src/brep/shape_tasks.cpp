#include "brep/shape_tasks.h"

#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <cmath>

#include "beltgrinding/error.h"
#include "foreign/answer.h"
#include "shape_answer.h"
#include "shape_impl.h"
#include "shape_transfer.h"

namespace beltgrinding {
namespace {

/// All that the host will ask of the shape, asked here.
TriedShape tried(const TopoDS_Shape& handed_over) {
    const Shape shape = make_shape(handed_over, "shape", MissingCurves::kAreDone);
    TriedShape found;
    found.valid = shape.valid();
    try {
        found.extents = shape.extents();
    } catch (const InputError&) {
        // The host says so when it is asked.
    }
    for (std::size_t face = 0; face < shape.face_count(); ++face) {
        double area = kNoArea;
        try {
            area = shape.face_area(face);
        } catch (const InputError&) {
        }
        found.areas.push_back(area);
        shape.impl().inside_out(face);
    }
    found.signs = shape.impl().solid_sign;
    return found;
}

}  // namespace

std::string shape_answer(const TopoDS_Shape& shape) {
    add_missing_curves(shape);
    const std::string bytes = pack_shape(shape);
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    if (faces.IsEmpty()) return pack_tried(std::nullopt) + bytes;  // the host says so
    // What fails in the host must fail here: it is tried on what the host will have.
    return pack_tried(tried(unpack_shape(bytes))) + bytes;
}

std::string triangulation_answer(std::string_view input) {
    MeshingParameters parameters;
    if (!take_bytes(input, parameters)) throw Standard_Failure("nothing to triangulate");
    return pack_shape(triangulated_copy(unpack_shape(input), parameters));
}

std::string faces_answer(std::string_view input) {
    const std::optional<TriangleMesh> mesh = unpack_triangles(input);
    if (!mesh) throw Standard_Failure("no mesh to make faces of");
    return pack_tried(std::nullopt) + pack_shape(faces_of_mesh(*mesh).impl().shape);
}

}  // namespace beltgrinding

#pragma once

// What the reader of foreign files (src/reader) does with shapes, and what its host makes of it:
// both sides of the bytes between them.

#include <string>
#include <string_view>

class TopoDS_Shape;

namespace beltgrinding {

/// The shape that `BRepTools::Write` wrote; null if the text is no BREP.
TopoDS_Shape read_brep_text(const std::string& text);

/// `shape` made `scale` times larger, faces in the same order; itself for 1. Throws
/// Standard_Failure.
TopoDS_Shape scaled_shape(const TopoDS_Shape& shape, double scale);

/// In the reader: heals a shape that was read (`add_missing_curves`), asks of it in this process
/// all that the host will want to know, since OpenCASCADE's check, its integrals and its mesher
/// fail on damaged shapes as its readers do, and packs both. Throws InputError if it has no faces,
/// Standard_Failure.
std::string shape_answer(const TopoDS_Shape& shape);

/// In the reader: the triangulated copy of the shape that `input` asks for (mesh_in_reader),
/// packed. Throws Standard_Failure.
std::string triangulation_answer(std::string_view input);

/// In the reader: the faces of the mesh in `input` (shape_from_mesh), packed. Throws InputError.
std::string faces_answer(std::string_view input);

}  // namespace beltgrinding

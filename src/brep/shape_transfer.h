#pragma once

// Private to this room: a shape as bytes for another process of the same build.

#include <TopoDS_Shape.hxx>
#include <string>
#include <string_view>

namespace beltgrinding {

/// `shape` as bytes, every number to its last bit. Throws Standard_Failure for geometry that
/// OpenCASCADE's binary format does not know.
std::string pack_shape(const TopoDS_Shape& shape);

/// What `pack_shape` packed: the same faces in the same order, the same numbers. Throws
/// Standard_Failure if the bytes are not such a shape's. Thread-safe.
TopoDS_Shape unpack_shape(std::string_view bytes);

}  // namespace beltgrinding

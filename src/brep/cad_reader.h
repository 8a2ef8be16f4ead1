#pragma once

#include <TopoDS_Shape.hxx>
#include <optional>
#include <string>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// What the reader hands over: the shape, and what its first users ask for, since OpenCASCADE's
/// check and its mesher fail on damaged shapes as its readers do.
struct CadShape {
    TopoDS_Shape shape;
    bool valid = false;
    std::optional<Box> extents;  ///< mm; none if it could not be meshed
};

/// What the reader of CAD files is given.
enum class CadFormat { kStep, kIges, kBrep };

/// "STEP", "IGES", "BREP".
const char* cad_format_name(CadFormat format);

/// Reads a CAD file in a process of its own, the program `beltgrinding-cad-reader`: OpenCASCADE
/// follows null pointers and heals for ever in damaged files, and a process can be ended. `name`
/// stands for the file in messages; if `text` is not null it is read in place of `path`. The shape
/// is healed (`add_missing_curves`) and has the very numbers that the reader had. Throws InputError
/// for what cannot be read, Cancelled.
CadShape read_in_child(CadFormat format, const std::string& path, const std::string* text,
                       const std::string& name, const RunContext& context);

}  // namespace beltgrinding

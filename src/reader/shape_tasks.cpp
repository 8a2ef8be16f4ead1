#include "tasks.h"

#ifndef BELTGRINDING_READS_SHAPES

namespace beltgrinding {

std::optional<std::string> do_shape_task(std::string_view, const std::string&, const std::string&) {
    return std::nullopt;
}

}  // namespace beltgrinding

#else

#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TopoDS_Shape.hxx>
#include <charconv>
#include <fstream>
#include <iterator>
#include <new>

#include "beltgrinding/error.h"
#include "brep/shape_tasks.h"

namespace beltgrinding {
namespace {

// Value of OpenCASCADE's "read.surfacecurve.mode" that FreeCAD sets: faces must come in its order.
constexpr int kFreecadIgesCurveMode = 3;

[[noreturn]] void refuse(const std::string& format) {
    throw InputError("cad.not_readable",
                     "not a readable {format} file; export it again or use another format",
                     {{"format", format}});
}

template <class Reader>
TopoDS_Shape read_exchange(const std::string& format, const std::string& path) {
    auto* reader = new Reader;  // never destroyed: of a damaged file that could fail
    if (reader->ReadFile(path.c_str()) != IFSelect_RetDone) refuse(format);
    reader->TransferRoots();
    return reader->NbShapes() > 0 ? reader->OneShape() : TopoDS_Shape();
}

TopoDS_Shape read_brep(const std::string& path, const std::string& input) {
    if (path.empty()) {
        const TopoDS_Shape shape = read_brep_text(input);
        if (shape.IsNull()) throw InputError("cad.not_brep_text", "not the text of a BREP shape");
        return shape;
    }
    std::ifstream file(path, std::ios::binary);
    const TopoDS_Shape shape =
        read_brep_text(std::string(std::istreambuf_iterator<char>(file), {}));
    if (shape.IsNull()) refuse("BREP");
    return shape;
}

std::string read(const std::string& format, double scale, const std::string& path,
                 const std::string& input) {
    TopoDS_Shape shape;
    if (format == "STEP") {
        shape = read_exchange<STEPControl_Reader>(format, path);
    } else if (format == "IGES") {
        IGESControl_Controller::Init();
        Interface_Static::SetIVal("read.surfacecurve.mode", kFreecadIgesCurveMode);
        shape = read_exchange<IGESControl_Reader>(format, path);
    } else {
        shape = read_brep(path, input);
    }
    if (shape.IsNull())
        throw InputError("cad.null_shape",
                         "the {format} file gives no shape (null shape): it holds no solid, "
                         "shell or face that can be read; export the part again",
                         {{"format", format}});
    return shape_answer(scaled_shape(shape, scale));
}

std::string failure_reason(const Standard_Failure& failure) {
    const char* words = failure.GetMessageString();
    return words && *words ? words : failure.DynamicType()->Name();
}

}  // namespace

std::optional<std::string> do_shape_task(std::string_view task, const std::string& path,
                                         const std::string& input) {
    const std::string format(task.substr(0, task.find(' ')));
    const bool reads = format == "STEP" || format == "IGES" || format == "BREP";
    try {
        if (reads) {
            // "STEP 1.9p+4": 25 times as large as the file says.
            double scale = 1.0;
            if (format.size() < task.size())
                std::from_chars(task.data() + format.size() + 1, task.data() + task.size(), scale,
                                std::chars_format::hex);
            return read(format, scale, path, input);
        }
        if (task == "TRIANGULATE") return triangulation_answer(input);
        if (task == "FACES") return faces_answer(input);
        return std::nullopt;
    } catch (const Standard_OutOfMemory&) {
        throw std::bad_alloc();
    } catch (const Standard_Failure& failure) {
        if (reads)
            throw InputError("cad.failure", "OpenCASCADE cannot read it: {reason}",
                             {{"reason", failure_reason(failure)}});
        throw InputError("brep.not_triangulated", "the shape cannot be triangulated: {reason}",
                         {{"reason", failure_reason(failure)}});
    }
}

}  // namespace beltgrinding

#endif

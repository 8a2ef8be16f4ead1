#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <gp_Trsf.hxx>
#include <locale>
#include <mutex>
#include <sstream>

#include "beltgrinding/error.h"
#include "beltgrinding/shape.h"
#include "foreign/file_check.h"
#include "foreign/reader.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

// The printers are the process's.
std::mutex& printers_mutex() {
    static std::mutex mutex;
    return mutex;
}

class QuietMessenger {
  public:
    QuietMessenger() : printers_(Message::DefaultMessenger()->Printers()) {
        Message::DefaultMessenger()->ChangePrinters().Clear();
    }
    ~QuietMessenger() { Message::DefaultMessenger()->ChangePrinters() = printers_; }
    QuietMessenger(const QuietMessenger&) = delete;
    QuietMessenger& operator=(const QuietMessenger&) = delete;

  private:
    Message_SequenceOfPrinters printers_;
};

void require_scale(double scale) {
    if (!(scale > 0) || !std::isfinite(scale))
        throw InputError("brep.scale", "a shape's scale must be above 0, not {scale:g}",
                         {{"scale", scale}});
}

/// As the reader takes it, to the last bit; nothing for 1.
std::string scale_suffix(double scale) {
    if (scale == 1.0) return "";
    std::array<char, 40> digits{};
    const auto end = std::to_chars(digits.begin(), digits.end(), scale, std::chars_format::hex);
    std::string suffix(1, ' ');
    suffix.append(digits.begin(), end.ptr);
    return suffix;
}

/// What the reader's process makes of a file, or of a text in `input`.
std::string answer_to(const std::string& format, const std::string& path, const std::string& input,
                      double scale, const RunContext& context, const Fact& outer) {
    try {
        require_scale(scale);
        try {
            return ask_reader({format + scale_suffix(scale), path, input}, context);
        } catch (const ReaderFault& fault) {
            refuse_file(fault, format, "OpenCASCADE");
        }
    } catch (const InputError& error) {
        throw error.within(outer);
    }
}

Shape shape_of(const std::string& answer, const std::string& name, const Fact& outer) {
    try {
        return unpack_shape_answer(answer, name);
    } catch (const Standard_Failure& failure) {
        throw InputError("cad.failure", "OpenCASCADE cannot read it: {reason}",
                         {{"reason", failure.GetMessageString()}})
            .within(outer);
    }
}

std::string lower_suffix(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

}  // namespace

void set_cad_reader(const std::string& program) {
    set_reader(program);
}

TopoDS_Shape read_brep_text(const std::string& text) {
    TopoDS_Shape shape;
    // OpenCASCADE itself complains of that on the standard output.
    if (text.find("CASCADE Topology V") == std::string::npos) return shape;
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());  // whatever the host's programs have set
    // Where the text ends before its own counts do, OpenCASCADE would read on for hours or for
    // ever.
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    BRep_Builder builder;
    try {
        BRepTools::Read(shape, stream, builder);
    } catch (const std::ios_base::failure&) {
        return {};
    }
    return shape;
}

TopoDS_Shape scaled_shape(const TopoDS_Shape& shape, double scale) {
    if (scale == 1.0 || shape.IsNull()) return shape;
    gp_Trsf move;
    move.SetScaleFactor(scale);
    return BRepBuilderAPI_Transform(shape, move, true).Shape();
}

Shape Shape::read(const std::string& path, const RunContext& context, double scale) {
    if (!is_readable_file(path))
        throw InputError("cad.no_such_file", "{file}: there is no such file", {{"file", path}});
    const std::string suffix = lower_suffix(path);
    std::string format = "BREP";
    if (suffix == ".step" || suffix == ".stp") {
        format = "STEP";
    } else if (suffix == ".iges" || suffix == ".igs") {
        format = "IGES";
    } else if (suffix != ".brep" && suffix != ".brp") {
        throw InputError("cad.unknown_suffix",
                         "{file}: unknown kind of file '{suffix}'; .step, .stp, .iges, .igs, .brep "
                         "and .brp are read",
                         {{"file", path}, {"suffix", suffix}});
    }
    const Fact outer{"cad.file", "{file}: ", {{"file", path}}};
    return shape_of(answer_to(format, path, "", scale, context, outer),
                    std::filesystem::path(path).filename().string(), outer);
}

Shape Shape::read_brep(const std::string& text, const std::string& name, const RunContext& context,
                       double scale) {
    const Fact outer{"cad.shape", "{shape}: ", {{"shape", name}}};
    return shape_of(answer_to("BREP", "", text, scale, context, outer), name, outer);
}

Shape Shape::from_brep(const std::string& text, const std::string& name, double scale) {
    require_scale(scale);
    TopoDS_Shape shape;
    try {
        const std::lock_guard<std::mutex> lock(printers_mutex());
        const QuietMessenger quiet;
        shape = scaled_shape(read_brep_text(text), scale);
    } catch (const Standard_Failure& failure) {
        throw InputError("cad.brep_text", "{shape}: not the text of a BREP shape: {reason}",
                         {{"shape", name}, {"reason", failure.GetMessageString()}});
    }
    if (shape.IsNull())
        throw InputError("cad.not_brep_text", "not the text of a BREP shape")
            .within({"cad.shape", "{shape}: ", {{"shape", name}}});
    return make_shape(shape, name);
}

std::string Shape::write_brep() const {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    BRepTools::Write(impl_->shape, stream, false, false, TopTools_FormatVersion_VERSION_1);
    return stream.str();
}

}  // namespace beltgrinding

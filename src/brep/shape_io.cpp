#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>

#include "beltgrinding/error.h"
#include "beltgrinding/shape.h"
#include "crash_guard.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

// Value of OpenCASCADE's "read.surfacecurve.mode" that FreeCAD sets: faces must come in its order.
constexpr int kFreecadIgesCurveMode = 3;

// OpenCASCADE's readers share static parameters and print to the standard output.
std::mutex& reader_mutex() {
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

template <class Reader>
TopoDS_Shape read_exchange(const std::string& path, const std::string& format) {
    static bool unusable = false;  // guarded by reader_mutex()
    if (unusable) {
        throw InputError(path + ": an earlier, damaged " + format +
                         " file has broken OpenCASCADE's reader; start the program again");
    }
    auto reader = std::make_unique<Reader>();
    bool readable = false;
    TopoDS_Shape shape;
    const bool survived = survives([&] {
        readable = reader->ReadFile(path.c_str()) == IFSelect_RetDone;
        if (!readable) return;
        reader->TransferRoots();
        if (reader->NbShapes() > 0) shape = reader->OneShape();
    });
    if (!survived) {
        unusable = true;
        static_cast<void>(reader.release());  // its destructor could fail as well
    }
    if (!survived || !readable) {
        throw InputError(path + ": not a readable " + format + " file" +
                         (survived ? "" : ", it is damaged") +
                         "; export it again or use another format");
    }
    if (shape.IsNull()) {
        throw InputError(path + ": the " + format +
                         " file gives no shape (null shape): it holds no solid, shell or face that "
                         "can be read; export the part again");
    }
    return shape;
}

/// Null if the text is no BREP. OpenCASCADE itself complains of that on the standard output.
TopoDS_Shape read_brep(const std::string& text) {
    TopoDS_Shape shape;
    if (text.find("CASCADE Topology V") == std::string::npos) return shape;
    std::istringstream stream(text);
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

std::string lower_suffix(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

}  // namespace

Shape Shape::read(const std::string& path) {
    const std::string suffix = lower_suffix(path);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(path + ": there is no such file");
    TopoDS_Shape shape;
    try {
        const std::lock_guard<std::mutex> lock(reader_mutex());
        const QuietMessenger quiet;
        if (suffix == ".step" || suffix == ".stp") {
            shape = read_exchange<STEPControl_Reader>(path, "STEP");
        } else if (suffix == ".iges" || suffix == ".igs") {
            IGESControl_Controller::Init();
            Interface_Static::SetIVal("read.surfacecurve.mode", kFreecadIgesCurveMode);
            shape = read_exchange<IGESControl_Reader>(path, "IGES");
        } else if (suffix == ".brep" || suffix == ".brp") {
            std::ifstream file(path, std::ios::binary);
            shape = read_brep({std::istreambuf_iterator<char>(file), {}});
            if (shape.IsNull())
                throw InputError(path + ": not a readable BREP file; export it again");
        } else {
            throw InputError(path + ": unknown kind of file '" + suffix +
                             "'; .step, .stp, .iges, .igs, .brep and .brp are read");
        }
    } catch (const Standard_Failure& failure) {
        throw InputError(path + ": OpenCASCADE cannot read it: " + failure.GetMessageString());
    }
    return make_shape(shape, std::filesystem::path(path).filename().string());
}

Shape Shape::from_brep(const std::string& text, const std::string& name) {
    TopoDS_Shape shape;
    try {
        const std::lock_guard<std::mutex> lock(reader_mutex());
        const QuietMessenger quiet;
        shape = read_brep(text);
    } catch (const Standard_Failure& failure) {
        throw InputError(name + ": not the text of a BREP shape: " + failure.GetMessageString());
    }
    if (shape.IsNull()) throw InputError(name + ": not the text of a BREP shape");
    return make_shape(shape, name);
}

std::string Shape::write_brep() const {
    std::ostringstream stream;
    BRepTools::Write(impl_->shape, stream, false, false, TopTools_FormatVersion_VERSION_1);
    return stream.str();
}

}  // namespace beltgrinding

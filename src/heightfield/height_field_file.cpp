#include <cmath>
#include <utility>

#include "beltgrinding/error.h"
#include "beltgrinding/height_field.h"
#include "heightfield/hdf5_io.h"
#include "heightfield/sound_field.h"

namespace beltgrinding {
namespace {

using namespace hdf5;

constexpr int kFormat = 1;                    // of the file; a reader refuses newer ones
constexpr std::size_t kOtherBytes = 1 << 16;  // of a file, beside its arrays, about

/// The arrays of a field with their names, types and row lengths, for reading and writing alike.
template <class Field, class Visit>
void each_array(Field& f, Visit&& visit) {
    visit("point", f.point, H5T_NATIVE_DOUBLE, hsize_t{3});
    visit("normal", f.normal, H5T_NATIVE_FLOAT, hsize_t{3});
    visit("area", f.area, H5T_NATIVE_FLOAT, hsize_t{1});
    visit("stock_height", f.stock_height, H5T_NATIVE_FLOAT, hsize_t{1});
    visit("height", f.height, H5T_NATIVE_DOUBLE, hsize_t{1});
    visit("face", f.face, H5T_NATIVE_UINT32, hsize_t{1});
    visit("flags", f.flags, H5T_NATIVE_UINT8, hsize_t{1});
}

/// As `each_array`, of the removal trace.
template <class Trace, class Visit>
void each_trace_array(Trace& t, Visit&& visit) {
    visit("trace_first_motion", t.first, H5T_NATIVE_UINT32);
    visit("trace_last_motion", t.last, H5T_NATIVE_UINT32);
    visit("trace_dominant_motion", t.dominant, H5T_NATIVE_UINT32);
    visit("trace_dominant_depth_mm", t.dominant_depth, H5T_NATIVE_FLOAT);
    visit("trace_peak_pressure_MPa", t.peak_pressure, H5T_NATIVE_FLOAT);
}

/// As `each_array`, of the finish.
template <class Finish, class Visit>
void each_finish_array(Finish& f, Visit&& visit) {
    visit("finish_settled_um", f.settled, H5T_NATIVE_FLOAT, hsize_t{1});
    visit("finish_unknown_share", f.unknown, H5T_NATIVE_FLOAT, hsize_t{1});
    visit("finish_lay", f.lay, H5T_NATIVE_FLOAT, hsize_t{3});
    visit("finish_crossing_rad", f.crossing, H5T_NATIVE_FLOAT, hsize_t{1});
    visit("finish_passes", f.passes, H5T_NATIVE_UINT32, hsize_t{1});
    visit("finish_motion", f.motion, H5T_NATIVE_UINT32, hsize_t{1});
    visit("finish_outside", f.outside, H5T_NATIVE_UINT8, hsize_t{1});
}

constexpr const char* kTriangles = "triangles";
constexpr const char* kSdFreedom = "height_sd_freedom";  // where the heights are not normal

constexpr const char* kFinish = "finish_settled_um";     // where the finish was computed
constexpr const char* kHeat = "heat_peak_rise_K";        // where heat was computed
constexpr const char* kHeatMotion = "heat_motion";       // with it
constexpr const char* kTrace = "trace_first_motion";     // where the simulation kept a trace
constexpr const char* kMeasured = "measured_mm";         // where a scan was compared
constexpr const char* kHeightSd = "height_sd_mm";        // where a calibrated law gave it
constexpr const char* kHeightError = "height_error_mm";  // where a run estimated it
constexpr const char* kRays = "ray";                     // where some lean

Fact within(const std::string& path) {
    return {"heightfield.file", "{file}: the height field ", {{"file", path}}};
}

void write_all(const HeightField& field, hid_t file, const std::string& attributes) {
    write_scalar(file, "format", H5T_NATIVE_INT, &kFormat);
    write_scalar(file, "spacing_mm", H5T_NATIVE_DOUBLE, &field.spacing);
    write_scalar(file, "depth_mm", H5T_NATIVE_DOUBLE, &field.depth);
    each_array(field, [&](const char* name, const auto& data, hid_t type, hsize_t row) {
        write_array(file, name, data, type, row);
    });
    write_rows<Triangle>(file, kTriangles, field.triangles.size(), H5T_NATIVE_UINT32, 3,
                         [&](std::size_t first, std::span<Triangle> some) {
                             for (Triangle& triangle : some) triangle = field.triangles[first++];
                         });
    if (!field.height_sd.empty()) {
        write_array(file, kHeightSd, field.height_sd, H5T_NATIVE_FLOAT, 1);
        if (std::isfinite(field.sd_freedom))
            write_scalar(file, kSdFreedom, H5T_NATIVE_DOUBLE, &field.sd_freedom);
    }
    if (!field.height_error.empty())
        write_array(file, kHeightError, field.height_error, H5T_NATIVE_FLOAT, 1);
    if (!field.rays.empty()) write_array(file, kRays, field.rays, H5T_NATIVE_FLOAT, 3);
    if (!field.measured.empty()) {
        write_array(file, kMeasured, field.measured, H5T_NATIVE_FLOAT, 1);
    }
    if (!field.trace.empty()) {
        each_trace_array(field.trace, [&](const char* name, const auto& data, hid_t type) {
            write_array(file, name, data, type, 1);
        });
    }
    if (!field.heat.empty()) {
        write_array(file, kHeat, field.heat.rise, H5T_NATIVE_FLOAT, 1);
        write_array(file, kHeatMotion, field.heat.motion, H5T_NATIVE_UINT32, 1);
    }
    if (!field.finish.empty()) {
        each_finish_array(field.finish,
                          [&](const char* name, const auto& data, hid_t type, hsize_t row) {
                              write_array(file, name, data, type, row);
                          });
    }
    write_text(file, "attributes", attributes);
}

/// A field of a file, checked. Throws FileFault.
HeightField read(std::unique_ptr<Storage> storage, std::string* attributes) {
    const InputFile file(std::move(storage), "format", kFormat);
    HeightField field;
    read_scalar(file, "spacing_mm", H5T_NATIVE_DOUBLE, &field.spacing);
    read_scalar(file, "depth_mm", H5T_NATIVE_DOUBLE, &field.depth);
    each_array(field, [&](const char* array, auto& data, hid_t type, hsize_t row) {
        read_array(file, array, data, type, row);
    });
    read_rows<Triangle>(file, kTriangles, H5T_NATIVE_UINT32, 3,
                        [&](std::span<const Triangle> some) {
                            for (const Triangle& triangle : some)
                                field.triangles.push_back(triangle);
                        });
    field.triangles.shrink_to_fit();
    if (H5Lexists(file, kRays, H5P_DEFAULT) > 0) {
        read_array(file, kRays, field.rays, H5T_NATIVE_FLOAT, 3);
    }
    if (H5Lexists(file, kMeasured, H5P_DEFAULT) > 0) {
        read_array(file, kMeasured, field.measured, H5T_NATIVE_FLOAT, 1);
    }
    if (H5Lexists(file, kHeightSd, H5P_DEFAULT) > 0) {
        read_array(file, kHeightSd, field.height_sd, H5T_NATIVE_FLOAT, 1);
        if (H5Aexists(file, kSdFreedom) > 0)
            read_scalar(file, kSdFreedom, H5T_NATIVE_DOUBLE, &field.sd_freedom);
    }
    if (H5Lexists(file, kHeightError, H5P_DEFAULT) > 0) {
        read_array(file, kHeightError, field.height_error, H5T_NATIVE_FLOAT, 1);
    }
    if (H5Lexists(file, kTrace, H5P_DEFAULT) > 0) {
        each_trace_array(field.trace, [&](const char* array, auto& data, hid_t type) {
            read_array(file, array, data, type, 1);
        });
    }
    if (H5Lexists(file, kHeat, H5P_DEFAULT) > 0) {
        read_array(file, kHeat, field.heat.rise, H5T_NATIVE_FLOAT, 1);
        read_array(file, kHeatMotion, field.heat.motion, H5T_NATIVE_UINT32, 1);
    }
    if (H5Lexists(file, kFinish, H5P_DEFAULT) > 0) {
        each_finish_array(field.finish,
                          [&](const char* array, auto& data, hid_t type, hsize_t row) {
                              read_array(file, array, data, type, row);
                          });
    }
    if (auto fault = fault_of(field)) throw FileFault{*std::move(fault)};
    if (attributes != nullptr) *attributes = read_text(file, "attributes");
    return field;
}

/// About how many bytes a file has.
std::size_t expected(const HeightField& field) {
    return field.bytes() + field.bytes() / 64 + kOtherBytes;
}

Writer writer(const HeightField& field, const std::string& attributes) {
    return [&](hid_t file) { write_all(field, file, attributes); };
}

}  // namespace

std::string hdf5_image(const HeightField& field, const std::string& attributes) {
    check_sound(field);
    return locked(within("HDF5"),
                  [&] { return image_of(writer(field, attributes), expected(field)); });
}

void write_hdf5(const HeightField& field, const std::string& path, const std::string& attributes) {
    check_sound(field);
    locked(within(path), [&] { write_file(path, writer(field, attributes)); });
}

std::error_code write_hdf5(const HeightField& field, int file, const std::string& attributes) {
    check_sound(field);
    return locked(within("HDF5"), [&] { return write_into(file, writer(field, attributes)); });
}

HeightField read_hdf5(const std::string& path, std::string* attributes) {
    return locked(within(path), [&] {
        RegularFile file;
        open_regular(file, path);
        return read(stored_in(file.number()), attributes);
    });
}

HeightField read_hdf5_image(std::string_view image, const std::string& name,
                            std::string* attributes) {
    return locked(within(name), [&] { return read(stored_in(image), attributes); });
}

}  // namespace beltgrinding

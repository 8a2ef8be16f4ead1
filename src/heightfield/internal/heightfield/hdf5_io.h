#pragma once

// For the sources that read or write an HDF5 file; no public header includes it.

#include <hdf5.h>

#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "beltgrinding/error.h"

namespace beltgrinding::hdf5 {

/// Owns an HDF5 identifier; negative is none.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator hid_t() const { return id_; }
    bool ok() const { return id_ >= 0; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Thrown by all below; the reader or writer of a file makes an InputError of it that names the
/// path.
struct FileFault {
    Fact fact;
};

inline void require(bool ok, const char* code, const char* form, Arguments arguments = {}) {
    if (!ok) throw FileFault{{code, form, std::move(arguments)}};
}

/// Lets `write(temporary)` write a file beside `path`, which it then becomes: whole or not at all.
/// Throws InputError within `context`, which names the path. Call it with the lock held.
template <class Write>
void write_whole(const std::string& path, const Fact& context, Write&& write) {
    const std::string temporary = path + ".part";
    try {
        write(temporary);
        std::error_code error;
        std::filesystem::rename(temporary, path, error);
        require(!error, "hdf5.not_written", "cannot be written: {reason}",
                {{"reason", error.message()}});
    } catch (const FileFault& fault) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw InputError(fault.fact, {context});
    }
}

/// Debian's serial HDF5 is not thread-safe, and prints its errors unless told not to.
inline std::unique_lock<std::mutex> hdf5_lock() {
    static std::mutex mutex;
    std::unique_lock<std::mutex> lock(mutex);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return lock;
}

inline void write_scalar(hid_t file, const char* name, hid_t type, const void* value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(attribute.ok() && H5Awrite(attribute, type, value) >= 0, "hdf5.not_writable",
            "cannot write it");
}

inline void read_scalar(hid_t file, const char* name, hid_t type, void* value) {
    const Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
    require(attribute.ok(), "hdf5.no_attribute", "has no attribute '{name}'", {{"name", name}});
    const Handle space(H5Aget_space(attribute), H5Sclose);
    require(H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, type, value) >= 0,
            "hdf5.attribute", "its attribute '{name}' is not a number", {{"name", name}});
}

/// A file opened for reading.
class InputFile {
  public:
    /// Checks that the file has the format `known`, which its attribute `format_name` tells.
    InputFile(const std::string& path, const char* format_name, int known)
        : bytes_(bytes_of(path)),
          file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
        require(file_.ok(), "hdf5.no_file", "is no HDF5 file");
        int format = 0;
        read_scalar(file_, format_name, H5T_NATIVE_INT, &format);
        require(format == known, "hdf5.format", "has format {format}, this version reads {known}",
                {{"format", format}, {"known", known}});
    }
    operator hid_t() const { return file_; }
    hsize_t bytes() const { return bytes_; }

  private:
    static hsize_t bytes_of(const std::string& path) {
        std::error_code error;
        const auto bytes = static_cast<hsize_t>(std::filesystem::file_size(path, error));
        require(!error, "hdf5.not_opened", "cannot be opened: {reason}",
                {{"reason", error.message()}});
        return bytes;
    }

    hsize_t bytes_;
    Handle file_;
};

/// A new file, empty, without times of its own: the same data make the same bytes at any time. In
/// the format of 1.10, whose headers have checksums: HDF5 trusts those of older formats, and
/// damaged ones lead it beyond its memory.
inline hid_t create_file(const std::string& path) {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    if (!creation.ok() || H5Pset_obj_track_times(creation, false) < 0 || !access.ok() ||
        H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110) < 0) {
        return H5I_INVALID_HID;
    }
    return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access);
}

template <class T>
inline void write_array(hid_t file, const char* name, const std::vector<T>& data, hid_t type,
                        hsize_t row) {
    const hsize_t dims[2] = {data.size(), row};
    const Handle space(H5Screate_simple(row == 1 ? 1 : 2, dims, nullptr), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);  // the same data make the same bytes at any time
    const Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                     H5Dclose);
    require(creation.ok() && set.ok(), "hdf5.not_writable", "cannot write it");
    if (!data.empty()) {
        require(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) >= 0,
                "hdf5.not_writable_full", "cannot write it; is the disk full?");
    }
}

template <class T>
inline void read_array(const InputFile& file, const char* name, std::vector<T>& data, hid_t type,
                       hsize_t row) {
    const Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    require(set.ok(), "hdf5.no_array", "has no array '{name}'", {{"name", name}});
    const Handle space(H5Dget_space(set), H5Sclose);
    hsize_t dims[2] = {0, 1};
    const int rank = H5Sget_simple_extent_ndims(space);
    require(rank == (row == 1 ? 1 : 2), "hdf5.array_shape",
            "its array '{name}' has the wrong shape", {{"name", name}});
    H5Sget_simple_extent_dims(space, dims, nullptr);
    require(dims[1] == row, "hdf5.array_shape", "its array '{name}' has the wrong shape",
            {{"name", name}});
    // A broken header must not make us ask for memory that no such file can fill.
    require(dims[0] <= file.bytes(), "hdf5.array_too_long",
            "its array '{name}' is longer than the file", {{"name", name}});
    data.resize(dims[0]);
    if (dims[0] > 0) {
        require(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) >= 0,
                "hdf5.array_unreadable", "its array '{name}' cannot be read", {{"name", name}});
    }
}

inline void write_text(hid_t file, const char* name, const std::string& text) {
    const std::vector<char> bytes(text.begin(), text.end());
    write_array(file, name, bytes, H5T_NATIVE_CHAR, 1);
}

inline std::string read_text(const InputFile& file, const char* name) {
    std::vector<char> bytes;
    read_array(file, name, bytes, H5T_NATIVE_CHAR, 1);
    return {bytes.begin(), bytes.end()};
}

}  // namespace beltgrinding::hdf5

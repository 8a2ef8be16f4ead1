#pragma once

// For the sources that read or write an HDF5 file; no public header includes it.

#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/whole_file.h"
#include "beltgrinding/error.h"
#include "heightfield/hdf5_storage.h"

namespace beltgrinding::hdf5 {

/// Owns an HDF5 identifier; negative is none.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
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

/// Debian's serial HDF5 is not thread-safe, and prints its errors unless told not to.
inline std::unique_lock<std::mutex> hdf5_lock() {
    static std::mutex mutex;
    std::unique_lock<std::mutex> lock(mutex);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return lock;
}

/// What `work` returns, while HDF5 is locked; a FileFault becomes an InputError within `file`.
template <class Work>
auto locked(const Fact& file, Work&& work) {
    const auto lock = hdf5_lock();
    try {
        return work();
    } catch (const FileFault& fault) {
        throw InputError(fault.fact, {file});
    }
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

/// A file opened for reading. Nothing of it leads out of it: see `open_array`.
class InputFile {
  public:
    /// Checks that the file has the format `known`, or one from `oldest` on if that is not 0, which
    /// its attribute `format_name` tells. What `storage` holds must stay.
    InputFile(std::unique_ptr<Storage> storage, const char* format_name, int known, int oldest = 0);
    operator hid_t() const { return file_; }
    hsize_t bytes() const { return storage_->size(); }

  private:
    std::unique_ptr<Storage> storage_;
    StorageAccess access_;
    Handle file_;
};

/// Opens the regular file at `path`, for a storage of its descriptor. Throws FileFault.
void open_regular(RegularFile& file, const std::string& path);

/// A data set opened for reading. An external link, a link to another name, data that lie in other
/// files or behind a filter that HDF5 would load are refused: a file is what its bytes say. Throws
/// FileFault.
Handle open_array(const InputFile& file, const char* name);

/// A new, empty data set of `rows` rows of `row` values, with checksums (Fletcher32). Throws
/// FileFault.
Handle create_array(hid_t file, const char* name, hid_t type, hsize_t rows, hsize_t row);

/// What fills a new file.
using Writer = std::function<void(hid_t)>;

/// The bytes of a file that `write` fills; about `expected` of them. Without times: the same data
/// make the same bytes. Throws FileFault.
std::string image_of(const Writer& write, std::size_t expected);

/// The same bytes into an open, empty file, as they are made. Returns why it did not take them.
/// Throws FileFault for all else.
std::error_code write_into(int file, const Writer& write);

/// The same bytes to `path`, whole or not at all. Throws FileFault.
void write_file(const std::string& path, const Writer& write);

/// Rows of `row` values that fit into a chunk, one at least.
hsize_t rows_of_chunk(hid_t type, hsize_t row);

/// Calls visit(start, count, space of so many in memory) for `rows` rows, `some` at a time.
template <class Visit>
void in_pieces(hsize_t rows, hsize_t row, hsize_t some, Visit visit) {
    hsize_t start[2] = {0, 0};
    for (; start[0] < rows; start[0] += some) {
        const hsize_t count[2] = {std::min(rows - start[0], some), row};
        const Handle memory(H5Screate_simple(row == 1 ? 1 : 2, count, nullptr), H5Sclose);
        visit(start, count, memory);
    }
}

/// Writes arrays that follow one another as one data set, rows of `row` values. Throws FileFault.
template <class T>
inline void write_array(hid_t file, const char* name, const std::vector<std::span<const T>>& parts,
                        hid_t type, hsize_t row) {
    hsize_t rows = 0;
    for (const auto& part : parts) rows += part.size();
    const Handle set = create_array(file, name, type, rows, row);
    const Handle space(H5Dget_space(set), H5Sclose);
    hsize_t start[2] = {0, 0};
    for (const auto& part : parts) {
        if (part.empty()) continue;
        const hsize_t count[2] = {part.size(), row};
        const Handle memory(H5Screate_simple(row == 1 ? 1 : 2, count, nullptr), H5Sclose);
        require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
                    H5Dwrite(set, type, memory, space, H5P_DEFAULT, part.data()) >= 0,
                "hdf5.not_writable", "cannot write it");
        start[0] += count[0];
    }
}

/// Writes `rows` rows of values of type T, those of a chunk at a time: `fill(first, some)` makes
/// those from the row `first` on. Throws FileFault.
template <class T, class Fill>
inline void write_rows(hid_t file, const char* name, hsize_t rows, hid_t type, hsize_t row,
                       Fill&& fill) {
    const Handle set = create_array(file, name, type, rows, row);
    const Handle space(H5Dget_space(set), H5Sclose);
    const hsize_t at_once = rows_of_chunk(type, row);
    std::vector<T> some(std::min(rows, at_once));
    in_pieces(rows, row, at_once, [&](const hsize_t* start, const hsize_t* count, hid_t memory) {
        const std::span<T> now(some.data(), count[0]);
        fill(start[0], now);
        require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
                    H5Dwrite(set, type, memory, space, H5P_DEFAULT, now.data()) >= 0,
                "hdf5.not_writable", "cannot write it");
    });
}

template <class T>
inline void write_array(hid_t file, const char* name, const std::vector<T>& data, hid_t type,
                        hsize_t row) {
    write_array(file, name, std::vector<std::span<const T>>{data}, type, row);
}

/// How many rows of `row` values an array has. Throws FileFault where they are others.
hsize_t rows_of(const InputFile& file, const char* name, hid_t set, hsize_t row);

/// Rows of its chunks, of which HDF5 may read all for any of them; 0: it has none.
hsize_t rows_stored_together(hid_t set);

inline void require_sound(bool ok, const char* name) {
    require(ok, "hdf5.array_damaged",
            "its array '{name}' is damaged: it is not what was written there", {{"name", name}});
}

template <class T>
inline void read_array(const InputFile& file, const char* name, std::vector<T>& data, hid_t type,
                       hsize_t row) {
    const Handle set = open_array(file, name);
    data.resize(rows_of(file, name, set, row));
    if (data.empty()) return;
    require_sound(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) >= 0, name);
}

/// Reads rows of values of type T and hands them to `take(some)`, those of a chunk at a time.
/// Throws FileFault.
template <class T, class Take>
inline void read_rows(const InputFile& file, const char* name, hid_t type, hsize_t row,
                      Take&& take) {
    const Handle set = open_array(file, name);
    const hsize_t rows = rows_of(file, name, set, row);
    const Handle space(H5Dget_space(set), H5Sclose);
    const hsize_t at_once = std::max(rows_of_chunk(type, row), rows_stored_together(set));
    std::vector<T> some(std::min(rows, at_once));
    in_pieces(rows, row, at_once, [&](const hsize_t* start, const hsize_t* count, hid_t memory) {
        require_sound(
            H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
                H5Dread(set, type, memory, space, H5P_DEFAULT, some.data()) >= 0,
            name);
        take(std::span<const T>(some.data(), count[0]));
    });
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

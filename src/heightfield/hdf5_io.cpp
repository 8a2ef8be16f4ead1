#include "heightfield/hdf5_io.h"

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

namespace beltgrinding::hdf5 {
namespace {

constexpr hsize_t kChunkBytes = 1 << 20;  // of an array: a checksum each

/// A storage that did not take what HDF5 wrote.
void require_written(const std::error_code& error) {
    require(error != std::errc::not_enough_memory, "hdf5.memory", "does not fit into memory");
    require(error != std::errc::no_space_on_device, "hdf5.disk_full",
            "cannot be written; is the disk full?");
    require(!error, "hdf5.not_written", "cannot be written: {reason}",
            {{"reason", error.message()}});
}

/// Returns why the storage did not take all.
std::error_code fill(Storage& storage, const Writer& write) {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    const StorageAccess access(storage);
    // In the format of 1.10, whose headers have checksums: HDF5 trusts those of older formats, and
    // damaged ones lead it beyond its memory.
    require(creation.ok() && access >= 0 && H5Pset_obj_track_times(creation, false) >= 0 &&
                H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0,
            "hdf5.memory", "does not fit into memory");
    try {
        const Handle file(H5Fcreate("storage", H5F_ACC_TRUNC, creation, access), H5Fclose);
        require(file.ok(), "hdf5.memory", "does not fit into memory");
        write(file);
        require(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "hdf5.memory", "does not fit into memory");
    } catch (const FileFault&) {
        if (!storage.error()) throw;  // else HDF5 read what it could not write
    }
    return storage.error();
}

}  // namespace

InputFile::InputFile(std::unique_ptr<Storage> storage, const char* format_name, int known,
                     int oldest)
    : storage_(std::move(storage)),
      access_(*storage_),
      file_(access_ >= 0 ? H5Fopen("storage", H5F_ACC_RDONLY, access_) : H5I_INVALID_HID,
            H5Fclose) {
    require(file_.ok(), "hdf5.no_file", "is no HDF5 file");
    int format = 0;
    read_scalar(file_, format_name, H5T_NATIVE_INT, &format);
    require(format <= known && format >= (oldest > 0 ? oldest : known), "hdf5.format",
            "has format {format}, this version reads {known}",
            {{"format", format}, {"known", known}});
}

void open_regular(RegularFile& file, const std::string& path) {
    const std::error_code error = file.open(path);
    require(!error, "hdf5.not_opened", "cannot be opened: {reason}",
            {{"reason", error == std::errc::invalid_argument ? "it is a pipe or a device"
                                                             : error.message()}});
}

Handle open_array(const InputFile& file, const char* name) {
    H5L_info_t link{};
    require(H5Lget_info(file, name, &link, H5P_DEFAULT) >= 0, "hdf5.no_array",
            "has no array '{name}'", {{"name", name}});
    const auto inside = [name](bool ok) {
        require(
            ok, "hdf5.leads_out",
            "its array '{name}' lies in another file or needs a foreign filter; that is not read",
            {{"name", name}});
    };
    inside(link.type == H5L_TYPE_HARD);
    Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    require(set.ok(), "hdf5.no_array", "has no array '{name}'", {{"name", name}});
    const Handle creation(H5Dget_create_plist(set), H5Pclose);
    require(creation.ok(), "hdf5.no_array", "has no array '{name}'", {{"name", name}});
    inside(H5Pget_external_count(creation) == 0 && H5Pget_layout(creation) != H5D_VIRTUAL);
    const int filters = H5Pget_nfilters(creation);
    for (int i = 0; i < filters; ++i) {
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        inside(H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0,
                              nullptr, &config) == H5Z_FILTER_FLETCHER32);
    }
    return set;
}

hsize_t rows_of_chunk(hid_t type, hsize_t row) {
    return std::max<hsize_t>(1, kChunkBytes / (row * H5Tget_size(type)));
}

hsize_t rows_of(const InputFile& file, const char* name, hid_t set, hsize_t row) {
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
    return dims[0];
}

hsize_t rows_stored_together(hid_t set) {
    const Handle creation(H5Dget_create_plist(set), H5Pclose);
    hsize_t chunk[2] = {0, 0};
    if (!creation.ok() || H5Pget_layout(creation) != H5D_CHUNKED) return 0;
    return H5Pget_chunk(creation, 2, chunk) > 0 ? chunk[0] : 0;
}

Handle create_array(hid_t file, const char* name, hid_t type, hsize_t rows, hsize_t row) {
    const int rank = row == 1 ? 1 : 2;
    const hsize_t dims[2] = {rows, row};
    const Handle space(H5Screate_simple(rank, dims, nullptr), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    bool ok = creation.ok() && H5Pset_obj_track_times(creation, false) >= 0;
    if (rows > 0) {
        const hsize_t chunk[2] = {std::min(rows, rows_of_chunk(type, row)), row};
        ok = ok && H5Pset_chunk(creation, rank, chunk) >= 0 && H5Pset_fletcher32(creation) >= 0;
    }
    Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
    require(ok && set.ok(), "hdf5.not_writable", "cannot write it");
    return set;
}

std::string image_of(const Writer& write, std::size_t expected) {
    std::string bytes;
    std::unique_ptr<Storage> storage;
    try {
        storage = stored_in(bytes, expected);
    } catch (const std::bad_alloc&) {
        require(false, "hdf5.memory", "does not fit into memory");
    }
    require_written(fill(*storage, write));
    return bytes;
}

std::error_code write_into(int file, const Writer& write) {
    return fill(*stored_in(file), write);
}

void write_file(const std::string& path, const Writer& write) {
    require_written(write_whole(path, [&](int file) { return write_into(file, write); }));
}

}  // namespace beltgrinding::hdf5

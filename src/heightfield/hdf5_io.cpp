#include "heightfield/hdf5_io.h"

#include <malloc.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <system_error>

#include "base/large_memory.h"
#include "base/whole_file.h"

namespace beltgrinding::hdf5 {
namespace {

constexpr hsize_t kChunkBytes = 1 << 20;     // of an array: a checksum each
constexpr std::size_t kIncrement = 1 << 20;  // bytes by which a file in memory grows

/// What cannot be opened: the system's words.
void require_read(const std::error_code& error) {
    require(!error, "hdf5.not_opened", "cannot be opened: {reason}",
            {{"reason", error == std::errc::invalid_argument ? "it is a pipe or a device"
                                                             : error.message()}});
}

Handle in_memory() {
    Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    require(access.ok() && H5Pset_fapl_core(access, kIncrement, false) >= 0, "hdf5.memory",
            "does not fit into memory");
    return access;
}

Handle open_image(std::string_view image) {
    const Handle access = in_memory();
    // HDF5 copies the bytes and does not change them.
    auto* bytes = const_cast<char*>(image.data());
    require(H5Pset_file_image(access, bytes, image.size()) >= 0, "hdf5.memory",
            "does not fit into memory");
    return {H5Fopen("image", H5F_ACC_RDONLY, access), H5Fclose};
}

}  // namespace

InputFile::InputFile(std::string_view image, const char* format_name, int known, int oldest)
    : bytes_(image.size()), file_(open_image(image)) {
    require(file_.ok(), "hdf5.no_file", "is no HDF5 file");
    int format = 0;
    read_scalar(file_, format_name, H5T_NATIVE_INT, &format);
    require(format <= known && format >= (oldest > 0 ? oldest : known), "hdf5.format",
            "has format {format}, this version reads {known}",
            {{"format", format}, {"known", known}});
}

std::string bytes_of(const std::string& path) {
    std::string bytes;
    require_read(read_whole(path, bytes));
    return bytes;
}

void write_bytes(const std::string& path, const std::string& image) {
    const std::error_code error = beltgrinding::write_whole(path, image);
    require(error != std::errc::no_space_on_device, "hdf5.disk_full",
            "cannot be written; is the disk full?");
    require(!error, "hdf5.not_written", "cannot be written: {reason}",
            {{"reason", error.message()}});
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

Handle create_array(hid_t file, const char* name, hid_t type, hsize_t rows, hsize_t row) {
    const int rank = row == 1 ? 1 : 2;
    const hsize_t dims[2] = {rows, row};
    const Handle space(H5Screate_simple(rank, dims, nullptr), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    bool ok = creation.ok() && H5Pset_obj_track_times(creation, false) >= 0;
    if (rows > 0) {
        const hsize_t fit = std::max<hsize_t>(1, kChunkBytes / (row * H5Tget_size(type)));
        const hsize_t chunk[2] = {std::min(rows, fit), row};
        ok = ok && H5Pset_chunk(creation, rank, chunk) >= 0 && H5Pset_fletcher32(creation) >= 0;
    }
    Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
    require(ok && set.ok(), "hdf5.not_writable", "cannot write it");
    return set;
}

namespace {

/// A file in memory while HDF5 fills it, and what came of it.
struct Image {
    std::string bytes;
    std::size_t room = 0;  // of HDF5's memory
};

/// HDF5 asks for 1 MiB more each time, which would copy all that is there; it gets twice the room
/// where that can be had.
void* grown(void* memory, std::size_t size, H5FD_file_image_op_t /*operation*/, void* image) {
    std::size_t& room = static_cast<Image*>(image)->room;
    if (size <= room) return memory;
    for (const std::size_t wanted : {std::max(size, 2 * room), size}) {
        void* larger = std::realloc(memory, wanted);
        if (larger == nullptr) continue;
        room = wanted;
        expect_large_use(larger, wanted);
        return larger;
    }
    return nullptr;
}

/// What HDF5 hands over when it closes a file in memory. (H5Fget_file_image of 1.10 changes a flag
/// below the superblock's checksum: such a file cannot be opened.)
herr_t keep_image(void* memory, H5FD_file_image_op_t operation, void* image) {
    if (operation == H5FD_FILE_IMAGE_OP_FILE_CLOSE && memory) {
        constexpr std::size_t kEndOfFile = 28, kSuperblock = 48;  // of version 3, in bytes
        std::uint64_t size = 0;
        const auto* begin = static_cast<const char*>(memory);
        const std::size_t held = malloc_usable_size(memory);
        if (held >= kSuperblock) std::memcpy(&size, begin + kEndOfFile, sizeof size);
        if (size <= held) {
            try {
                std::string& bytes = static_cast<Image*>(image)->bytes;
                bytes.reserve(size);
                expect_large_use(bytes.data(), size);
                bytes.assign(begin, size);
            } catch (const std::bad_alloc&) {  // through C; an empty image says it
            }
        }
    }
    std::free(memory);
    return 0;
}

void* same(void* image) {
    return image;
}

herr_t nothing_to_free(void* /*image*/) {
    return 0;
}

}  // namespace

std::string image_of(const std::function<void(hid_t)>& write) {
    Image image;
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    const Handle access = in_memory();
    H5FD_file_image_callbacks_t calls{nullptr, nullptr,         grown, keep_image,
                                      same,    nothing_to_free, &image};
    // In the format of 1.10, whose headers have checksums: HDF5 trusts those of older formats, and
    // damaged ones lead it beyond its memory.
    require(creation.ok() && H5Pset_obj_track_times(creation, false) >= 0 &&
                H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0 &&
                H5Pset_file_image_callbacks(access, &calls) >= 0,
            "hdf5.memory", "does not fit into memory");
    {
        const Handle file(H5Fcreate("image", H5F_ACC_TRUNC, creation, access), H5Fclose);
        require(file.ok(), "hdf5.memory", "does not fit into memory");
        write(file);
        require(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "hdf5.memory", "does not fit into memory");
    }
    require(!image.bytes.empty(), "hdf5.memory", "does not fit into memory");
    return std::move(image.bytes);
}

}  // namespace beltgrinding::hdf5

// HDF5's own driver for memory copies a file that it opens, and what it has written as often as it
// grows; its driver for files leaves a file open that a full disk keeps it from closing.

#include <algorithm>
#include <iterator>
#include <new>

#include "heightfield/hdf5_storage.h"
#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>  // since 1.14
#endif

namespace beltgrinding::hdf5 {
namespace {

using Lease = StorageAccess::Lease;

constexpr haddr_t kMostBytes = ~haddr_t{0} >> 1U;  // an address is an off_t, which has a sign

/// The driver's part of the property list: HDF5 copies it as bytes.
struct Info {
    const std::shared_ptr<Lease>* lease;
};

struct OpenFile {
    H5FD_t head;  // HDF5's own, which must be first
    std::shared_ptr<Lease> lease;
    haddr_t end = 0;  // of what HDF5 has given addresses to
};

OpenFile& own(H5FD_t* file) {
    return *reinterpret_cast<OpenFile*>(file);
}
const OpenFile& own(const H5FD_t* file) {
    return *reinterpret_cast<const OpenFile*>(file);
}

H5FD_t* open_file(const char* /*name*/, unsigned flags, hid_t list, haddr_t /*most*/) {
    const auto* info = static_cast<const Info*>(H5Pget_driver_info(list));
    if (info == nullptr || (*info->lease)->storage == nullptr) return nullptr;
    auto* file = new (std::nothrow) OpenFile{{}, *info->lease, 0};
    if (file == nullptr) return nullptr;
    if ((flags & H5F_ACC_TRUNC) != 0) (*info->lease)->storage->resize(0);
    return &file->head;
}

herr_t close_file(H5FD_t* file) {
    delete &own(file);
    return 0;
}

// As of HDF5's driver for memory, so that files have the same bytes.
herr_t features(const H5FD_t* /*file*/, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

haddr_t end_of_addresses(const H5FD_t* file, H5FD_mem_t /*type*/) {
    return own(file).end;
}

herr_t set_end_of_addresses(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t end) {
    own(file).end = end;
    return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t /*type*/) {
    const Storage* storage = own(file).lease->storage;
    return storage != nullptr ? storage->size() : 0;
}

herr_t read_bytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*list*/, haddr_t at, std::size_t size,
                  void* to) {
    Storage* storage = own(file).lease->storage;
    if (storage == nullptr) return -1;
    // What has an address and was not written yet is 0.
    const std::uint64_t held = storage->size();
    const std::size_t there = at < held ? std::min<std::uint64_t>(size, held - at) : 0;
    auto* bytes = static_cast<char*>(to);
    std::fill(bytes + there, bytes + size, '\0');
    return storage->read(at, {bytes, there}) ? 0 : -1;
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*list*/, haddr_t at, std::size_t size,
                   const void* from) {
    if (Storage* storage = own(file).lease->storage; storage != nullptr)
        storage->write(at, {static_cast<const char*>(from), size});
    return 0;
}

herr_t truncate_file(H5FD_t* file, hid_t /*list*/, hbool_t /*closing*/) {
    const OpenFile& own_file = own(file);
    if (Storage* storage = own_file.lease->storage; storage != nullptr)
        storage->resize(own_file.end);
    return 0;
}

hid_t driver() {
    static const hid_t number = [] {
        static H5FD_class_t made{};
#ifdef H5FD_CLASS_VERSION
        made.version = H5FD_CLASS_VERSION;
        made.value = H5_VFD_MAX;
#endif
        made.name = "beltgrinding_storage";
        made.maxaddr = kMostBytes;
        made.fc_degree = H5F_CLOSE_WEAK;
        made.fapl_size = sizeof(Info);
        made.open = open_file;
        made.close = close_file;
        made.query = features;
        made.get_eoa = end_of_addresses;
        made.set_eoa = set_end_of_addresses;
        made.get_eof = end_of_file;
        made.read = read_bytes;
        made.write = write_bytes;
        made.truncate = truncate_file;
        constexpr H5FD_mem_t kMap[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
        std::copy(std::begin(kMap), std::end(kMap), made.fl_map);
        return H5FDregister(&made);
    }();
    return number;
}

}  // namespace

StorageAccess::StorageAccess(Storage& storage)
    : lease_(std::make_shared<Lease>(Lease{&storage})), list_(H5Pcreate(H5P_FILE_ACCESS)) {
    const Info info{&lease_};
    if (list_ >= 0 && H5Pset_driver(list_, driver(), &info) < 0) {
        H5Pclose(list_);
        list_ = H5I_INVALID_HID;
    }
}

StorageAccess::~StorageAccess() {
    lease_->storage = nullptr;
    if (list_ >= 0) H5Pclose(list_);
}

}  // namespace beltgrinding::hdf5

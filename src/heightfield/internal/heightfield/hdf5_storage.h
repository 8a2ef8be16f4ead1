#pragma once

// Where the bytes of an HDF5 file lie; no public header includes it.

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace beltgrinding::hdf5 {

/// The bytes of a file that HDF5 has open, as its driver of ours reads and writes them.
class Storage {
  public:
    Storage() = default;
    virtual ~Storage() = default;
    Storage(const Storage&) = delete;
    Storage& operator=(const Storage&) = delete;

    /// How many they are.
    virtual std::uint64_t size() const = 0;
    /// Fills `to` with those from `at` on, which are there; false where they cannot be had.
    virtual bool read(std::uint64_t at, std::span<char> to) = 0;
    /// Puts `from` at `at`. What fails is kept for `error`.
    virtual void write(std::uint64_t at, std::span<const char> from) = 0;
    /// They are so many: what is beyond goes, what is missing is 0.
    virtual void resize(std::uint64_t size) = 0;
    /// Why a byte could not be written, the first time; HDF5 never hears of it, since it keeps a
    /// file open that it cannot write.
    std::error_code error() const { return error_; }

  protected:
    void fail(std::error_code error) {
        if (!error_) error_ = error;
    }
    bool failed() const { return static_cast<bool>(error_); }

  private:
    std::error_code error_;
};

/// Of bytes that others hold, to be read.
std::unique_ptr<Storage> stored_in(std::string_view bytes);
/// Of a string that grows as it is written; it must outlive the storage. `expected`: about how many
/// bytes it will have.
std::unique_ptr<Storage> stored_in(std::string& bytes, std::size_t expected);
/// Of an open regular file, which others close: by its descriptor.
std::unique_ptr<Storage> stored_in(int file);

/// A property list with which H5Fcreate and H5Fopen take a storage for the file, whatever name they
/// are given. Must outlive the file; a file that HDF5 cannot close has nothing from then on.
class StorageAccess {
  public:
    /// `storage` must outlive it. HDF5 must be locked (`hdf5_lock`).
    explicit StorageAccess(Storage& storage);
    ~StorageAccess();
    StorageAccess(const StorageAccess&) = delete;
    StorageAccess& operator=(const StorageAccess&) = delete;
    /// Negative where memory did not suffice.
    operator hid_t() const { return list_; }

    /// What an open file holds of it.
    struct Lease {
        Storage* storage;  // null: it has ended
    };

  private:
    std::shared_ptr<Lease> lease_;
    hid_t list_;
};

}  // namespace beltgrinding::hdf5

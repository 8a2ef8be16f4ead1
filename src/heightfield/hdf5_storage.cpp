#include "heightfield/hdf5_storage.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

#include "base/large_memory.h"

namespace beltgrinding::hdf5 {
namespace {

std::error_code last_error() {
    return {errno, std::generic_category()};
}

class View final : public Storage {
  public:
    explicit View(std::string_view bytes) : bytes_(bytes) {}
    std::uint64_t size() const override { return bytes_.size(); }
    bool read(std::uint64_t at, std::span<char> to) override {
        std::copy_n(bytes_.data() + at, to.size(), to.data());
        return true;
    }
    void write(std::uint64_t /*at*/, std::span<const char> /*from*/) override {
        fail(std::make_error_code(std::errc::read_only_file_system));
    }
    void resize(std::uint64_t /*size*/) override {
        fail(std::make_error_code(std::errc::read_only_file_system));
    }

  private:
    std::string_view bytes_;
};

class Memory final : public Storage {
  public:
    Memory(std::string& bytes, std::size_t expected) : bytes_(bytes) {
        bytes_.clear();
        bytes_.reserve(expected);
        expect_large_use(bytes_.data(), bytes_.capacity());
    }
    std::uint64_t size() const override { return bytes_.size(); }
    bool read(std::uint64_t at, std::span<char> to) override { return View(bytes_).read(at, to); }
    void write(std::uint64_t at, std::span<const char> from) override {
        if (failed()) return;
        if (at + from.size() > bytes_.size()) resize(at + from.size());
        if (!failed()) std::copy(from.begin(), from.end(), bytes_.data() + at);
    }
    void resize(std::uint64_t size) override {
        if (failed()) return;
        try {  // HDF5, which is C, calls
            bytes_.resize(size);
        } catch (const std::exception&) {
            fail(std::make_error_code(std::errc::not_enough_memory));
        }
    }

  private:
    std::string& bytes_;
};

class File final : public Storage {
  public:
    explicit File(int file) : file_(file) {
        struct stat about {};
        if (::fstat(file_, &about) == 0) size_ = static_cast<std::uint64_t>(about.st_size);
    }
    std::uint64_t size() const override { return size_; }
    bool read(std::uint64_t at, std::span<char> to) override {
        while (!to.empty()) {
            const ssize_t n = ::pread(file_, to.data(), to.size(), static_cast<off_t>(at));
            if (n == 0 || (n < 0 && errno != EINTR)) return false;
            if (n < 0) continue;
            to = to.subspan(static_cast<std::size_t>(n));
            at += static_cast<std::uint64_t>(n);
        }
        return true;
    }
    void write(std::uint64_t at, std::span<const char> from) override {
        while (!from.empty() && !failed()) {
            const ssize_t n = ::pwrite(file_, from.data(), from.size(), static_cast<off_t>(at));
            if (n == 0) fail(std::make_error_code(std::errc::io_error));
            if (n < 0 && errno != EINTR) fail(last_error());
            if (n <= 0) continue;
            from = from.subspan(static_cast<std::size_t>(n));
            at += static_cast<std::uint64_t>(n);
        }
        size_ = std::max(size_, at);
    }
    void resize(std::uint64_t size) override {
        if (failed() || size == size_) return;
        if (::ftruncate(file_, static_cast<off_t>(size)) != 0) fail(last_error());
        size_ = size;
    }

  private:
    int file_;
    std::uint64_t size_ = 0;
};

}  // namespace

std::unique_ptr<Storage> stored_in(std::string_view bytes) {
    return std::make_unique<View>(bytes);
}

std::unique_ptr<Storage> stored_in(std::string& bytes, std::size_t expected) {
    return std::make_unique<Memory>(bytes, expected);
}

std::unique_ptr<Storage> stored_in(int file) {
    return std::make_unique<File>(file);
}

}  // namespace beltgrinding::hdf5

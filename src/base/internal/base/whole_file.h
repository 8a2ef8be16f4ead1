#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>

namespace beltgrinding {

/// Writes a file's bytes to its descriptor, of a file that is empty; returns why it failed.
using FileWriter = std::function<std::error_code(int)>;

/// Writes a file whole or not at all, and onto the disk: under another name beside it, which it
/// then changes for `path`. What was there before stays as it was when anything fails or `write`
/// throws, and nothing of the new is left. Every call of the system is checked. A link stays one,
/// and so does a pipe or a device (std::errc::invalid_argument). Returns why it failed.
std::error_code write_whole(const std::string& path, const FileWriter& write);
std::error_code write_whole(const std::string& path, std::string_view bytes);

/// All of `bytes` to an open file, where that stands. Returns why it failed.
std::error_code write_all(int file, std::string_view bytes);

/// A regular file that is open to be read.
class RegularFile {
  public:
    RegularFile() = default;
    ~RegularFile();
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;
    /// Once. A pipe or a device, which may have no end, is std::errc::invalid_argument. Returns why
    /// it failed.
    std::error_code open(const std::string& path);
    /// Its descriptor.
    int number() const { return number_; }
    /// Bytes, when it was opened.
    std::uint64_t size() const { return size_; }

  private:
    int number_ = -1;
    std::uint64_t size_ = 0;
};

/// The bytes of a `RegularFile` into `bytes`. Returns why it failed.
std::error_code read_whole(const std::string& path, std::string& bytes);

}  // namespace beltgrinding

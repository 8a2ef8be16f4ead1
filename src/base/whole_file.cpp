#include "base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace beltgrinding {
namespace {

class File {
  public:
    File(const std::string& path, int flags) : number_(::open(path.c_str(), flags, 0666)) {}
    ~File() {
        if (number_ >= 0) ::close(number_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    operator int() const { return number_; }
    /// A file system may keep what it could not write for the last call: this one.
    bool close() { return ::close(std::exchange(number_, -1)) == 0; }

  private:
    int number_;
};

std::error_code last_error() {
    return {errno, std::generic_category()};
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "./" : path.substr(0, slash + 1);
}

std::error_code write_new(const std::string& path, const FileWriter& write) {
    // Read, too: a writer may look at what it wrote.
    File file(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC);
    if (file < 0) return last_error();
    if (const std::error_code error = write(file)) return error;
    if (::fsync(file) != 0 || !file.close()) return last_error();
    return {};
}

/// The name of a file that is not whole yet, which goes with it if it is still there.
class Part {
  public:
    explicit Part(std::string path) : path_(std::move(path)) {
        ::unlink(path_.c_str());  // of a killed process that had our number
    }
    ~Part() { ::unlink(path_.c_str()); }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace

std::error_code write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file, bytes.data(), bytes.size());
        if (n < 0 && errno != EINTR) return last_error();
        if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return {};
}

std::error_code write_whole(const std::string& name, const FileWriter& write) {
    static std::atomic<unsigned> writes{0};
    std::string path = name;
    struct stat about {};
    if (::stat(name.c_str(), &about) == 0) {
        if (S_ISDIR(about.st_mode)) return std::make_error_code(std::errc::is_a_directory);
        // Nothing may take the place of a pipe or a device.
        if (!S_ISREG(about.st_mode)) return std::make_error_code(std::errc::invalid_argument);
        std::error_code error;
        path = std::filesystem::canonical(name, error).string();  // a link stays one
        if (error) return error;
    }
    const std::string folder = folder_of(path);
    {
        // Not `path` and more: that may be too long a name.
        const Part part(folder + ".beltgrind-part-" + std::to_string(::getpid()) + "-" +
                        std::to_string(writes++));
        if (const std::error_code error = write_new(part.path(), write)) return error;
        if (std::rename(part.path().c_str(), path.c_str()) != 0) return last_error();
    }
    // The name, too, or a power cut could bring the old one back. Some file systems know no such
    // thing; the file is whole all the same.
    const File entries(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (entries >= 0) ::fsync(entries);
    return {};
}

std::error_code write_whole(const std::string& path, std::string_view bytes) {
    return write_whole(path, [bytes](int file) { return write_all(file, bytes); });
}

RegularFile::~RegularFile() {
    if (number_ >= 0) ::close(number_);
}

std::error_code RegularFile::open(const std::string& path) {
    // Not blocking: nobody may ever write into a pipe.
    number_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (number_ < 0) return last_error();
    struct stat about {};
    if (::fstat(number_, &about) != 0) return last_error();
    if (S_ISDIR(about.st_mode)) return std::make_error_code(std::errc::is_a_directory);
    if (!S_ISREG(about.st_mode)) return std::make_error_code(std::errc::invalid_argument);
    size_ = static_cast<std::uint64_t>(about.st_size);
    return {};
}

std::error_code read_whole(const std::string& path, std::string& bytes) {
    RegularFile file;
    if (const std::error_code error = file.open(path)) return error;
    bytes.clear();
    bytes.resize(file.size());
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::read(file.number(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno != EINTR) return last_error();
        if (n == 0) break;  // it was cut meanwhile
        if (n > 0) done += static_cast<std::size_t>(n);
    }
    bytes.resize(done);
    return {};
}

}  // namespace beltgrinding

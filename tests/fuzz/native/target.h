#pragma once

// What the fuzz targets share. Each defines LLVMFuzzerTestOneInput, which libFuzzer calls (the
// preset `fuzz`), or replay.cpp (every build).

#include <fcntl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

constexpr int kBroken = 77;  ///< exit status

/// What must hold whatever the bytes. With TARGET_LIBRARY an abort is a library's.
inline void must(bool holds) {
    if (holds) return;
#ifdef TARGET_LIBRARY
    _exit(kBroken);
#else
    std::abort();
#endif
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// A file in memory with these bytes; its path ends in `suffix`.
inline const std::string& as_file(const std::uint8_t* data, std::size_t size, const char* suffix) {
    static const struct File {
        explicit File(const char* suffix_)
            : path("/dev/shm/beltgrinding-fuzz-" + std::to_string(getpid()) + suffix_) {}
        ~File() { unlink(path.c_str()); }
        std::string path;
    } file(suffix);
    const int to = open(file.path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    must(to >= 0 && write(to, data, size) == ssize_t(size));
    close(to);
    return file.path;
}

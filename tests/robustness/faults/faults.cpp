// Preloaded by fault_injection.py: lets the n-th call of the file system, or the n-th allocation of
// our own code, fail once, or kills the process there. What is not armed passes through.

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>

namespace {

constexpr long kOff = -1;
std::atomic<long> g_files_left{kOff}, g_files_seen{0};
std::atomic<long> g_memory_left{kOff}, g_memory_seen{0};
int g_error = EIO;
bool g_kill = false;
std::uintptr_t g_begin = 0, g_end = 0;  // of our own code

bool file_fails() {
    if (g_files_left.load() == kOff) return false;
    ++g_files_seen;
    if (g_files_left.fetch_sub(1) != 0) return false;
    g_files_left = kOff;
    if (g_kill) kill(getpid(), SIGKILL);
    errno = g_error;
    return true;
}

bool memory_fails(const void* caller) {
    const auto at = reinterpret_cast<std::uintptr_t>(caller);
    if (at < g_begin || at >= g_end || g_memory_left.load() == kOff) return false;
    ++g_memory_seen;
    if (g_memory_left.fetch_sub(1) != 0) return false;
    g_memory_left = kOff;
    return true;
}

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

extern "C" void* __libc_malloc(std::size_t);
extern "C" void* __libc_calloc(std::size_t, std::size_t);
extern "C" void* __libc_realloc(void*, std::size_t);

}  // namespace

#define REAL(name) static const auto real = next<decltype(&name)>(#name)
#define FILE_CALL(name, parameters, arguments)     \
    extern "C" int name parameters {               \
        REAL(name);                                \
        return file_fails() ? -1 : real arguments; \
    }

FILE_CALL(rename, (const char* a, const char* b) noexcept, (a, b))
FILE_CALL(renameat, (int f, const char* a, int g, const char* b) noexcept, (f, a, g, b))
FILE_CALL(renameat2, (int f, const char* a, int g, const char* b, unsigned flags) noexcept,
          (f, a, g, b, flags))
FILE_CALL(link, (const char* a, const char* b) noexcept, (a, b))
FILE_CALL(linkat, (int f, const char* a, int g, const char* b, int flags) noexcept,
          (f, a, g, b, flags))
FILE_CALL(mkdir, (const char* a, mode_t mode) noexcept, (a, mode))
FILE_CALL(mkdirat, (int f, const char* a, mode_t mode) noexcept, (f, a, mode))
FILE_CALL(unlink, (const char* a) noexcept, (a))
FILE_CALL(unlinkat, (int f, const char* a, int flags) noexcept, (f, a, flags))
FILE_CALL(rmdir, (const char* a) noexcept, (a))
FILE_CALL(chmod, (const char* a, mode_t mode) noexcept, (a, mode))
FILE_CALL(flock, (int f, int kind) noexcept, (f, kind))
FILE_CALL(fsync, (int f), (f))

extern "C" ssize_t write(int f, const void* data, std::size_t size) {
    REAL(write);
    return file_fails() ? -1 : real(f, data, size);
}

#define PWRITE(name)                                                               \
    extern "C" ssize_t name(int f, const void* data, std::size_t size, off_t at) { \
        REAL(name);                                                                \
        return file_fails() ? -1 : real(f, data, size, at);                        \
    }
PWRITE(pwrite)
PWRITE(pwrite64)
FILE_CALL(ftruncate, (int f, off_t size) noexcept, (f, size))
FILE_CALL(ftruncate64, (int f, off_t size) noexcept, (f, size))

extern "C" int close(int f) {
    REAL(close);
    const int done = real(f);  // it is closed, as the system does it, too
    return file_fails() ? -1 : done;
}

#define OPEN(name)                                                \
    extern "C" int name(const char* path, int flags, ...) {       \
        REAL(name);                                               \
        va_list more;                                             \
        va_start(more, flags);                                    \
        const auto mode = static_cast<mode_t>(va_arg(more, int)); \
        va_end(more);                                             \
        return file_fails() ? -1 : real(path, flags, mode);       \
    }
OPEN(open)
OPEN(open64)

extern "C" void* malloc(std::size_t size) {
    return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size);
}
extern "C" void* calloc(std::size_t count, std::size_t size) {
    return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_calloc(count, size);
}
extern "C" void* realloc(void* old, std::size_t size) {
    return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_realloc(old, size);
}
void* operator new(std::size_t size) {
    void* found =
        memory_fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size ? size : 1);
    if (!found) throw std::bad_alloc();
    return found;
}
void* operator new[](std::size_t size) {
    void* found =
        memory_fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size ? size : 1);
    if (!found) throw std::bad_alloc();
    return found;
}
void operator delete(void* p) noexcept {
    std::free(p);
}
void operator delete[](void* p) noexcept {
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
    std::free(p);
}

extern "C" {
/// The call number `nth` of the file system from now on, from 0, fails with `error`, or is the last
/// of the process. Negative: none.
void fault_files(long nth, int error, int kills) {
    g_error = error;
    g_kill = kills != 0;
    g_files_seen = 0;
    g_files_left = nth;
}
/// Calls of the file system since then, the one that failed included.
long fault_files_seen() {
    return g_files_seen;
}
/// Likewise the allocations whose caller lies in [begin, end).
void fault_memory(long nth, std::uintptr_t begin, std::uintptr_t end) {
    g_begin = begin;
    g_end = end;
    g_memory_seen = 0;
    g_memory_left = nth;
}
long fault_memory_seen() {
    return g_memory_seen;
}
}

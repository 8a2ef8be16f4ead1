#include "foreign/file_check.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

[[noreturn]] void refuse(const std::string& path, int error) {
    if (error == EACCES || error == EPERM)
        throw InputError("foreign.no_permission",
                         "{file}: permission denied: it, or a folder on the way to it, may not be "
                         "read by this user",
                         {{"file", path}});
    throw InputError("foreign.not_opened", "{file}: cannot be opened: {reason}",
                     {{"file", path}, {"reason", std::generic_category().message(error)}});
}

}  // namespace

bool is_readable_file(const std::string& path) {
    struct stat found {};
    if (stat(path.c_str(), &found) != 0) {
        if (errno == ENOENT || errno == ENOTDIR) return false;
        refuse(path, errno);
    }
    if (S_ISDIR(found.st_mode))
        throw InputError("foreign.folder", "{file}: is a folder; name a file in it",
                         {{"file", path}});
    if (!S_ISREG(found.st_mode))
        throw InputError("foreign.no_file", "{file}: is no file, but a pipe, a socket or a device",
                         {{"file", path}});
    const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (opened < 0) refuse(path, errno);
    close(opened);
    if (found.st_size == 0)
        throw InputError("foreign.empty", "{file}: is empty; export it again", {{"file", path}});
    return true;
}

}  // namespace beltgrinding

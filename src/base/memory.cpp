#include "base/memory.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>

namespace beltgrinding {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/// The number that a file of one line holds; none: no such file, or "max".
std::optional<std::size_t> number_in(const fs::path& path) {
    std::ifstream file(path);
    std::string word;
    if (!(file >> word)) return std::nullopt;
    std::size_t value = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || stop != end) return std::nullopt;
    return value;
}

/// The least limit of a group and of those around it.
std::size_t limit_of_groups(const fs::path& mounted, std::string_view group, const char* name) {
    std::size_t least = kUnlimited;
    // In a container the group's path may be the host's, and its files lie at the mount itself.
    for (fs::path at = fs::path(group).relative_path();; at = at.parent_path()) {
        least = std::min(least, number_in(mounted / at / name).value_or(kUnlimited));
        if (at.empty()) return least;
    }
}

/// Whether "cpu,memory" and the like names the memory.
bool lists_memory(std::string_view kinds) {
    for (;;) {
        const std::size_t comma = kinds.find(',');
        if (kinds.substr(0, comma) == "memory") return true;
        if (comma == std::string_view::npos) return false;
        kinds.remove_prefix(comma + 1);
    }
}

std::size_t available(const std::string& root) {
    std::ifstream file(root + "/proc/meminfo");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string name;
        std::size_t kibibytes = 0;
        if (words >> name >> kibibytes && name == "MemAvailable:") return kibibytes * 1024;
    }
    return std::size_t(sysconf(_SC_PHYS_PAGES)) * std::size_t(sysconf(_SC_PAGE_SIZE));
}

}  // namespace

std::size_t usable_memory(const std::string& root) {
    std::size_t least = available(root);
    std::ifstream file(root + "/proc/self/cgroup");
    const fs::path mounted = root + "/sys/fs/cgroup";
    for (std::string line; std::getline(file, line);) {  // "4:cpu,memory:/a/b", "0::/a/b"
        const auto first = line.find(':');
        const auto second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string_view whole = line;
        const std::string_view kinds = whole.substr(first + 1, second - first - 1);
        const std::string_view group = whole.substr(second + 1);
        const bool version_2 = kinds.empty();
        if (!version_2 && !lists_memory(kinds)) continue;
        // Beside each of several kinds of one mount there is a link of its name.
        least =
            std::min(least, limit_of_groups(version_2 ? mounted : mounted / "memory", group,
                                            version_2 ? "memory.max" : "memory.limit_in_bytes"));
    }
    return least;
}

}  // namespace beltgrinding

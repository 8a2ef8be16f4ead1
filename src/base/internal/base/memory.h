#pragma once

#include <cstddef>
#include <string>

namespace beltgrinding {

/// What this process may still use, bytes: the least of what the machine has available and of the
/// limits of the control groups that it is in (a container's), version 2 (memory.max) and 1
/// (memory.limit_in_bytes). `root`: where /proc and /sys stand, for tests.
std::size_t usable_memory(const std::string& root = "");

}  // namespace beltgrinding

#pragma once

#include <string>

namespace beltgrinding {

/// False if there is no such file. Throws InputError naming it for what no file of any format is: a
/// folder, a pipe or a device, one that this user may not read or that cannot be opened, one that
/// is empty.
bool is_readable_file(const std::string& path);

}  // namespace beltgrinding

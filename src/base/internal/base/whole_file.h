#pragma once

#include <string>
#include <string_view>
#include <system_error>

namespace beltgrinding {

/// Writes a file whole or not at all, and onto the disk: under another name beside it, which it
/// then changes for `path`. What was there before stays as it was when anything fails, and nothing
/// of the new is left. Every call of the system is checked. A link stays one, and so does a pipe or
/// a device (std::errc::invalid_argument). Returns why it failed.
std::error_code write_whole(const std::string& path, std::string_view bytes);

/// The bytes of a regular file into `bytes`. A pipe or a device, which may have no end, is
/// std::errc::invalid_argument. Returns why it failed.
std::error_code read_whole(const std::string& path, std::string& bytes);

}  // namespace beltgrinding

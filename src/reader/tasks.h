#pragma once

// Private to this room: what the reader of foreign files does.

#include <optional>
#include <string>
#include <string_view>

namespace beltgrinding {

/// The bytes that answer a task (ReaderRequest). None for a task that this build does not know.
/// Throws InputError, and whatever the libraries throw: an exception of type std::exception, or
/// std::bad_alloc where memory did not suffice.
std::optional<std::string> do_task(std::string_view task, const std::string& path,
                                   const std::string& input);

/// STEP, IGES, BREP; TRIANGULATE, FACES.
std::optional<std::string> do_shape_task(std::string_view task, const std::string& path,
                                         const std::string& input);

/// MESH (by assimp), 3MF, WRITE-3MF.
std::optional<std::string> do_mesh_task(std::string_view task, const std::string& path,
                                        const std::string& input);

}  // namespace beltgrinding

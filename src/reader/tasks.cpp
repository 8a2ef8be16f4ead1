#include "tasks.h"

namespace beltgrinding {

std::optional<std::string> do_task(std::string_view task, const std::string& path,
                                   const std::string& input) {
    if (auto answer = do_shape_task(task, path, input)) return answer;
    return do_mesh_task(task, path, input);
}

}  // namespace beltgrinding

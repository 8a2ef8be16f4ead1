#pragma once

#include <tbb/global_control.h>

#include <cstddef>
#include <optional>

namespace beltgrinding {

/// Lets all computations of this process that begin from now on use at most `count` threads; 0: as
/// many as the machine has. The results are the same with any number. Not thread-safe.
inline void set_threads(std::size_t count) {
    // What limits is the object's life; the old limit must be gone before a higher one can hold.
    static std::optional<tbb::global_control> limit;
    limit.reset();
    if (count > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, count);
}

/// The number of threads that a computation may use.
inline std::size_t threads() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

}  // namespace beltgrinding

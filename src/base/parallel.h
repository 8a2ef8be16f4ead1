#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <cstddef>

#include "base/run_context.h"

namespace beltgrinding {

/// Calls `body(begin, end)` for consecutive blocks of [0, count) on all threads. The blocks' bounds
/// depend on `count` and `block` only, never on the number of threads: a body that writes to its
/// own block, or to a slot of its own block number, gives the same bits on any machine. Throws
/// `Cancelled` if `context` was cancelled; progress is not reported.
template <class Body>
void parallel_blocks(std::size_t count, std::size_t block, const RunContext& context, Body&& body) {
    const std::size_t blocks = (count + block - 1) / block;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t b = range.begin(); b != range.end(); ++b) {
                if (context.cancelled()) return;
                const std::size_t begin = b * block;
                const std::size_t end = begin + block < count ? begin + block : count;
                body(begin, end);
            }
        },
        tbb::simple_partitioner());
    context.throw_if_cancelled();
}

}  // namespace beltgrinding

#pragma once

#include <cstddef>

#include "beltgrinding/run_context.h"

#ifdef __SANITIZE_THREAD__
#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/partitioner.h>
#endif

namespace beltgrinding {

#ifdef __SANITIZE_THREAD__
// The thread sanitizer does not see how TBB, which is not built with it, orders its tasks. What it
// is to judge is our own sharing: plain threads show it.
namespace detail {

template <class Body>
void on_threads(std::size_t blocks, Body&& body) {
    constexpr std::size_t kThreads = 3;
    std::atomic<std::size_t> next{0};
    std::vector<std::exception_ptr> thrown(kThreads);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t) {
        threads.emplace_back([&, t] {
            try {
                for (std::size_t b = next++; b < blocks; b = next++) body(b);
            } catch (...) {
                thrown[t] = std::current_exception();
                next = blocks;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& one : thrown)
        if (one) std::rethrow_exception(one);
}

}  // namespace detail
#endif

/// Calls `body(begin, end)` for consecutive blocks of [0, count) on all threads. The blocks' bounds
/// depend on `count` and `block` only, never on the number of threads: a body that writes to its
/// own block, or to a slot of its own block number, gives the same bits on any machine. Throws
/// `Cancelled` if `context` was cancelled; progress is not reported.
template <class Body>
void parallel_blocks(std::size_t count, std::size_t block, const RunContext& context, Body&& body) {
    const std::size_t blocks = (count + block - 1) / block;
    const auto one = [&](std::size_t b) {
        if (context.cancelled()) return;
        const std::size_t begin = b * block;
        const std::size_t end = begin + block < count ? begin + block : count;
        body(begin, end);
    };
#ifdef __SANITIZE_THREAD__
    detail::on_threads(blocks, one);
#else
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t b = range.begin(); b != range.end(); ++b) one(b);
        },
        tbb::simple_partitioner());
#endif
    context.throw_if_cancelled();
}

/// Sorts what is never equal, so that the order is the same on any number of threads.
template <class Values>
void parallel_sort(Values& values) {
#ifdef __SANITIZE_THREAD__
    std::sort(values.begin(), values.end());
#else
    tbb::parallel_sort(values.begin(), values.end());
#endif
}

/// Does both, side by side where a thread is free.
template <class First, class Second>
void parallel_both(First&& first, Second&& second) {
#ifdef __SANITIZE_THREAD__
    detail::on_threads(2, [&](std::size_t b) { b == 0 ? first() : second(); });
#else
    tbb::parallel_invoke(first, second);
#endif
}

}  // namespace beltgrinding

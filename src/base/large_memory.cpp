#include "base/large_memory.h"

#include <sys/mman.h>

#include <cstdint>

namespace beltgrinding {
namespace {

constexpr std::uintptr_t kPage = 2U << 20U;  // bytes, of a large page of x86-64 and most others
constexpr std::size_t kWorthwhile = 2 * kPage;

}  // namespace

void expect_large_use([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    if (bytes < kWorthwhile) return;
    const auto at = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t begin = (at + kPage - 1) / kPage * kPage;
    const std::uintptr_t end = (at + bytes) / kPage * kPage;
    if (begin < end) (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

}  // namespace beltgrinding

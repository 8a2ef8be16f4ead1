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
    const std::uintptr_t skipped = -reinterpret_cast<std::uintptr_t>(memory) % kPage;
    const std::size_t length = (bytes - skipped) / kPage * kPage;  // a page at least
    (void)madvise(static_cast<char*>(memory) + skipped, length, MADV_HUGEPAGE);
#endif
}

}  // namespace beltgrinding

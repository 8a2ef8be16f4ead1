#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace beltgrinding {

/// Asks the system for large pages under memory that is about to be filled: each page's first use
/// costs the same, and walks over millions of samples miss fewer addresses. A hint; small blocks,
/// and systems without it, stay as they are.
void expect_large_use(void* memory, std::size_t bytes);

template <class T>
void reserve_large(std::vector<T>& values, std::size_t count) {
    if (count <= values.capacity()) return;
    values.reserve(count);
    expect_large_use(values.data(), values.capacity() * sizeof(T));
}

template <class T>
void resize_large(std::vector<T>& values, std::size_t count) {
    reserve_large(values, count);
    values.resize(count);
}

/// Not filled.
template <class T>
std::unique_ptr<T[]> make_large(std::size_t count) {
    auto made = std::make_unique_for_overwrite<T[]>(count);
    expect_large_use(made.get(), count * sizeof(T));
    return made;
}

}  // namespace beltgrinding

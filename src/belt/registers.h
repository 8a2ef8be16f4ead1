#pragma once

// Numbers side by side in registers, by GCC's and Clang's own types; and whether functions can be
// cloned for processors: GCC's spelling, which Clang does not read, and the sanitizers are not yet
// there when the loader chooses between clones.
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define BELTGRINDING_CLONES
#endif

namespace beltgrinding {

using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));

/// The same in memory, from any number on.
template <class Register>
struct InMemory;
template <>
struct InMemory<Four> {
    using Type = double __attribute__((vector_size(32), aligned(8), may_alias));
};
template <>
struct InMemory<Eight> {
    using Type = double __attribute__((vector_size(64), aligned(8), may_alias));
};

// In place of memcpy, of which GCC makes one out of several in a row, by way of the stack.
template <class Register>
[[gnu::always_inline]] inline const auto& read(const double* from) {
    return *static_cast<const typename InMemory<Register>::Type*>(static_cast<const void*>(from));
}
template <class Register>
[[gnu::always_inline]] inline auto& write(double* to) {
    return *static_cast<typename InMemory<Register>::Type*>(static_cast<void*>(to));
}

}  // namespace beltgrinding

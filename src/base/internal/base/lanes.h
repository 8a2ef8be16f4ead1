#pragma once

// Eight values at a time, by the compiler's vectors. All is inlined, so that a function made for
// several processors (BELTGRINDING_CLONES) has it made for each; every lane does the same
// operations in the same order whatever the processor has: all give the same bits.

#include <cstdint>

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Chosen when the program is loaded. AVX2 without fused operations: those round once in place of
// twice.
#define BELTGRINDING_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define BELTGRINDING_CLONES
#endif
#define BELTGRINDING_INLINE inline __attribute__((always_inline))
#pragma GCC diagnostic ignored "-Wpsabi"  // no vector is passed to a function that is not inlined

namespace beltgrinding::lanes {

constexpr int kWide = 8;
using Floats = float __attribute__((vector_size(4 * kWide)));
using Ints = std::int32_t __attribute__((vector_size(4 * kWide)));
using Doubles = double __attribute__((vector_size(8 * kWide)));
using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

BELTGRINDING_INLINE Floats all(float value) {
    return Floats{} + value;
}
BELTGRINDING_INLINE Floats load(const float* from) {
    Floats values;
    __builtin_memcpy(&values, from, sizeof values);
    return values;
}
BELTGRINDING_INLINE Ints load(const std::int32_t* from) {
    Ints values;
    __builtin_memcpy(&values, from, sizeof values);
    return values;
}
BELTGRINDING_INLINE Ints load(const std::uint32_t* from) {
    Ints values;
    __builtin_memcpy(&values, from, sizeof values);
    return values;
}
BELTGRINDING_INLINE Doubles load_doubles(const double* from) {
    Doubles values;
    __builtin_memcpy(&values, from, sizeof values);
    return values;
}
BELTGRINDING_INLINE Floats load(const double* from) {
    return __builtin_convertvector(load_doubles(from), Floats);
}
BELTGRINDING_INLINE void store(float* to, const Floats& values) {
    __builtin_memcpy(to, &values, sizeof values);
}
BELTGRINDING_INLINE void store(std::int32_t* to, const Ints& values) {
    __builtin_memcpy(to, &values, sizeof values);
}
BELTGRINDING_INLINE void store(std::uint32_t* to, const Ints& values) {
    __builtin_memcpy(to, &values, sizeof values);
}
BELTGRINDING_INLINE Floats smaller(const Floats& a, const Floats& b) {
    return a < b ? a : b;
}
BELTGRINDING_INLINE Floats larger(const Floats& a, const Floats& b) {
    return a > b ? a : b;
}
BELTGRINDING_INLINE Floats magnitude(const Floats& a) {
    return reinterpret_cast<Floats>(reinterpret_cast<Ints>(a) & 0x7FFFFFFF);
}
BELTGRINDING_INLINE Floats kept(const Floats& a, const Ints& mask) {
    return reinterpret_cast<Floats>(reinterpret_cast<Ints>(a) & mask);
}
BELTGRINDING_INLINE Floats root(const Floats& a) {
    alignas(32) float values[kWide];
    store(values, a);
    for (float& value : values) value = __builtin_sqrtf(value);
    return load(values);
}
/// One bit a lane.
BELTGRINDING_INLINE std::uint64_t bits(const Ints& mask) {
    Ints one = mask & Ints{1, 2, 4, 8, 16, 32, 64, 128};
    one |= __builtin_shufflevector(one, one, 4, 5, 6, 7, 0, 1, 2, 3);
    one |= __builtin_shufflevector(one, one, 2, 3, 0, 1, 6, 7, 4, 5);
    one |= __builtin_shufflevector(one, one, 1, 0, 3, 2, 5, 4, 7, 6);
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(one[0]));
}
BELTGRINDING_INLINE Ints mask_of(std::uint64_t lanes, int first) {
    const Ints one = Ints{1, 2, 4, 8, 16, 32, 64, 128};
    const auto eight = static_cast<std::int32_t>((lanes >> first) & 0xFFU);
    return (one & eight) == one;
}

}  // namespace beltgrinding::lanes

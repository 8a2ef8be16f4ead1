#pragma once

// What the reader of foreign files answers, byte for byte. Host and reader are of one build, on one
// machine.

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "beltgrinding/error.h"

namespace beltgrinding {

/// The file descriptor on which the reader gives its answer.
constexpr int kAnswerDescriptor = 3;

enum class AnswerKind : std::uint32_t {
    kDone,     ///< what was asked for follows
    kRefused,  ///< an InputError follows (pack_error)
    kMemory,   ///< it did not suffice
    kSignal,   ///< `signal` came: a library followed a pointer into nowhere, or gave up
};

struct AnswerHead {
    std::array<char, 8> magic{'b', 'g', '-', 'c', 'a', 'd', '-', '1'};
    AnswerKind kind = AnswerKind::kDone;
    std::int32_t signal = 0;
    std::uint64_t size = 0;   ///< of what follows, bytes
    std::uint64_t check = 0;  ///< answer_check of it
};

/// FNV-1a. Half an answer, or another program's, must not be taken for a whole one.
inline std::uint64_t answer_check(std::string_view bytes) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    return hash;
}

/// Appends a number's bytes.
template <class T>
void put_bytes(std::string& bytes, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Takes a number off the front; false where the bytes end before.
template <class T>
[[nodiscard]] bool take_bytes(std::string_view& bytes, T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes.size() < sizeof value) return false;
    std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof value);
    bytes.remove_prefix(sizeof value);
    return true;
}

/// An error as bytes.
std::string pack_error(const InputError& error);

/// What `pack_error` packed; none if the bytes are not an error's.
std::optional<InputError> unpack_error(std::string_view bytes);

}  // namespace beltgrinding

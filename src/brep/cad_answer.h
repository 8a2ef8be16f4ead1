#pragma once

// Private to this room: what the reader of CAD files answers, byte for byte. Host and reader are of
// one build, on one machine.

#include <array>
#include <cstdint>
#include <string_view>

namespace beltgrinding {

enum class CadAnswerKind : std::uint32_t {
    kShape,       ///< CadFacts and pack_shape's bytes follow
    kUnreadable,  ///< not of the format
    kNullShape,   ///< of the format, but nothing in it
    kFailure,     ///< OpenCASCADE's words follow
    kMemory,      ///< it did not suffice
    kSignal,      ///< `signal` came: OpenCASCADE followed a pointer into nowhere
};

struct CadAnswerHead {
    std::array<char, 8> magic{'b', 'g', '-', 'c', 'a', 'd', '-', '1'};
    CadAnswerKind kind = CadAnswerKind::kShape;
    std::int32_t signal = 0;
    std::uint64_t size = 0;   ///< of what follows, bytes
    std::uint64_t check = 0;  ///< cad_answer_check of it
};

/// What is known of a shape before its bytes.
struct CadFacts {
    std::array<double, 6> extents{};  ///< mm, least then greatest x, y, z
    std::uint32_t valid = 0;
    std::uint32_t meshed = 0;  ///< 0: no extents
};

/// FNV-1a. Half an answer, or another program's, must not reach OpenCASCADE.
inline std::uint64_t cad_answer_check(std::string_view bytes) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    return hash;
}

}  // namespace beltgrinding

#pragma once

// Private to this room: the header of a PLY (Turk 1994).

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beltgrinding::ply {

enum class Format { kAscii, kLittleEndian, kBigEndian };
enum class Number { kInt8, kUInt8, kInt16, kUInt16, kInt32, kUInt32, kFloat, kDouble };

struct Property {
    std::string name;
    Number number = Number::kFloat;
    bool list = false;
    Number count = Number::kUInt8;
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Format format = Format::kAscii;
    std::vector<Element> elements;
    std::size_t end = 0;  ///< where the body begins
};

/// A word of the file as a message can show it.
std::string shown(const std::string& word);

/// The header of a whole file's bytes. Throws InputError.
Header read_header(std::string_view data);

}  // namespace beltgrinding::ply

#include "ply_header.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>

#include "beltgrinding/error.h"

namespace beltgrinding::ply {
namespace {

const std::map<std::string, Number, std::less<>> kNumbers = {
    {"char", Number::kInt8},     {"int8", Number::kInt8},     {"uchar", Number::kUInt8},
    {"uint8", Number::kUInt8},   {"short", Number::kInt16},   {"int16", Number::kInt16},
    {"ushort", Number::kUInt16}, {"uint16", Number::kUInt16}, {"int", Number::kInt32},
    {"int32", Number::kInt32},   {"uint", Number::kUInt32},   {"uint32", Number::kUInt32},
    {"float", Number::kFloat},   {"float32", Number::kFloat}, {"double", Number::kDouble},
    {"float64", Number::kDouble}};

Number number_of(const std::string& word) {
    const auto found = kNumbers.find(word);
    if (found == kNumbers.end())
        throw InputError("ply.type", "unknown type '{word}' in its header",
                         {{"word", shown(word)}});
    return found->second;
}

std::size_t count_of(const std::string& word) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || end != word.data() + word.size()) {
        throw InputError("ply.count", "'{word}' in its header is no count",
                         {{"word", shown(word)}});
    }
    return count;
}

Format format_of(const std::string& word) {
    if (word == "ascii") return Format::kAscii;
    if (word == "binary_little_endian") return Format::kLittleEndian;
    if (word == "binary_big_endian") return Format::kBigEndian;
    throw InputError("ply.format", "unknown format '{word}'", {{"word", shown(word)}});
}

}  // namespace

std::string shown(const std::string& word) {
    constexpr std::size_t kShown = 20;
    std::string text = word.substr(0, kShown);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

Header read_header(std::string_view data) {
    Header header;
    bool formatted = false;
    for (std::size_t at = 0; at < data.size();) {
        const std::size_t end = data.find('\n', at);
        if (end == std::string_view::npos) break;
        std::istringstream line{std::string(data.substr(at, end - at))};
        const bool first = at == 0;
        at = end + 1;
        std::vector<std::string> words{std::istream_iterator<std::string>(line), {}};
        words.resize(std::max<std::size_t>(words.size(), 5));
        const std::string& key = words[0];
        if (first) {
            if (key != "ply") break;
        } else if (key == "format") {
            header.format = format_of(words[1]);
            formatted = true;
        } else if (key == "element") {
            header.elements.push_back({words[1], count_of(words[2]), {}});
        } else if (key == "property") {
            if (header.elements.empty())
                throw InputError("ply.property_without_element",
                                 "a property before the first element");
            Property property;
            property.list = words[1] == "list";
            if (property.list) property.count = number_of(words[2]);
            property.number = number_of(words[property.list ? 3 : 1]);
            property.name = words[property.list ? 4 : 2];
            header.elements.back().properties.push_back(property);
        } else if (key == "end_header") {
            if (!formatted) throw InputError("ply.no_format", "its header names no format");
            header.end = at;
            return header;
        } else if (!key.empty() && key != "comment" && key != "obj_info") {
            throw InputError("ply.keyword", "unknown word '{word}' in its header",
                             {{"word", shown(key)}});
        }
    }
    throw InputError("ply.no_header", "it has no PLY header");
}

}  // namespace beltgrinding::ply

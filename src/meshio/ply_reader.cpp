// Own code, because assimp crashes on every second damaged PLY, and rounds its doubles to floats.

#include "beltgrinding/mesh_reader.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string_view>

#include "beltgrinding/error.h"
#include "foreign/file_check.h"

namespace beltgrinding {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Format { kAscii, kLittleEndian, kBigEndian };
enum class Number { kInt8, kUInt8, kInt16, kUInt16, kInt32, kUInt32, kFloat, kDouble };

const std::map<std::string, Number, std::less<>> kNumbers = {
    {"char", Number::kInt8},     {"int8", Number::kInt8},     {"uchar", Number::kUInt8},
    {"uint8", Number::kUInt8},   {"short", Number::kInt16},   {"int16", Number::kInt16},
    {"ushort", Number::kUInt16}, {"uint16", Number::kUInt16}, {"int", Number::kInt32},
    {"int32", Number::kInt32},   {"uint", Number::kUInt32},   {"uint32", Number::kUInt32},
    {"float", Number::kFloat},   {"float32", Number::kFloat}, {"double", Number::kDouble},
    {"float64", Number::kDouble}};

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
std::string shown(const std::string& word) {
    constexpr std::size_t kShown = 20;
    std::string text = word.substr(0, kShown);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

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

const Fact kListLength{"ply.list_length", "a list's length is out of range", {}};
const Fact kVertexIndex{"ply.vertex_index", "a vertex index is out of range", {}};

/// The numbers of the body, one after the other. Throws InputError where the file ends.
class Body {
  public:
    Body(std::string_view data, Format format) : data_(data), format_(format) {}

    std::size_t left() const { return data_.size() - at_; }

    double next(Number number) {
        if (format_ == Format::kAscii) return next_word();
        switch (number) {
            case Number::kInt8:
                return next_binary<std::int8_t>();
            case Number::kUInt8:
                return next_binary<std::uint8_t>();
            case Number::kInt16:
                return next_binary<std::int16_t>();
            case Number::kUInt16:
                return next_binary<std::uint16_t>();
            case Number::kInt32:
                return next_binary<std::int32_t>();
            case Number::kUInt32:
                return next_binary<std::uint32_t>();
            case Number::kFloat:
                return next_binary<float>();
            case Number::kDouble:
                return next_binary<double>();
        }
        return 0.0;
    }

    /// A whole number from 0 to `limit`; else an InputError of `fault`.
    std::size_t next_index(Number number, std::size_t limit, const Fact& fault) {
        const double value = next(number);
        if (!(value >= 0.0) || value != std::floor(value) || value > static_cast<double>(limit)) {
            throw InputError(fault);
        }
        return static_cast<std::size_t>(value);
    }

  private:
    template <class T>
    double next_binary() {
        if (left() < sizeof(T))
            throw InputError("ply.cut_off", "it ends before its last vertex or face");
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), data_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        if (format_ == Format::kBigEndian) std::reverse(bytes.begin(), bytes.end());
        return static_cast<double>(std::bit_cast<T>(bytes));
    }

    double next_word() {
        constexpr std::string_view kBlank = " \t\r\n";
        const std::size_t begin = data_.find_first_not_of(kBlank, at_);
        if (begin == std::string_view::npos) {
            throw InputError("ply.cut_off", "it ends before its last vertex or face");
        }
        const std::size_t end = std::min(data_.find_first_of(kBlank, begin), data_.size());
        at_ = end;
        double value = 0.0;
        const char* first = data_.data() + begin;
        const auto [stop, error] = std::from_chars(first, data_.data() + end, value);
        if (error != std::errc() || stop != data_.data() + end) {
            throw InputError("ply.number", "'{word}' is no number",
                             {{"word", shown(std::string(data_.substr(begin, end - begin)))}});
        }
        return value;
    }

    std::string_view data_;
    Format format_;
    std::size_t at_ = 0;
};

void read_vertices(Body& body, const Element& element, std::vector<Vec3>& vertices) {
    int seen = 0;
    for (const Property& p : element.properties) {
        seen += !p.list && (p.name == "x" || p.name == "y" || p.name == "z");
    }
    if (seen != 3) throw InputError("ply.no_coordinates", "its vertices have no x, y and z");
    vertices.reserve(std::min(element.count, body.left()));
    for (std::size_t i = 0; i < element.count; ++i) {
        Vec3 vertex = Vec3::Zero();
        for (const Property& p : element.properties) {
            if (p.list) {
                for (std::size_t n = body.next_index(p.count, body.left(), kListLength); n; --n)
                    body.next(p.number);
                continue;
            }
            const double value = body.next(p.number);
            if (p.name == "x") vertex.x() = value;
            if (p.name == "y") vertex.y() = value;
            if (p.name == "z") vertex.z() = value;
        }
        vertices.push_back(vertex);
    }
}

/// Lists named vertex_indices or vertex_index become fans of triangles; all else is passed over.
void read_others(Body& body, const Element& element, std::vector<Triangle>& triangles) {
    if (element.properties.empty()) return;
    constexpr std::size_t kLargest = 0xffffffff;
    for (std::size_t i = 0; i < element.count; ++i) {
        for (const Property& p : element.properties) {
            if (!p.list) {
                body.next(p.number);
                continue;
            }
            const bool face =
                element.name == "face" && (p.name == "vertex_indices" || p.name == "vertex_index");
            const std::size_t length = body.next_index(p.count, body.left(), kListLength);
            Triangle t{};
            for (std::size_t k = 0; k < length; ++k) {
                if (!face) {
                    body.next(p.number);
                    continue;
                }
                const auto index =
                    static_cast<std::uint32_t>(body.next_index(p.number, kLargest, kVertexIndex));
                if (k == 0) t[0] = index;
                if (k >= 2) {
                    t[2] = index;
                    triangles.push_back(t);
                }
                if (k >= 1) t[1] = index;
            }
        }
    }
}

RawMesh parse(std::string_view data) {
    const Header header = read_header(data);
    Body body(data.substr(header.end), header.format);
    RawMesh mesh;
    for (const Element& element : header.elements) {
        if (element.name == "vertex") {
            read_vertices(body, element, mesh.vertices);
        } else {
            read_others(body, element, mesh.triangles);
        }
    }
    for (const Triangle& t : mesh.triangles) {
        if (std::max({t[0], t[1], t[2]}) >= mesh.vertices.size()) {
            throw InputError("ply.face_without_vertex", "a face names a vertex that is not there");
        }
    }
    return mesh;
}

}  // namespace

RawMesh read_ply(const std::string& path) {
    if (!is_readable_file(path))
        throw InputError("mesh.no_such_file", "{file}: there is no such file", {{"file", path}});
    std::ifstream file(path, std::ios::binary);
    const std::string data{std::istreambuf_iterator<char>(file), {}};
    if (!file) throw InputError("ply.no_access", "{file}: cannot be read", {{"file", path}});
    try {
        return parse(data);
    } catch (const InputError& error) {
        throw error.within(
            {"ply.not_readable", "{file}: cannot be read as a PLY mesh: ", {{"file", path}}});
    }
}

}  // namespace beltgrinding

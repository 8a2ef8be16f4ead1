// Own code, because assimp crashes on every second damaged PLY, and rounds its doubles to floats.

#include "beltgrinding/mesh_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>

#include "beltgrinding/error.h"
#include "foreign/file_check.h"
#include "mesh/sense.h"
#include "ply_header.h"

namespace beltgrinding {
namespace {

using namespace ply;

static_assert(std::endian::native == std::endian::little);

const Fact kListLength{"ply.list_length", "a list's length is out of range", {}};
const Fact kVertexIndex{"ply.vertex_index", "a vertex index is out of range", {}};

/// The numbers of the body, one after the other. Throws InputError where the file ends.
class Body {
  public:
    /// `lines`: those before it.
    Body(std::string_view data, Format format, std::size_t lines)
        : data_(data), format_(format), lines_(lines) {}

    std::size_t left() const { return data_.size() - at_; }

    /// The next record begins.
    void begin_record() { record_ = at_; }

    /// The line in which the record begins, from 1; 0 in a binary file.
    std::size_t line() const {
        if (format_ != Format::kAscii) return 0;
        const std::size_t begin =
            std::min(data_.find_first_not_of(" \t\r\n", record_), data_.size());
        const std::string_view before = data_.substr(0, begin);
        return lines_ + 1 +
               static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    }

    /// Throws InputError where a text's line goes on behind the record.
    void end_record() const {
        if (format_ != Format::kAscii) return;
        const std::size_t next = data_.find_first_not_of(" \t\r", at_);
        if (next != std::string_view::npos && data_[next] != '\n')
            throw InputError("ply.columns", "it has not as many columns as the header says");
    }

    /// Throws InputError where something follows but blanks and zeros.
    void end() const {
        constexpr std::string_view kNothing(" \t\r\n\0", 5);
        if (data_.find_first_not_of(kNothing, at_) != std::string_view::npos)
            throw InputError("ply.more", "it goes on after all that its header counts");
    }

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
        if (*first == '+' && end - begin > 1) ++first;
        const auto [stop, error] = std::from_chars(first, data_.data() + end, value);
        if (error != std::errc() || stop != data_.data() + end) {
            throw InputError("ply.number", "'{word}' is no number",
                             {{"word", shown(std::string(data_.substr(begin, end - begin)))}});
        }
        return value;
    }

    std::string_view data_;
    Format format_;
    std::size_t lines_;
    std::size_t at_ = 0, record_ = 0;
};

/// Reads the records of an element one by one; an error of one names it and its line.
template <class Read>
void read_records(Body& body, const Element& element, const Read& read) {
    for (std::size_t i = 0; i < element.count; ++i) {
        try {
            body.begin_record();
            for (const Property& p : element.properties) read(p, i);
            body.end_record();
        } catch (const InputError& error) {
            const std::string name = shown(element.name);
            if (const std::size_t line = body.line()) {
                throw error.within({"ply.at_line",
                                    "line {line}, {element} {number}: ",
                                    {{"line", line}, {"element", name}, {"number", i}}});
            }
            throw error.within(
                {"ply.at", "{element} {number}: ", {{"element", name}, {"number", i}}});
        }
    }
}

void skip(Body& body, const Property& property) {
    std::size_t n = 1;
    if (property.list) n = body.next_index(property.count, body.left(), kListLength);
    for (; n > 0; --n) body.next(property.number);
}

bool is_corners(const Property& p) {
    return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
}

void read_vertices(Body& body, const Element& element, std::vector<Vec3>& vertices) {
    std::array<int, 3> seen{};
    const auto axis = [](const Property& p) {
        return p.list || p.name.size() != 1 ? -1 : p.name[0] - 'x';
    };
    for (const Property& p : element.properties)
        if (axis(p) >= 0 && axis(p) < 3) ++seen[static_cast<std::size_t>(axis(p))];
    if (seen != std::array{1, 1, 1})
        throw InputError("ply.no_coordinates", "its vertices have no x, y and z");
    vertices.reserve(std::min(element.count, body.left()));
    read_records(body, element, [&](const Property& p, std::size_t i) {
        if (i == vertices.size()) vertices.emplace_back(Vec3::Zero());
        const int a = axis(p);
        if (a >= 0 && a < 3) {
            vertices.back()[a] = body.next(p.number);
        } else {
            skip(body, p);
        }
    });
}

/// Polygons as the file has them, one list behind the other.
struct Polygons {
    std::vector<std::uint32_t> corners;
    std::vector<std::size_t> ends;
};

constexpr std::uint32_t kRestart = 0xffffffff;  // in a strip; as no vertex can be numbered

/// The corners that an element's lists name: a polygon a list, or, of strips, several.
Polygons read_polygons(Body& body, const Element& element, bool strips) {
    if (std::count_if(element.properties.begin(), element.properties.end(), is_corners) != 1) {
        throw InputError("ply.no_corners",
                         "its element '{element}' has not one list vertex_indices or "
                         "vertex_index; export it as triangles",
                         {{"element", shown(element.name)}});
    }
    Polygons found;
    read_records(body, element, [&](const Property& p, std::size_t) {
        if (!is_corners(p)) return skip(body, p);
        const std::size_t length = body.next_index(p.count, body.left(), kListLength);
        for (std::size_t k = 0; k < length; ++k) {
            const double value = body.next(p.number);
            const bool restart = strips && (value == -1.0 || value == double(kRestart));
            if (restart) {
                found.ends.push_back(found.corners.size());
            } else if (value >= 0.0 && value < double(kRestart) && value == std::floor(value)) {
                found.corners.push_back(static_cast<std::uint32_t>(value));
            } else {
                throw InputError(kVertexIndex);
            }
        }
        found.ends.push_back(found.corners.size());
    });
    return found;
}

/// Twice the area of a triangle, along its normal.
Vec3 twice_area(const std::vector<Vec3>& at, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return (at[b] - at[a]).cross(at[c] - at[a]);
}

/// A corner from which a fan covers the polygon without a fold: a hollow one has not always one.
std::size_t fan_corner(const std::vector<Vec3>& at, std::span<const std::uint32_t> polygon) {
    const std::size_t n = polygon.size();
    Vec3 whole = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < n; ++k)
        whole += twice_area(at, polygon[0], polygon[k], polygon[k + 1]);
    for (std::size_t first = 0; first < n; ++first) {
        bool folds = false;
        for (std::size_t k = 1; k + 1 < n && !folds; ++k) {
            const Vec3 area = twice_area(at, polygon[first], polygon[(first + k) % n],
                                         polygon[(first + k + 1) % n]);
            constexpr double kRounding = 1e-9;
            folds = area.dot(whole) < -kRounding * whole.squaredNorm();
        }
        if (!folds) return first;
    }
    return n;
}

void add_fans(const Polygons& polygons, const std::vector<Vec3>& at,
              std::vector<Triangle>& triangles) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < polygons.ends.size(); ++i) {
        const std::size_t n = polygons.ends[i] - begin;
        const std::span<const std::uint32_t> polygon{polygons.corners.data() + begin, n};
        begin = polygons.ends[i];
        if (n < 3) continue;
        const std::size_t first = n == 3 ? 0 : fan_corner(at, polygon);
        if (first == n) {
            throw InputError("ply.hollow_face",
                             "face {number} is a hollow polygon of {count} corners; export it as "
                             "triangles",
                             {{"number", i}, {"count", n}});
        }
        for (std::size_t k = 1; k + 1 < n; ++k)
            triangles.push_back(
                {polygon[first], polygon[(first + k) % n], polygon[(first + k + 1) % n]});
    }
}

/// Every second triangle of a strip runs round the other way. Where strips are joined by corners
/// that are named twice, what has no area is left out.
void add_strips(const Polygons& strips, std::vector<Triangle>& triangles) {
    std::size_t begin = 0;
    for (const std::size_t end : strips.ends) {
        for (std::size_t k = begin; k + 2 < end; ++k) {
            Triangle t = {strips.corners[k], strips.corners[k + 1], strips.corners[k + 2]};
            if ((k - begin) % 2 == 1) std::swap(t[0], t[1]);
            if (t[0] != t[1] && t[1] != t[2] && t[0] != t[2]) triangles.push_back(t);
        }
        begin = end;
    }
}

/// What a file has beside vertices and faces that says nothing of a surface. range_grid: of a scan
/// from one side, which the vertices are (Stanford's scans).
bool passed_over(const Element& element) {
    return element.name == "range_grid" || element.name == "edge" ||
           std::none_of(element.properties.begin(), element.properties.end(), is_corners);
}

RawMesh parse(std::string_view data) {
    const Header header = read_header(data);
    Body body(data.substr(header.end), header.format,
              static_cast<std::size_t>(std::count(data.begin(), data.begin() + header.end, '\n')));
    RawMesh mesh;
    Polygons faces, strips;
    bool surface = false;  // the file means one, not a cloud
    std::vector<std::string> seen;
    for (const Element& element : header.elements) {
        const std::string& name = element.name;
        const bool known = name == "vertex" || name == "face" || name == "tristrips";
        if (known && std::count(seen.begin(), seen.end(), name) > 0)
            throw InputError("ply.element_twice", "its header names the element '{element}' twice",
                             {{"element", shown(name)}});
        seen.push_back(name);
        if (element.count == 0) continue;
        surface = surface || name == "face" || name == "tristrips" || name == "edge";
        if (name == "vertex") {
            read_vertices(body, element, mesh.vertices);
        } else if (name == "face") {
            faces = read_polygons(body, element, false);
        } else if (name == "tristrips") {
            strips = read_polygons(body, element, true);
        } else if (passed_over(element)) {
            if (element.properties.empty()) continue;
            read_records(body, element, [&](const Property& p, std::size_t) { skip(body, p); });
        } else {
            throw InputError("ply.element",
                             "its element '{element}' names vertices, but only face and "
                             "tristrips are read; export it as triangles",
                             {{"element", shown(name)}});
        }
    }
    body.end();
    for (const Polygons* one : {&faces, &strips})
        for (const std::uint32_t corner : one->corners)
            if (corner >= mesh.vertices.size())
                throw InputError("ply.face_without_vertex",
                                 "a face names a vertex that is not there");
    add_fans(faces, mesh.vertices, mesh.triangles);
    add_strips(strips, mesh.triangles);
    if (surface && mesh.triangles.empty())
        throw InputError("ply.no_triangle",
                         "it has edges or faces, and none with three corners: no surface and no "
                         "cloud; export it as triangles");
    mesh.turned = turn_outward(mesh.vertices, mesh.triangles);
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

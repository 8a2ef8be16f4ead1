#include "inspection/section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "beltgrinding/error.h"
#include "mesh/topology.h"

namespace beltgrinding {
namespace {

constexpr double kOnPlane = 1e-7;    // mm; a sample so near lies on the plane
constexpr double kSamePoint = 1e-7;  // mm
constexpr double kNoDirection = 1e-9;
constexpr std::size_t kTogether = 64;  // samples, or triangles, that one box holds
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Where the plane crosses the edge of two samples, `share` of the way from the first.
struct Crossing {
    std::uint32_t a = 0, b = 0;  ///< a < b: both triangles of an edge round alike
    double share = 0.0;

    auto edge() const { return std::tie(a, b); }
};

struct Segment {
    std::uint32_t face = 0;
    Crossing from, to;
};

/// Distances of samples from a plane, above it positive.
class PlaneDistances {
  public:
    PlaneDistances(const HeightField& field, const Vec3& origin, const Vec3& normal)
        : field_(field), origin_(origin), normal_(normal) {}
    double operator[](std::uint32_t i) const {
        const double d = normal_.dot(field_.point[i] - origin_);
        return std::abs(d) < kOnPlane ? 0.0 : d;
    }
    /// Whether the plane comes within `reach` mm of the box.
    bool nears(const Box& box, double reach) const {
        const double radius = normal_.cwiseAbs().dot(0.5 * box.sizes());
        return std::abs(normal_.dot(box.center() - origin_)) <= radius + reach;
    }

  private:
    const HeightField& field_;
    Vec3 origin_, normal_;
};

/// Appends the segments of the triangles from `begin` to `end`, along plane normal x surface
/// normal. Samples on the plane count as above it or, with `touching_below`, as below.
void append_segments(const HeightField& field, const PlaneDistances& plane, bool touching_below,
                     std::size_t begin, std::size_t end, std::vector<Segment>& segments) {
    for (std::size_t k = begin; k < end; ++k) {
        const Triangle& t = field.triangles[k];
        std::array<double, 3> distance{};
        std::array<bool, 3> above{};
        for (std::size_t i = 0; i < 3; ++i) {
            distance[i] = plane[t[i]];
            above[i] = touching_below ? distance[i] > 0.0 : distance[i] >= 0.0;
        }
        // Counter-clockwise triangles: above lies on the left of plane normal x normal.
        if (above[0] == above[1] && above[1] == above[2]) continue;
        const auto through = triangle_crossing(above);
        if (!through) continue;
        const auto crossing = [&](const auto& edge) {
            const std::size_t p = t[edge[0]] < t[edge[1]] ? edge[0] : edge[1];
            const std::size_t q = p == edge[0] ? edge[1] : edge[0];
            const double share = distance[p] / (distance[p] - distance[q]);
            return Crossing{t[p], t[q], std::clamp(share, 0.0, 1.0)};
        };
        segments.push_back(
            {field.face[t[0]], crossing(through->leaves), crossing(through->enters)});
    }
}

double mix(double a, double b, double share) {
    return (1.0 - share) * a + share * b;
}

void append(SectionPiece& piece, const HeightField& field, const Crossing& c) {
    const Vec3 point = (1.0 - c.share) * field.point[c.a] + c.share * field.point[c.b];
    if (!piece.point.empty() && (piece.point.back() - point).norm() < kSamePoint) return;
    const Vec3 normal = (1.0 - c.share) * field.normal[c.a].cast<double>() +
                        c.share * field.normal[c.b].cast<double>();
    const Vec3 ray =
        (1.0 - c.share) * field.ray(c.a).cast<double>() + c.share * field.ray(c.b).cast<double>();
    // A missed sample has no height; one that the line does not touch does no harm.
    const bool missed = ((field.flags[c.a] & kMissed) != 0 && c.share < 1.0) ||
                        ((field.flags[c.b] & kMissed) != 0 && c.share > 0.0);
    piece.point.push_back(point);
    piece.normal.push_back(normal.normalized());
    piece.ray.push_back(ray);
    piece.stock_height.push_back(
        missed ? kNaN : mix(field.stock_height[c.a], field.stock_height[c.b], c.share));
    piece.height.push_back(missed ? kNaN : mix(field.height[c.a], field.height[c.b], c.share));
    if (field.height_sd.size() == field.size()) {
        piece.height_sd.push_back(
            missed ? kNaN : mix(field.height_sd[c.a], field.height_sd[c.b], c.share));
    }
}

/// Joins segments that share an edge.
std::vector<SectionPiece> join(const HeightField& field, const std::vector<Segment>& all) {
    std::vector<std::uint32_t> starts(all.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) starts[i] = i;
    const auto key = [&](std::uint32_t i) {
        return std::tuple(all[i].face, all[i].from.a, all[i].from.b, i);
    };
    std::sort(starts.begin(), starts.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> next(all.size()), before(all.size(), 0);
    const auto none = static_cast<std::uint32_t>(all.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        const auto wanted = std::tuple(all[i].face, all[i].to.a, all[i].to.b, 0U);
        const auto it =
            std::lower_bound(starts.begin(), starts.end(), wanted,
                             [&](std::uint32_t s, const auto& value) { return key(s) < value; });
        const bool found =
            it != starts.end() && all[*it].from.edge() == all[i].to.edge() && before[*it] == 0;
        next[i] = found ? *it : none;
        if (found) before[*it] = 1;
    }
    std::vector<char> used(all.size(), 0);
    std::vector<SectionPiece> pieces;
    // First the open lines, from their beginnings; what is left then is closed.
    for (const bool open : {true, false}) {
        for (std::uint32_t first = 0; first < all.size(); ++first) {
            if (used[first] || (open && before[first] != 0)) continue;
            SectionPiece piece;
            piece.face = all[first].face;
            piece.closed = !open;
            for (std::uint32_t i = first; i != none && !used[i]; i = next[i]) {
                used[i] = 1;
                append(piece, field, all[i].from);
                append(piece, field, all[i].to);
            }
            if (piece.point.size() > 1) pieces.push_back(std::move(piece));
        }
    }
    return pieces;
}

/// Puts the pieces one after the other, each next to where the last one ended, beginning with piece
/// `first` or, if there is no such, with the one whose beginning is the farthest from all ends.
void arrange(std::vector<SectionPiece>& pieces, std::size_t first) {
    if (first >= pieces.size()) {
        double farthest = -1.0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            double nearest = std::numeric_limits<double>::infinity();
            for (std::size_t j = 0; j < pieces.size(); ++j) {
                if (i == j) continue;
                nearest =
                    std::min(nearest, (pieces[i].point.front() - pieces[j].point.back()).norm());
            }
            if (nearest > farthest) farthest = nearest, first = i;
        }
    }
    double s = 0.0;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (k > 0) {
            const Vec3 end = pieces[k - 1].point.back();
            double nearest = std::numeric_limits<double>::infinity();
            for (std::size_t j = k; j < pieces.size(); ++j) {
                const double gap = (pieces[j].point.front() - end).norm();
                if (gap < nearest) nearest = gap, first = j;
            }
            s += nearest;
        }
        std::swap(pieces[k], pieces[first]);
        SectionPiece& piece = pieces[k];
        piece.arc_length.assign(1, s);
        for (std::size_t i = 1; i < piece.point.size(); ++i)
            piece.arc_length.push_back(s += (piece.point[i] - piece.point[i - 1]).norm());
    }
}

/// A place on a section: in `piece`, `share` of the way from point `at` to the next one.
struct Place {
    std::size_t piece = 0, at = 0;
    double share = 0.0, distance = std::numeric_limits<double>::infinity();
};

Place nearest_place(const std::vector<SectionPiece>& pieces, const Vec3& p) {
    Place best;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const std::vector<Vec3>& x = pieces[k].point;
        for (std::size_t i = 0; i + 1 < x.size(); ++i) {
            const Vec3 step = x[i + 1] - x[i];
            const double share = std::clamp((p - x[i]).dot(step) / step.squaredNorm(), 0.0, 1.0);
            const double distance = (x[i] + share * step - p).norm();
            if (distance < best.distance) best = {k, i, share, distance};
        }
    }
    return best;
}

/// Calls `visit` with each array of a piece and its counterpart in another piece.
template <class Visit>
void each_array(const SectionPiece& from, SectionPiece& to, Visit&& visit) {
    visit(from.point, to.point);
    visit(from.normal, to.normal);
    visit(from.ray, to.ray);
    visit(from.stock_height, to.stock_height);
    visit(from.height, to.height);
    visit(from.height_sd, to.height_sd);
}

/// The two parts of a piece, before and behind a place; a part may have but one point.
std::pair<SectionPiece, SectionPiece> cut(const SectionPiece& piece, const Place& place) {
    SectionPiece head, tail;
    head.face = tail.face = piece.face;
    each_array(piece, head, [&](const auto& all, auto& part) {
        if (all.empty()) return;
        const auto begin = all.begin(), next = begin + static_cast<std::ptrdiff_t>(place.at) + 1;
        part.assign(begin, next);
        if (place.share > 0.0)
            part.push_back((1.0 - place.share) * all[place.at] + place.share * all[place.at + 1]);
    });
    each_array(piece, tail, [&](const auto& all, auto& part) {
        if (all.empty()) return;
        const auto next = all.begin() + static_cast<std::ptrdiff_t>(place.at) + 1;
        if (place.share < 1.0)
            part.push_back((1.0 - place.share) * all[place.at] + place.share * all[place.at + 1]);
        part.insert(part.end(), next, all.end());
    });
    return {std::move(head), std::move(tail)};
}

/// Makes interpolated normals unit vectors again.
void normalise(std::vector<SectionPiece>& pieces) {
    for (SectionPiece& piece : pieces)
        for (Vec3& normal : piece.normal) normal.normalize();
}

/// Appends `tail` to `head`, whose last point is the tail's first.
void extend(SectionPiece& head, const SectionPiece& tail) {
    each_array(tail, head, [](const auto& from, auto& to) {
        if (!from.empty()) to.insert(to.end(), from.begin() + 1, from.end());
    });
}

std::uint32_t nearest_sample(const HeightField& field, const Vec3& p) {
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < field.size(); ++i)
        if ((field.point[i] - p).squaredNorm() < (field.point[best] - p).squaredNorm()) best = i;
    return best;
}

/// `boxes`: round each `kTogether` triangles; null: all triangles are looked at.
std::vector<SectionPiece> cut_by_plane(const HeightField& field, const Vec3& origin,
                                       const Vec3& normal, const std::vector<Box>* boxes) {
    if (field.triangles.empty())
        throw InputError("section.no_triangles",
                         "section: the height field has no triangles between its samples");
    const PlaneDistances plane(field, origin, normal);
    const auto cut = [&](bool touching_below) {
        std::vector<Segment> segments;
        const std::size_t count = field.triangles.size();
        for (std::size_t begin = 0; begin < count; begin += kTogether) {
            if (boxes != nullptr && !plane.nears((*boxes)[begin / kTogether], 2.0 * kOnPlane))
                continue;
            append_segments(field, plane, touching_below, begin, std::min(begin + kTogether, count),
                            segments);
        }
        return join(field, segments);
    };
    std::vector<SectionPiece> pieces = cut(false);
    // A border that lies on the plane is met from one of the two sides only.
    if (pieces.empty()) pieces = cut(true);
    if (pieces.empty()) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::uint32_t i = 0; i < field.size(); ++i) {
            low = std::min(low, plane[i]);
            high = std::max(high, plane[i]);
        }
        throw InputError("section.misses",
                         "section: the plane misses the faces; along its normal they lie from "
                         "{low:g} to {high:g} mm: move it there",
                         {{"low", low}, {"high", high}});
    }
    return pieces;
}

Section whole_section(const HeightField& field, const Vec3& origin, const Vec3& normal,
                      const std::vector<Box>* boxes) {
    if (!origin.allFinite() || !normal.allFinite() || normal.norm() < kNoDirection)
        throw InputError("section.no_plane",
                         "section: a plane needs a point and a normal other than 0");
    Section section{origin, normal.normalized(), {}};
    section.pieces = cut_by_plane(field, section.origin, section.normal, boxes);
    arrange(section.pieces, section.pieces.size());
    return section;
}

}  // namespace

Section section_by_plane(const HeightField& field, const Vec3& origin, const Vec3& normal) {
    field.validate();
    return whole_section(field, origin, normal, nullptr);
}

SectionIndex::SectionIndex(const HeightField& field) : field_(field) {
    field.validate();
    samples_.resize((field.size() + kTogether - 1) / kTogether);
    for (std::size_t i = 0; i < field.size(); ++i) samples_[i / kTogether].extend(field.point[i]);
    triangles_.resize((field.triangles.size() + kTogether - 1) / kTogether);
    for (std::size_t t = 0; t < field.triangles.size(); ++t) {
        for (const std::uint32_t i : field.triangles[t])
            triangles_[t / kTogether].extend(field.point[i]);
    }
}

Section SectionIndex::section_by_plane(const Vec3& origin, const Vec3& normal) const {
    return whole_section(field_, origin, normal, &triangles_);
}

std::vector<std::uint32_t> SectionIndex::near_plane(const Vec3& origin, const Vec3& normal,
                                                    double reach) const {
    const PlaneDistances plane(field_, origin, normal);
    std::vector<std::uint32_t> found;
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        if (!plane.nears(samples_[k], reach)) continue;
        const std::size_t end = std::min((k + 1) * kTogether, field_.size());
        for (auto i = static_cast<std::uint32_t>(k * kTogether); i < end; ++i)
            if (std::abs(plane[i]) <= reach) found.push_back(i);
    }
    return found;
}

Section section_between(const HeightField& field, const Vec3& from, const Vec3& to) {
    field.validate();
    if (!from.allFinite() || !to.allFinite() || field.size() == 0)
        throw InputError("section.no_line", "section: a line needs two points on a surface");
    const Vec3 mean = field.normal[nearest_sample(field, from)].cast<double>() +
                      field.normal[nearest_sample(field, to)].cast<double>();
    const Vec3 normal = mean.cross(to - from);  // so that it runs from `from` to `to`
    if (normal.norm() < kNoDirection + kSamePoint * mean.norm()) {
        throw InputError(
            "section.points",
            "section: the two points coincide, lie one above the other, or on opposite sides: "
            "choose them apart on one side, or give a plane");
    }
    Section section{from, normal.normalized(), {}};
    std::vector<SectionPiece>& pieces = section.pieces;
    pieces = cut_by_plane(field, section.origin, section.normal, nullptr);

    const Place begin = nearest_place(pieces, from);
    auto [head, tail] = cut(pieces[begin.piece], begin);
    if (pieces[begin.piece].closed) {
        extend(tail, head);
    } else if (head.point.size() > 1) {
        pieces.push_back(std::move(head));  // the line may come back to it from behind
    }
    if (tail.point.size() > 1) {
        pieces[begin.piece] = std::move(tail);
        arrange(pieces, begin.piece);
    } else {  // it begins where a piece ends: with the next one
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(begin.piece));
        Place next;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            const double gap = (pieces[k].point.front() - from).norm();
            if (gap < next.distance) next = {k, 0, 0.0, gap};
        }
        arrange(pieces, next.piece);
    }
    if (pieces.empty())
        throw InputError("section.not_connected",
                         "section: no line on the faces leads between the points");

    const Place end = nearest_place(pieces, to);
    SectionPiece last = cut(pieces[end.piece], end).first;
    pieces.resize(end.piece);
    if (last.point.size() > 1) pieces.push_back(std::move(last));
    if (pieces.empty())
        throw InputError("section.not_connected",
                         "section: no line on the faces leads between the points");
    normalise(pieces);
    arrange(pieces, 0);
    return section;
}

}  // namespace beltgrinding

#include <algorithm>
#include <cmath>

#include "face_trim.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kLeaf = 16;  // segments that are compared each with each
constexpr int kDeepest = 24;       // halvings of the plane

}  // namespace

std::vector<std::size_t> crossing_segments(const Boundary& boundary) {
    const auto& segments = boundary.segments;
    struct Extent {
        std::int32_t x0, x1, y0, y1;
    };
    std::vector<Extent> box(segments.size());
    std::vector<std::size_t> order(segments.size());
    const auto grid = [&](std::uint32_t node) { return boundary.nodes[node].grid; };
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const GridPoint a = grid(segments[i].a), b = grid(segments[i].b);
        box[i] = {std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y)};
        order[i] = i;
    }
    // A sweep along x would compare whole columns of a long upright border: sweep over both.
    std::vector<char> hit(segments.size(), 0);
    const auto cross = [&](std::size_t i, std::size_t j) {
        const auto &s = segments[i], &r = segments[j];
        if (s.a == r.a || s.a == r.b || s.b == r.a || s.b == r.b) return false;
        const GridPoint a = grid(s.a), b = grid(s.b), c = grid(r.a), d = grid(r.b);
        const std::int64_t o1 = orient(a, b, c), o2 = orient(a, b, d);
        const std::int64_t o3 = orient(c, d, a), o4 = orient(c, d, b);
        return ((o1 < 0 && o2 > 0) || (o1 > 0 && o2 < 0)) &&
               ((o3 < 0 && o4 > 0) || (o3 > 0 && o4 < 0));
    };
    const auto visit = [&](auto&& self, std::vector<std::size_t>& set, int depth) -> void {
        if (set.size() <= kLeaf || depth > kDeepest) {
            for (std::size_t i = 0; i < set.size(); ++i)
                for (std::size_t j = i + 1; j < set.size(); ++j)
                    if (cross(set[i], set[j])) hit[set[i]] = hit[set[j]] = 1;
            return;
        }
        const bool by_x = depth % 2 == 0;
        std::vector<std::int32_t> middles;
        middles.reserve(set.size());
        for (const std::size_t i : set)
            middles.push_back(by_x ? box[i].x0 / 2 + box[i].x1 / 2 : box[i].y0 / 2 + box[i].y1 / 2);
        std::nth_element(middles.begin(),
                         middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2),
                         middles.end());
        const std::int32_t cut = middles[middles.size() / 2];
        std::vector<std::size_t> low, high;
        for (const std::size_t i : set) {
            if ((by_x ? box[i].x0 : box[i].y0) <= cut) low.push_back(i);
            if ((by_x ? box[i].x1 : box[i].y1) >= cut) high.push_back(i);
        }
        self(self, low, depth + 1);
        self(self, high, depth + 1);
    };
    visit(visit, order, 0);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < hit.size(); ++i)
        if (hit[i]) found.push_back(i);
    return found;
}

TrimScan::TrimScan(const Boundary& boundary, double top, std::size_t bins)
    : start_(std::max<std::size_t>(1, bins) + 1, 0),
      bin_height_(top / double(std::max<std::size_t>(1, bins))) {
    for (const auto& s : boundary.segments) {
        const GridPoint a = boundary.nodes[s.a].grid, b = boundary.nodes[s.b].grid;
        if (a.y == b.y) continue;  // crosses no horizontal line
        chords_.push_back({double(a.x), double(a.y), double(b.x), double(b.y)});
    }
    for (int fill = 0; fill < 2; ++fill) {
        std::vector<std::uint32_t> at(start_.begin(), start_.end() - 1);
        for (std::uint32_t i = 0; i < chords_.size(); ++i) {
            const std::size_t low = bin(std::min(chords_[i].ya, chords_[i].yb));
            const std::size_t high = bin(std::max(chords_[i].ya, chords_[i].yb));
            for (std::size_t b = low; b <= high; ++b) {
                if (fill)
                    index_[at[b]++] = i;
                else
                    ++start_[b + 1];
            }
        }
        if (!fill) {
            for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
            index_.resize(start_.back());
        }
    }
}

std::size_t TrimScan::bin(double y) const {
    const double b = std::floor(y / bin_height_);
    return b > 0 ? std::min(static_cast<std::size_t>(b), start_.size() - 2) : 0;
}

std::vector<double> TrimScan::crossings(double y) const {
    std::vector<double> found;
    const std::size_t b = bin(y);
    for (std::uint32_t k = start_[b]; k < start_[b + 1]; ++k) {
        const Chord& c = chords_[index_[k]];
        if ((c.ya <= y) == (c.yb <= y)) continue;
        found.push_back(c.xa + (y - c.ya) / (c.yb - c.ya) * (c.xb - c.xa));
    }
    std::sort(found.begin(), found.end());
    return found;
}

bool TrimScan::inside(double x, double y) const {
    const std::vector<double> at = crossings(y);
    return (at.end() - std::upper_bound(at.begin(), at.end(), x)) % 2 != 0;
}

}  // namespace beltgrinding

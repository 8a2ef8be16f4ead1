#include <algorithm>
#include <cmath>
#include <numeric>

#include "face_trim.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kLeaf = 16;  // segments that are compared each with each
constexpr int kDeepest = 24;       // halvings of the plane

/// True if two segments without a common end cross inside both.
bool cross(const Boundary& boundary, std::size_t i, std::size_t j) {
    const auto &s = boundary.segments[i], &r = boundary.segments[j];
    if (s.a == r.a || s.a == r.b || s.b == r.a || s.b == r.b) return false;
    const GridPoint a = boundary.nodes[s.a].grid, b = boundary.nodes[s.b].grid;
    const GridPoint c = boundary.nodes[r.a].grid, d = boundary.nodes[r.b].grid;
    const std::int64_t o1 = orient(a, b, c), o2 = orient(a, b, d);
    const std::int64_t o3 = orient(c, d, a), o4 = orient(c, d, b);
    return ((o1 < 0 && o2 > 0) || (o1 > 0 && o2 < 0)) && ((o3 < 0 && o4 > 0) || (o3 > 0 && o4 < 0));
}

/// Looks for segments that cross by halving the plane along x and y in turns: a sweep along x would
/// compare whole columns of a long upright border.
class CrossingSearch {
  public:
    explicit CrossingSearch(const Boundary& boundary)
        : boundary_(boundary), hit_(boundary.segments.size(), 0) {
        for (const auto& s : boundary.segments) {
            const GridPoint a = boundary.nodes[s.a].grid, b = boundary.nodes[s.b].grid;
            low_.push_back({std::min(a.x, b.x), std::min(a.y, b.y)});
            high_.push_back({std::max(a.x, b.x), std::max(a.y, b.y)});
        }
    }
    /// Compares the segments of `set`, which lie in one of 2^depth parts of the plane.
    void look(const std::vector<std::size_t>& set, int depth) {
        if (set.size() <= kLeaf || depth > kDeepest) return compare(set);
        const auto along = [by_x = depth % 2 == 0](const GridPoint& p) { return by_x ? p.x : p.y; };
        std::vector<std::int32_t> middles;
        middles.reserve(set.size());
        for (const std::size_t i : set) middles.push_back(along(low_[i]) / 2 + along(high_[i]) / 2);
        std::nth_element(middles.begin(),
                         middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2),
                         middles.end());
        const std::int32_t cut = middles[middles.size() / 2];
        std::vector<std::size_t> below, above;
        for (const std::size_t i : set) {
            if (along(low_[i]) <= cut) below.push_back(i);
            if (along(high_[i]) >= cut) above.push_back(i);
        }
        look(below, depth + 1);
        look(above, depth + 1);
    }
    /// True by segment that crosses another.
    const std::vector<char>& hit() const { return hit_; }

  private:
    void compare(const std::vector<std::size_t>& set) {
        for (std::size_t i = 0; i < set.size(); ++i)
            for (std::size_t j = i + 1; j < set.size(); ++j)
                if (cross(boundary_, set[i], set[j])) hit_[set[i]] = hit_[set[j]] = 1;
    }

    const Boundary& boundary_;
    std::vector<GridPoint> low_, high_;  // corners of each segment's box
    std::vector<char> hit_;
};

}  // namespace

std::vector<std::size_t> crossing_segments(const Boundary& boundary) {
    std::vector<std::size_t> all(boundary.segments.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    CrossingSearch search(boundary);
    search.look(all, 0);
    std::erase_if(all, [&](std::size_t i) { return search.hit()[i] == 0; });
    return all;
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

#include "mesh/thinning.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/large_memory.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kLeastEdge = 1e-9;    // mm
constexpr double kLeastGrowth = 1.02;  // of the cubes' edge, from one try to the next

/// Numbers keys in the order in which they come: an open-addressed table.
class Numbers {
  public:
    explicit Numbers(std::size_t count)
        : shift_(64 - std::bit_width(2 * count)), slots_(std::size_t{1} << (64 - shift_)) {}
    /// The key's number, and whether it is new.
    std::uint32_t operator()(std::uint64_t key) {
        constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;  // Knuth's multiplicative hashing
        for (std::size_t at = key * kGolden >> shift_;; at = (at + 1) & (slots_.size() - 1)) {
            Slot& slot = slots_[at];
            if (slot.number == kNone) slot = {key, count_++};
            if (slot.key == key) return slot.number;
        }
    }

  private:
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t number = kNone;
    };
    int shift_;
    std::vector<Slot> slots_;
    std::uint32_t count_ = 0;
};

/// Which part of a cube each sample belongs to.
struct Clusters {
    std::vector<std::uint32_t> of;
    std::uint32_t count = 0;
};

Clusters clusters(std::span<const Vec3> points, std::span<const Vec3f> normals,
                  std::span<const std::uint32_t> groups, const Box& extents, double edge) {
    Clusters found;
    resize_large(found.of, points.size());
    std::array<std::uint64_t, 3> spans{};
    for (int axis = 0; axis < 3; ++axis) {
        spans[static_cast<std::size_t>(axis)] =
            static_cast<std::uint64_t>(std::floor(extents.sizes()[axis] / edge)) + 1;
    }
    Numbers numbers(points.size());
    std::vector<std::uint32_t> first;  // sample of each cube
    std::vector<std::array<std::uint32_t, 2>>
        parts;  // of each cube: facing as the first, or against
    std::uint64_t last = 0;
    std::uint32_t cube = kNone;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 place = (points[i] - extents.min()) / edge;  // of what is not negative
        std::uint64_t key = groups[i];
        for (int axis = 0; axis < 3; ++axis)
            key = key * spans[static_cast<std::size_t>(axis)] +
                  static_cast<std::uint64_t>(place[axis]);
        if (cube == kNone || key != last) cube = numbers(key);  // neighbours often share one
        last = key;
        if (cube == first.size()) {
            first.push_back(static_cast<std::uint32_t>(i));
            parts.push_back({kNone, kNone});
        }
        const Vec3f both = normals[i].cwiseProduct(normals[first[cube]]);
        const bool behind = both.x() + both.y() + both.z() < 0.0F;  // of a thin wall
        std::uint32_t& part = parts[cube][behind ? 1 : 0];
        if (part == kNone) part = found.count++;
        found.of[i] = part;
    }
    return found;
}

}  // namespace

ThinnedSamples thinned(std::span<const Vec3> points, std::span<const Vec3f> normals,
                       std::span<const std::uint32_t> groups, std::size_t most,
                       std::span<const std::uint32_t> keep) {
    if (normals.size() != points.size() || groups.size() != points.size())
        throw InputError("thinning.counts", "thinning: one normal and one group a point");
    if (most == 0) throw InputError("thinning.size", "thinning: at least one sample stays");
    Box extents;
    for (const Vec3& p : points) extents.extend(p);
    const double diagonal = points.empty() ? 0.0 : extents.diagonal().norm();
    double edge = std::max(diagonal / std::sqrt(static_cast<double>(points.size())), kLeastEdge);
    Clusters found = clusters(points, normals, groups, extents, edge);
    while (found.count > most && edge <= diagonal) {  // beyond, nothing changes
        edge *=
            std::max(kLeastGrowth,
                     std::pow(static_cast<double>(found.count) / static_cast<double>(most), 0.5));
        found = clusters(points, normals, groups, extents, edge);
    }
    for (const std::uint32_t i : keep) {
        if (i >= points.size())
            throw InputError("thinning.keep", "thinning: sample {sample} is to stay, of {count}",
                             {{"sample", i}, {"count", points.size()}});
    }
    std::vector<Vec3> middle(found.count, Vec3::Zero());
    std::vector<std::uint32_t> counts(found.count, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        middle[found.of[i]] += points[i];
        ++counts[found.of[i]];
    }
    for (std::size_t c = 0; c < middle.size(); ++c) middle[c] /= static_cast<double>(counts[c]);
    std::vector<double> least(found.count, std::numeric_limits<double>::infinity());
    std::vector<std::uint32_t> nearest(found.count, kNone);
    const auto look = [&](std::uint32_t i, double away) {
        const std::uint32_t c = found.of[i];
        if (away > least[c] || (away == least[c] && nearest[c] <= i)) return;
        least[c] = away;
        nearest[c] = i;
    };
    for (const std::uint32_t i : keep) look(i, -1.0);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const Vec3 off = points[i] - middle[found.of[i]];
        const Vec3 square = off.cwiseProduct(off);
        look(i, std::sqrt(square.x() + square.y() + square.z()));
    }
    ThinnedSamples thin;
    thin.chosen = nearest;
    std::sort(thin.chosen.begin(), thin.chosen.end());
    std::vector<std::uint32_t> rank(found.count);
    std::vector<std::uint32_t>& place = found.of;
    for (std::uint32_t k = 0; k < thin.chosen.size(); ++k) rank[place[thin.chosen[k]]] = k;
    for (std::uint32_t& each : place) each = rank[each];
    thin.place = std::move(place);
    return thin;
}

std::vector<Triangle> replaced(std::span<const Triangle> triangles,
                               std::span<const std::uint32_t> place) {
    std::vector<Triangle> proper;
    for (const Triangle& t : triangles) {
        for (const std::uint32_t v : t) {
            if (v >= place.size())
                throw InputError("thinning.corner",
                                 "thinning: a triangle names a sample that is not there");
        }
        const Triangle moved{place[t[0]], place[t[1]], place[t[2]]};
        if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0])
            proper.push_back(moved);
    }
    return proper;
}

}  // namespace beltgrinding

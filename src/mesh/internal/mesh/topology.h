#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Disjoint sets of the numbers from 0 (union-find with path halving: Tarjan, van Leeuwen,
/// Worst-case analysis of set union algorithms, J. ACM 31, 1984). The lowest number of a set stands
/// for it, so that the outcome does not depend on the order of the joins.
class DisjointSets {
  public:
    /// The numbers 0 to n - 1, each a set of its own.
    explicit DisjointSets(std::size_t n = 0) : parent_(n) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    std::size_t size() const { return parent_.size(); }
    /// Adds the next number as a set of its own, and returns it.
    std::uint32_t add() {
        parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
        return parent_.back();
    }
    /// The number that stands for the set of i.
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// An edge as one number, whichever way it runs: the lower vertex in the upper half.
inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t(std::min(a, b)) << 32U | std::max(a, b);
}

/// The triangles at each vertex, ascending.
class VertexTriangles {
  public:
    VertexTriangles(std::size_t vertices, const std::vector<Triangle>& triangles);
    std::span<const std::uint32_t> of(std::uint32_t vertex) const {
        return {around_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
    }

  private:
    std::vector<std::uint32_t> first_, around_;  // of each vertex in `around_`, and the end
};

/// Welds what has equal keys: for each key the number of its place among the distinct ones,
/// ascending from 0. Keys must be ordered by `<` without exception (no NaN).
template <class Key>
std::vector<std::uint32_t> weld(const std::vector<Key>& keys) {
    std::vector<std::uint32_t> order(keys.size()), place(keys.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    for (std::size_t k = 1; k < order.size(); ++k)
        place[order[k]] = place[order[k - 1]] + (keys[order[k - 1]] == keys[order[k]] ? 0U : 1U);
    return place;
}

/// Corners between which a level crosses a triangle's edges.
struct TriangleCrossing {
    std::array<std::size_t, 2> leaves;  ///< from a corner above the level to the next, below
    std::array<std::size_t, 2> enters;  ///< from a corner below the level to the next, above
};

/// How a level passes through a triangle whose corners lie `above` it or below (marching
/// triangles). From `leaves` to `enters` it keeps the upper corners to the left of a
/// counter-clockwise triangle. None: all corners lie on one side.
std::optional<TriangleCrossing> triangle_crossing(const std::array<bool, 3>& above);

}  // namespace beltgrinding

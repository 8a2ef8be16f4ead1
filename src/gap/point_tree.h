#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Points in halves of halves, each with a ball around it, for the greatest value of any of them.
class PointTree {
  public:
    static constexpr std::size_t kPointsPerLeaf = 8;

    explicit PointTree(const std::vector<Vec3>& point) : index_(point.size()) {
        std::iota(index_.begin(), index_.end(), std::size_t{0});
        if (!point.empty()) split(point, 0, point.size());
    }

    /// The greatest `value(number of a point)`, and `least` at least. `most(middle, away)` is no
    /// less than the value of any point that is no farther than `away` from `middle`; what it rules
    /// out is not looked at.
    template <class Most, class Value>
    double greatest(double least, Most&& most, Value&& value) const {
        if (index_.empty()) return least;
        struct Open {
            std::size_t node;
            double most;
        };
        Open open[kDeepest];
        std::size_t count = 0;
        open[count++] = {0, most(node_[0].middle, node_[0].away)};
        while (count > 0) {
            const Open next = open[--count];
            if (!(next.most > least)) continue;
            const Node& node = node_[next.node];
            if (node.second == 0) {
                for (std::size_t k = node.begin; k < node.end; ++k)
                    least = std::max(least, double(value(index_[k])));
                continue;
            }
            Open first{next.node + 1, 0.0}, second{node.second, 0.0};
            for (Open* half : {&first, &second})
                half->most = most(node_[half->node].middle, node_[half->node].away);
            if (first.most > second.most) std::swap(first, second);
            open[count++] = first;
            open[count++] = second;  // the more promising is taken next
        }
        return least;
    }

  private:
    static constexpr std::size_t kDeepest = 128;  // two for each halving of 2^64 points
    static constexpr double kRounding = 1e-9;     // of a ball's radius

    struct Node {
        Vec3 middle;
        double away;             // mm from the middle to the farthest of its points, at most
        std::size_t begin, end;  // its points in `index_`
        std::size_t second = 0;  // its second half's node; the first is the next; 0: a leaf
    };

    void split(const std::vector<Vec3>& point, std::size_t begin, std::size_t end) {
        Box box;
        for (std::size_t k = begin; k < end; ++k) box.extend(point[index_[k]]);
        const Vec3 size = box.sizes();
        const double away = 0.5 * size.norm() * (1.0 + kRounding) + kRounding;
        const std::size_t own = node_.size();
        node_.push_back({box.center(), away, begin, end});
        if (end - begin <= kPointsPerLeaf) return;
        Eigen::Index longest = 0;
        size.maxCoeff(&longest);
        const std::size_t half = begin + (end - begin) / 2;
        const auto at = [&](std::size_t k) { return index_.begin() + std::ptrdiff_t(k); };
        std::nth_element(at(begin), at(half), at(end), [&](std::size_t a, std::size_t b) {
            return point[a][longest] < point[b][longest];
        });
        split(point, begin, half);
        node_[own].second = node_.size();
        split(point, half, end);
    }

    std::vector<Node> node_;
    std::vector<std::size_t> index_;
};

}  // namespace beltgrinding

// Own code, because no library has boxes of K slabs that are asked for the reach of a wheel, and
// refitted at each step where heights changed and nowhere else.

#include "heightfield/kdop_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr std::uint32_t kLeafSize = 24;           // segments; smaller costs memory, larger queries
constexpr std::uint32_t kSequential = 1U << 15U;  // below this many segments one thread builds
constexpr double kBoundarySlack = 1e-9;           // relative, of the exact segment test

/// The slab directions: the first 3 serve K = 6, then 4 corners (14), 6 edges (18: axes and edges).
template <int K>
struct Slabs {
    static constexpr int count = K / 2;
    static const std::array<Vec3f, 13>& all() {
        static const std::array<Vec3f, 13> directions = {
            Vec3f(1, 0, 0),  Vec3f(0, 1, 0),  Vec3f(0, 0, 1),  Vec3f(1, 1, 0),  Vec3f(1, 0, 1),
            Vec3f(0, 1, 1),  Vec3f(1, -1, 0), Vec3f(1, 0, -1), Vec3f(0, 1, -1), Vec3f(1, 1, 1),
            Vec3f(1, -1, 1), Vec3f(1, 1, -1), Vec3f(1, -1, -1)};
        return directions;
    }
    /// Not of unit length: bounds and queries use the same.
    static const Vec3f& direction(int k) {
        if constexpr (K == 14) return all()[static_cast<std::size_t>(k < 3 ? k : k + 6)];
        return all()[static_cast<std::size_t>(k)];
    }
};

template <int K>
struct Dop {
    static constexpr int kSlabs = K / 2;
    std::array<float, kSlabs> low, high;

    void clear() {
        low.fill(std::numeric_limits<float>::infinity());
        high.fill(-std::numeric_limits<float>::infinity());
    }
    /// Rounded outward: a float bound never lies inside the double point.
    void add(const Vec3& p) {
        for (int k = 0; k < kSlabs; ++k) {
            const double v = p.dot(Slabs<K>::direction(k).template cast<double>());
            const auto f = static_cast<float>(v);
            const float slack = std::abs(f) * 2e-7F + 1e-30F;
            const auto i = static_cast<std::size_t>(k);
            low[i] = std::min(low[i], f - slack);
            high[i] = std::max(high[i], f + slack);
        }
    }
    void add(const Dop& other) {
        for (std::size_t k = 0; k < kSlabs; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    bool operator==(const Dop&) const = default;
};

/// The reach's extent along each slab direction, and what the sphere test needs.
struct Query {
    WheelReach reach;
    std::array<float, 13> low, high;
};

template <int K>
Query prepare(const WheelReach& reach) {
    Query q{reach, {}, {}};
    for (int k = 0; k < K / 2; ++k) {
        const Vec3 d = Slabs<K>::direction(k).template cast<double>();
        const double along = d.dot(reach.axis);
        const double across = std::sqrt(std::max(0.0, d.squaredNorm() - along * along));
        const double centre = d.dot(reach.centre);
        const double half = std::abs(along) * reach.half_width + across * reach.radius;
        const double slack = 1e-6 * (std::abs(centre) + half) + 1e-9;
        q.low[static_cast<std::size_t>(k)] = static_cast<float>(centre - half - slack);
        q.high[static_cast<std::size_t>(k)] = static_cast<float>(centre + half + slack);
    }
    return q;
}

/// True if the sphere may have a point in the reach; conservative.
bool sphere_meets(const WheelReach& reach, const Vec3& centre, double radius) {
    const Vec3 v = centre - reach.centre;
    const double along_axis = v.dot(reach.axis);
    if (std::abs(along_axis) > reach.half_width + radius) return false;
    if (v.dot(reach.direction) < reach.min_along - radius) return false;
    const double across = (v - along_axis * reach.axis).norm();
    return across <= reach.radius + radius;
}

/// Exact: clips the segment to the slab and the half-space, then finds its nearest point to the
/// axis.
bool segment_meets(const WheelReach& reach, const Vec3& from, const Vec3& to) {
    const Vec3 a = from - reach.centre;
    const Vec3 d = to - from;
    double begin = 0.0, end = 1.0;
    const auto clip = [&](double value, double slope, double bound) {  // value + t slope <= bound
        if (slope > 0.0) {
            end = std::min(end, (bound - value) / slope);
        } else if (slope < 0.0) {
            begin = std::max(begin, (bound - value) / slope);
        } else if (value > bound) {
            end = -1.0;
        }
    };
    const double slack = kBoundarySlack * reach.radius;
    const double y = a.dot(reach.axis), dy = d.dot(reach.axis);
    clip(y, dy, reach.half_width + slack);
    clip(-y, -dy, reach.half_width + slack);
    const double z = a.dot(reach.direction), dz = d.dot(reach.direction);
    clip(-z, -dz, -reach.min_along + slack);
    if (begin > end) return false;
    const Vec3 a_across = a - y * reach.axis;
    const Vec3 d_across = d - dy * reach.axis;
    const double length2 = d_across.squaredNorm();
    const double nearest =
        length2 > 0.0 ? std::clamp(-a_across.dot(d_across) / length2, begin, end) : begin;
    const double r = reach.radius + slack;
    return (a_across + nearest * d_across).squaredNorm() <= r * r;
}

}  // namespace

/// A complete binary tree in heap order: node n has children 2n + 1 and 2n + 2; the leaves are the
/// last level and split the ordered segments evenly, so that no links need to be stored.
template <int K>
struct KDopTree<K>::Impl {
    std::vector<std::uint32_t> order;    // segments as they lie in the leaves
    std::vector<std::uint32_t> leaf_of;  // leaf of each sample
    std::vector<Dop<K>> nodes;
    std::uint32_t leaves = 1;

    std::uint32_t leaf_begin(std::uint32_t leaf) const {
        return static_cast<std::uint32_t>(static_cast<std::uint64_t>(order.size()) * leaf / leaves);
    }
    Dop<K> bound_leaf(const HeightField& field, std::uint32_t leaf) const {
        Dop<K> dop;
        dop.clear();
        for (std::uint32_t i = leaf_begin(leaf); i < leaf_begin(leaf + 1); ++i) {
            const std::uint32_t s = order[i];
            dop.add(field.top(s));
            dop.add(field.bottom(s));
        }
        return dop;
    }
    void sort_range(const HeightField& field, std::uint32_t first_leaf, std::uint32_t leaf_count);
    void query_node(const HeightField& field, const Query& q, std::uint32_t node,
                    std::vector<std::uint32_t>& hits) const;
};

template <int K>
void KDopTree<K>::Impl::sort_range(const HeightField& field, std::uint32_t first_leaf,
                                   std::uint32_t leaf_count) {
    if (leaf_count <= 1) return;
    const std::uint32_t begin = leaf_begin(first_leaf);
    const std::uint32_t end = leaf_begin(first_leaf + leaf_count);
    const std::uint32_t middle = leaf_begin(first_leaf + leaf_count / 2);
    Eigen::AlignedBox3d box;
    for (std::uint32_t i = begin; i < end; ++i) box.extend(field.point[order[i]]);
    if (box.isEmpty()) return;
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double pa = field.point[a][axis], pb = field.point[b][axis];
                         return pa != pb ? pa < pb : a < b;
                     });
    const auto lower = [&] { sort_range(field, first_leaf, leaf_count / 2); };
    const auto upper = [&] { sort_range(field, first_leaf + leaf_count / 2, leaf_count / 2); };
    if (end - begin > kSequential) {
        parallel_both(lower, upper);
    } else {
        lower();
        upper();
    }
}

template <int K>
void KDopTree<K>::Impl::query_node(const HeightField& field, const Query& q, std::uint32_t node,
                                   std::vector<std::uint32_t>& hits) const {
    const Dop<K>& dop = nodes[node];
    for (std::size_t k = 0; k < K / 2; ++k) {
        if (dop.low[k] > q.high[k] || dop.high[k] < q.low[k]) return;
    }
    const Vec3 low(dop.low[0], dop.low[1], dop.low[2]);
    const Vec3 high(dop.high[0], dop.high[1], dop.high[2]);
    if (!sphere_meets(q.reach, 0.5 * (low + high), 0.5 * (high - low).norm())) return;
    if (node < leaves - 1) {
        query_node(field, q, 2 * node + 1, hits);
        query_node(field, q, 2 * node + 2, hits);
        return;
    }
    const std::uint32_t leaf = node - (leaves - 1);
    for (std::uint32_t i = leaf_begin(leaf); i < leaf_begin(leaf + 1); ++i) {
        const std::uint32_t s = order[i];
        if (segment_meets(q.reach, field.bottom(s), field.top(s))) hits.push_back(s);
    }
}

template <int K>
KDopTree<K>::KDopTree(const HeightField& field, const RunContext& context)
    : impl_(std::make_unique<Impl>()) {
    Impl& t = *impl_;
    const auto n = static_cast<std::uint32_t>(field.size());
    t.order.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) t.order[i] = i;
    while (static_cast<std::uint64_t>(t.leaves) * kLeafSize < n) t.leaves *= 2;
    t.sort_range(field, 0, t.leaves);
    context.throw_if_cancelled();
    t.leaf_of.resize(n);
    t.nodes.resize(2 * static_cast<std::size_t>(t.leaves) - 1);
    parallel_blocks(t.leaves, 256, context, [&](std::size_t begin, std::size_t end) {
        for (auto leaf = static_cast<std::uint32_t>(begin); leaf < end; ++leaf) {
            std::sort(t.order.begin() + t.leaf_begin(leaf),
                      t.order.begin() + t.leaf_begin(leaf + 1));
            for (std::uint32_t i = t.leaf_begin(leaf); i < t.leaf_begin(leaf + 1); ++i) {
                t.leaf_of[t.order[i]] = leaf;
            }
            t.nodes[t.leaves - 1 + leaf] = t.bound_leaf(field, leaf);
        }
    });
    for (std::uint32_t node = t.leaves - 1; node-- > 0;) {
        t.nodes[node] = t.nodes[2 * node + 1];
        t.nodes[node].add(t.nodes[2 * node + 2]);
    }
}

template <int K>
KDopTree<K>::~KDopTree() = default;
template <int K>
KDopTree<K>::KDopTree(KDopTree&&) noexcept = default;
template <int K>
KDopTree<K>& KDopTree<K>::operator=(KDopTree&&) noexcept = default;

template <int K>
void KDopTree<K>::query(const HeightField& field, const WheelReach& reach,
                        std::vector<std::uint32_t>& hits) const {
    hits.clear();
    if (impl_->order.empty()) return;
    impl_->query_node(field, prepare<K>(reach), 0, hits);
    std::sort(hits.begin(), hits.end());
}

template <int K>
void KDopTree<K>::refit(const HeightField& field, std::span<const std::uint32_t> changed) {
    Impl& t = *impl_;
    std::vector<std::uint32_t> level;
    for (const std::uint32_t s : changed) level.push_back(t.leaves - 1 + t.leaf_of[s]);
    std::sort(level.begin(), level.end());
    level.erase(std::unique(level.begin(), level.end()), level.end());
    for (const std::uint32_t node : level) {
        t.nodes[node] = t.bound_leaf(field, node - (t.leaves - 1));
    }
    while (!level.empty() && level.front() > 0) {
        for (std::uint32_t& node : level) node = (node - 1) / 2;
        level.erase(std::unique(level.begin(), level.end()), level.end());
        for (const std::uint32_t node : level) {
            t.nodes[node] = t.nodes[2 * node + 1];
            t.nodes[node].add(t.nodes[2 * node + 2]);
        }
    }
}

template <int K>
std::size_t KDopTree<K>::bytes() const {
    return impl_->order.capacity() * sizeof(std::uint32_t) +
           impl_->leaf_of.capacity() * sizeof(std::uint32_t) +
           impl_->nodes.capacity() * sizeof(Dop<K>);
}

template class KDopTree<6>;
template class KDopTree<14>;
template class KDopTree<18>;
template class KDopTree<26>;

}  // namespace beltgrinding

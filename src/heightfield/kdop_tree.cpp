// Own code, because no library has boxes of K slabs that are asked for the reach of a wheel.

#include "heightfield/kdop_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr std::uint32_t kSequential = 512;  // below this many leaves one thread builds

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

}  // namespace

/// A binary tree in preorder: a node over n leaves has 2n - 1 nodes, the first child follows it and
/// has n / 2 leaves, so that no links need to be stored.
template <int K>
struct KDopTree<K>::Impl {
    std::vector<std::uint32_t> order;  // samples as they lie in the leaves
    std::vector<Dop<K>> nodes;
    std::uint32_t leaves = 0;

    std::size_t leaf_begin(std::uint32_t leaf) const {
        return std::min(order.size(), std::size_t{kLeafSize} * leaf);
    }
    std::span<const std::uint32_t> leaf(std::uint32_t number) const {
        return std::span(order).subspan(leaf_begin(number),
                                        leaf_begin(number + 1) - leaf_begin(number));
    }
    void build(const HeightField& field, std::uint32_t node, std::uint32_t first,
               std::uint32_t count);
    void query(const Query& q, std::uint32_t node, std::uint32_t first, std::uint32_t count,
               std::vector<std::uint32_t>& found) const;
};

template <int K>
void KDopTree<K>::Impl::build(const HeightField& field, std::uint32_t node, std::uint32_t first,
                              std::uint32_t count) {
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(leaf_begin(first));
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(leaf_begin(first + count));
    Dop<K>& dop = nodes[node];
    dop.clear();
    if (count == 1) {
        std::sort(begin, end);
        for (auto s = begin; s != end; ++s) {
            dop.add(field.top(*s));
            dop.add(field.bottom(*s));
        }
        return;
    }
    Eigen::AlignedBox3d box;
    for (auto s = begin; s != end; ++s) box.extend(field.point[*s]);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t lower = count / 2;
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(leaf_begin(first + lower));
    std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
        const double pa = field.point[a][axis], pb = field.point[b][axis];
        return pa != pb ? pa < pb : a < b;
    });
    const std::uint32_t second = node + 2 * lower;
    const auto build_lower = [&] { build(field, node + 1, first, lower); };
    const auto build_upper = [&] { build(field, second, first + lower, count - lower); };
    if (count > kSequential) {
        parallel_both(build_lower, build_upper);
    } else {
        build_lower();
        build_upper();
    }
    dop = nodes[node + 1];
    dop.add(nodes[second]);
}

template <int K>
void KDopTree<K>::Impl::query(const Query& q, std::uint32_t node, std::uint32_t first,
                              std::uint32_t count, std::vector<std::uint32_t>& found) const {
    const Dop<K>& dop = nodes[node];
    for (std::size_t k = 0; k < K / 2; ++k) {
        if (dop.low[k] > q.high[k] || dop.high[k] < q.low[k]) return;
    }
    const Vec3 low(dop.low[0], dop.low[1], dop.low[2]);
    const Vec3 high(dop.high[0], dop.high[1], dop.high[2]);
    if (!sphere_meets(q.reach, 0.5 * (low + high), 0.5 * (high - low).norm())) return;
    if (count == 1) {
        found.push_back(first);
        return;
    }
    const std::uint32_t lower = count / 2;
    query(q, node + 1, first, lower, found);
    query(q, node + 2 * lower, first + lower, count - lower, found);
}

template <int K>
KDopTree<K>::KDopTree(const HeightField& field, const RunContext& context)
    : impl_(std::make_unique<Impl>()) {
    Impl& t = *impl_;
    const auto n = static_cast<std::uint32_t>(field.size());
    t.order.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) t.order[i] = i;
    t.leaves = n / kLeafSize + (n % kLeafSize != 0 ? 1 : 0);
    if (t.leaves == 0) return;
    t.nodes.resize(2 * static_cast<std::size_t>(t.leaves) - 1);
    t.build(field, 0, 0, t.leaves);
    context.throw_if_cancelled();
}

template <int K>
KDopTree<K>::~KDopTree() = default;
template <int K>
KDopTree<K>::KDopTree(KDopTree&&) noexcept = default;
template <int K>
KDopTree<K>& KDopTree<K>::operator=(KDopTree&&) noexcept = default;

template <int K>
std::uint32_t KDopTree<K>::leaves() const {
    return impl_->leaves;
}

template <int K>
std::span<const std::uint32_t> KDopTree<K>::leaf(std::uint32_t number) const {
    return impl_->leaf(number);
}

template <int K>
std::span<const std::uint32_t> KDopTree<K>::order() const {
    return impl_->order;
}

template <int K>
void KDopTree<K>::query(const WheelReach& reach, std::vector<std::uint32_t>& found) const {
    found.clear();
    if (impl_->leaves > 0) impl_->query(prepare<K>(reach), 0, 0, impl_->leaves, found);
}

template <int K>
void KDopTree<K>::extend(std::uint32_t leaf, const Vec3& point) {
    std::uint32_t node = 0, first = 0, count = impl_->leaves;
    impl_->nodes[node].add(point);
    while (count > 1) {
        const std::uint32_t lower = count / 2;
        const bool upper = leaf >= first + lower;
        node += upper ? 2 * lower : 1;
        first += upper ? lower : 0;
        count = upper ? count - lower : lower;
        impl_->nodes[node].add(point);
    }
}

template <int K>
std::size_t KDopTree<K>::bytes() const {
    return impl_->order.capacity() * sizeof(std::uint32_t) +
           impl_->nodes.capacity() * sizeof(Dop<K>);
}

template class KDopTree<6>;
template class KDopTree<14>;
template class KDopTree<18>;
template class KDopTree<26>;

}  // namespace beltgrinding

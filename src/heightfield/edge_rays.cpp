#include "heightfield/edge_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/large_memory.h"
#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLeastTurn = 30.0 * kDegree;     // of the normal, at an edge
constexpr double kLargestTurn = 170.0 * kDegree;  // more is a sheet's rim, which has no bisector
constexpr double kTogether = 0.1;                 // spacings between borders that are one edge
constexpr double kAgainst = -0.7;                 // cosine of their ways: each has its face left
constexpr double kLeastReach = 2.0;               // spacings from an edge in which rays lean
constexpr double kMostReach = 40.0;               // the same: a great depth must not cost hours
constexpr double kSameSide = 0.5;                 // cosine between normals of one face's one side
constexpr double kMostLean = 80.0 * kDegree;      // between ray and normal
constexpr std::size_t kBlock = 4096;              // samples per task
constexpr std::size_t kWayBlock = 256;            // ways per task
constexpr std::size_t kTriangleBlock = 1 << 16;   // triangles per task
constexpr float kFar = std::numeric_limits<float>::infinity();

/// A way along a border, from sample to sample, the face to the left; and the normals that the face
/// beyond it has there, once it is known to be sharp.
struct Way {
    std::uint32_t from = 0, to = 0;
    std::uint32_t beyond = 0;  // face
    Vec3f at_from = Vec3f::Zero(), at_to = Vec3f::Zero();
};

struct Nearest {
    double distance = 0.0, share = 0.0;  // mm; of the way
};

Nearest nearest_on(const HeightField& field, const Way& way, const Vec3& p) {
    const Vec3 a = field.point[way.from], along = field.point[way.to] - a;
    const double square = along.squaredNorm();
    const double share = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
    return {(p - a - share * along).norm(), share};
}

/// Ways by the cubes of `size` mm within `reach` of which they come.
class WayGrid {
  public:
    WayGrid(const HeightField& field, const std::vector<Way>& ways, double reach, double size)
        : size_(size) {
        // first[w + 1]: how many cubes come to way w, then where its entries end.
        std::vector<std::size_t> first(ways.size() + 1, 0);
        const auto corners = [&](std::size_t w) {
            Box box(field.point[ways[w].from]);
            box.extend(field.point[ways[w].to]);
            return std::pair(cube_of(box.min() - Vec3::Constant(reach)),
                             cube_of(box.max() + Vec3::Constant(reach)));
        };
        parallel_blocks(ways.size(), kWayBlock, {}, [&](std::size_t begin, std::size_t end) {
            for (std::size_t w = begin; w < end; ++w) {
                const auto [low, high] = corners(w);
                first[w + 1] = static_cast<std::size_t>((high - low + Cube::Constant(1)).prod());
            }
        });
        for (std::size_t w = 0; w < ways.size(); ++w) first[w + 1] += first[w];
        resize_large(entries_, first.back());
        parallel_blocks(ways.size(), kWayBlock, {}, [&](std::size_t begin, std::size_t end) {
            for (std::size_t w = begin; w < end; ++w) {
                const auto [low, high] = corners(w);
                auto* out = entries_.data() + first[w];
                for (std::int64_t x = low.x(); x <= high.x(); ++x)
                    for (std::int64_t y = low.y(); y <= high.y(); ++y)
                        for (std::int64_t z = low.z(); z <= high.z(); ++z)
                            *out++ = {key(Cube(x, y, z)), static_cast<std::uint32_t>(w)};
            }
        });
        parallel_sort(entries_);
    }

    using Entries = std::vector<std::pair<std::uint64_t, std::uint32_t>>;
    /// A cube's entries, kept from place to place: neighbours mostly share it.
    struct Neighbourhood {
        std::uint64_t key = ~std::uint64_t{0};
        Entries::const_iterator begin, end;
    };

    /// Calls visit(way) for those that may be within the reach of `p`, in a fixed order.
    template <class Visit>
    void near(const Vec3& p, Neighbourhood& last, Visit visit) const {
        const std::uint64_t here = key(cube_of(p));
        if (here != last.key) {
            const auto before = [](const auto& entry, std::uint64_t k) { return entry.first < k; };
            last.key = here;
            last.begin = std::lower_bound(entries_.begin(), entries_.end(), here, before);
            last.end = std::lower_bound(last.begin, entries_.end(), here + 1, before);
        }
        for (auto at = last.begin; at != last.end; ++at) visit(at->second);
    }

  private:
    using Cube = Eigen::Matrix<std::int64_t, 3, 1>;
    Cube cube_of(const Vec3& p) const { return (p / size_).array().floor().cast<std::int64_t>(); }
    static std::uint64_t key(const Cube& c) {  // cubes that share one cost time, not truth
        constexpr std::uint64_t kBits = (1U << 21U) - 1U;
        return (static_cast<std::uint64_t>(c.x()) & kBits) << 42U |
               (static_cast<std::uint64_t>(c.y()) & kBits) << 21U |
               (static_cast<std::uint64_t>(c.z()) & kBits);
    }

    double size_;
    Entries entries_;
};

std::vector<Way> ways_along_borders(const HeightField& field) {
    using Side = std::pair<std::uint32_t, std::uint32_t>;
    const std::size_t blocks = (field.triangles.size() + kTriangleBlock - 1) / kTriangleBlock;
    std::vector<std::vector<Side>> of_block(blocks);
    parallel_blocks(field.triangles.size(), kTriangleBlock, {},
                    [&](std::size_t begin, std::size_t end) {
                        std::vector<Side>& found = of_block[begin / kTriangleBlock];
                        for (std::size_t i = begin; i < end; ++i) {
                            const Triangle& t = field.triangles[i];
                            for (std::size_t k = 0; k < 3; ++k) {
                                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                                if ((field.flags[a] & field.flags[b] & kOnBoundary) != 0)
                                    found.emplace_back(a, b);
                            }
                        }
                    });
    std::vector<Side> found;
    for (const std::vector<Side>& some : of_block)
        found.insert(found.end(), some.begin(), some.end());
    std::sort(found.begin(), found.end());
    std::vector<Way> ways;
    for (const auto& [a, b] : found)
        if (!std::binary_search(found.begin(), found.end(), std::pair(b, a)))
            ways.push_back({a, b, 0, Vec3f::Zero(), Vec3f::Zero()});
    return ways;
}

double angle_between(const Vec3f& a, const Vec3f& b) {
    return std::atan2(static_cast<double>(a.cross(b).norm()), static_cast<double>(a.dot(b)));
}

/// The ways on sharp convex edges, each with the normals beyond it.
std::vector<Way> sharp_ways(const HeightField& field) {
    const std::vector<Way> ways = ways_along_borders(field);
    const double together = kTogether * field.spacing;
    const WayGrid grid(field, ways, together, field.spacing);
    // The normal beyond `way` at `p`, which is on it; zero where the edge is not sharp.
    const auto beyond = [&](const Way& way, std::uint32_t sample, WayGrid::Neighbourhood& last,
                            std::uint32_t& face) {
        const Vec3 p = field.point[sample];
        const Vec3f normal = field.normal[sample];
        const Vec3f along = (field.point[way.to] - field.point[way.from]).cast<float>();
        const Vec3f into = normal.cross(along);
        Vec3f found = Vec3f::Zero();
        double least = together;
        grid.near(p, last, [&](std::uint32_t w) {
            const Way& other = ways[w];
            if (field.face[other.from] == field.face[way.from]) return;
            const auto [distance, share] = nearest_on(field, other, p);
            if (distance > least) return;
            const Vec3f back = (field.point[other.to] - field.point[other.from]).cast<float>();
            if (back.dot(along) > static_cast<float>(kAgainst) * back.norm() * along.norm()) return;
            const auto part = static_cast<float>(share);
            const Vec3f mixed =
                (1.0F - part) * field.normal[other.from] + part * field.normal[other.to];
            const double turn = angle_between(mixed, normal);
            if (turn < kLeastTurn || turn > kLargestTurn || !(mixed.dot(into) < 0.0F)) return;
            least = distance;
            found = mixed.normalized();
            face = field.face[other.from];
        });
        return found;
    };
    std::vector<Way> found = ways;
    std::vector<char> is_sharp(ways.size(), 0);
    parallel_blocks(ways.size(), kWayBlock, {}, [&](std::size_t begin, std::size_t end) {
        WayGrid::Neighbourhood last;
        for (std::size_t w = begin; w < end; ++w) {
            Way& way = found[w];
            std::uint32_t one = 0, other = 0;
            way.at_from = beyond(way, way.from, last, one);
            way.at_to = beyond(way, way.to, last, other);
            if (way.at_from.isZero() || way.at_to.isZero() || one != other) continue;
            way.beyond = one;
            is_sharp[w] = 1;
        }
    });
    std::vector<Way> sharp;
    for (std::size_t w = 0; w < found.size(); ++w)
        if (is_sharp[w] != 0) sharp.push_back(found[w]);
    return sharp;
}

double reach_of(const HeightField& field, double turn) {
    return std::clamp(0.5 * turn * field.depth, kLeastReach * field.spacing,
                      kMostReach * field.spacing);
}

/// The nearest place of the edges to each face beyond.
struct Edge {
    std::uint32_t beyond;
    double distance;
    Vec3f normal;  // beyond
};

/// The edges of a sample's own face in whose reach it lies.
void edges_near(const HeightField& field, const std::vector<Way>& ways, const WayGrid& grid,
                std::uint32_t sample, WayGrid::Neighbourhood& last, std::vector<Edge>& edges) {
    edges.clear();
    const Vec3 p = field.point[sample];
    const Vec3f normal = field.normal[sample];
    const double farthest = reach_of(field, kLargestTurn);
    grid.near(p, last, [&](std::uint32_t w) {
        const Way& way = ways[w];
        if (field.face[way.from] != field.face[sample] ||
            field.normal[way.from].dot(normal) < static_cast<float>(kSameSide))
            return;
        const auto [distance, share] = nearest_on(field, way, p);
        const auto same = std::find_if(edges.begin(), edges.end(),
                                       [&](const Edge& e) { return e.beyond == way.beyond; });
        if (distance >= (same == edges.end() ? farthest : same->distance)) return;
        const auto part = static_cast<float>(share);
        const Vec3f mixed = ((1.0F - part) * way.at_from + part * way.at_to).normalized();
        const double turn = angle_between(mixed, normal);
        if (turn < kLeastTurn || turn > kLargestTurn || distance >= reach_of(field, turn)) return;
        if (same == edges.end())
            edges.push_back({way.beyond, distance, mixed});
        else
            *same = {way.beyond, distance, mixed};
    });
}

/// The ray of a normal that leans to edges: on an edge the bisector, in between by equal angles;
/// the part along the normal is 1.
Vec3f leaning(const HeightField& field, const Vec3f& normal, const std::vector<Edge>& edges) {
    Vec3 sum = normal.cast<double>();
    for (const Edge& edge : edges) {
        const double turn = angle_between(edge.normal, normal);
        const double lean = 0.5 * turn * (1.0 - edge.distance / reach_of(field, turn));
        sum += std::sin(lean) / std::sin(turn - lean) * edge.normal.cast<double>();
    }
    const Vec3 n = normal.cast<double>();
    const Vec3 aside = sum - sum.dot(n) * n;
    const double angle = std::min(std::atan2(aside.norm(), sum.dot(n)), kMostLean);
    if (!(aside.norm() > 0.0)) return normal;
    return (n + std::tan(angle) * aside.normalized()).cast<float>();
}

template <class Found>
void for_leaning(const HeightField& field, const std::vector<Way>& ways, const RunContext& context,
                 Found found) {
    const double reach = reach_of(field, kLargestTurn);
    const WayGrid grid(field, ways, reach, reach);
    parallel_blocks(field.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        std::vector<Edge> edges;
        WayGrid::Neighbourhood last;
        for (std::size_t i = begin; i < end; ++i) {
            edges_near(field, ways, grid, static_cast<std::uint32_t>(i), last, edges);
            if (!edges.empty()) found(i, edges);
        }
    });
}

}  // namespace

void lean_at_edges(HeightField& field, const RunContext& context) {
    const std::vector<Way> ways = sharp_ways(field);
    if (ways.empty()) return;
    std::vector<Vec3f> rays = field.normal;
    for_leaning(field, ways, context, [&](std::size_t i, const std::vector<Edge>& edges) {
        rays[i] = leaning(field, field.normal[i], edges);
    });
    field.rays = std::move(rays);
}

std::vector<float> edge_distances(const HeightField& field) {
    if (field.rays.empty()) return {};
    std::vector<float> distances(field.size(), kFar);
    for_leaning(field, sharp_ways(field), {}, [&](std::size_t i, const std::vector<Edge>& edges) {
        for (const Edge& edge : edges)
            distances[i] = std::min(distances[i], static_cast<float>(edge.distance));
    });
    return distances;
}

}  // namespace beltgrinding

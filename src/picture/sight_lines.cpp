#include "sight_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/large_memory.h"
#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr std::uint32_t kSteps = 1U << 10U;  // of the Morton curve, on each axis
constexpr std::uint32_t kDigit = 1U << 10U;  // of the radix sort
constexpr std::size_t kNodesOfTask = 1U << 10U;
constexpr std::size_t kTrianglesOfTask = 1U << 15U;
constexpr double kLeast = 1e-20;     // of a direction's components: their inverse is finite
constexpr float kSlack = 1.000002F;  // of a box's far end, for the rounding of both ends
constexpr double kPad = 2e-7;        // of the extents, by which a box is wider, for its rounding
constexpr double kWider = 1e-12;     // of a triangle: no line slips through between two

/// The lowest ten bits, two zeros between each and the next.
std::uint32_t spread(std::uint32_t bits) {
    bits = (bits | bits << 16U) & 0x030000FFU;
    bits = (bits | bits << 8U) & 0x0300F00FU;
    bits = (bits | bits << 4U) & 0x030C30C3U;
    return (bits | bits << 2U) & 0x09249249U;
}

}  // namespace

SightLines::Way::Way(const Vec3& direction) : direction_(direction) {
    for (int k = 0; k < 3; ++k) {
        const double part = std::copysign(std::max(std::abs(direction[k]), kLeast), direction[k]);
        inverse_[k] = static_cast<float>(1.0 / part);
        negative_[static_cast<std::size_t>(k)] = part < 0.0;
    }
}

SightLines::SightLines(std::vector<Mesh> meshes, const Box& extents)
    : meshes_(std::move(meshes)), origin_(extents.center()) {
    first_.push_back(0);
    for (const Mesh& mesh : meshes_)
        first_.push_back(first_.back() + static_cast<std::uint32_t>(mesh.triangles.size()));
    const std::vector<Item> items = along_curve(extents);
    resize_large(order_, items.size());
    for (std::size_t i = 0; i < items.size(); ++i) order_[i] = items[i].triangle;
    build_leaves(items, static_cast<float>(kPad * extents.diagonal().norm()));
}

std::vector<SightLines::Item> SightLines::along_curve(const Box& extents) const {
    std::vector<Item> items, sorted;
    resize_large(items, first_.back());
    const Vec3& low = extents.min();
    const Vec3 scale = (kSteps - 1) * extents.sizes().cwiseMax(1e-9).cwiseInverse() / 3.0;
    for (std::size_t k = 0; k < meshes_.size(); ++k) {
        const Mesh& mesh = meshes_[k];
        parallel_blocks(
            mesh.triangles.size(), kTrianglesOfTask, {}, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    const Triangle& t = mesh.triangles[i];
                    const Vec3 place = (mesh.vertices[t[0]] + mesh.vertices[t[1]] +
                                        mesh.vertices[t[2]] - 3.0 * low)
                                           .cwiseProduct(scale);
                    const auto step = [&](int axis) {
                        return spread(std::min(
                            static_cast<std::uint32_t>(std::max(place[axis], 0.0)), kSteps - 1));
                    };
                    const auto number = static_cast<std::uint32_t>(first_[k] + i);
                    items[number] = {step(0) << 2U | step(1) << 1U | step(2), number};
                }
            });
    }
    resize_large(sorted, items.size());
    for (unsigned shift = 0; shift < 30; shift += 10) {  // a radix sort keeps the order of equals
        std::array<std::size_t, kDigit> next{};
        for (const Item& item : items) ++next[item.key >> shift & (kDigit - 1)];
        std::size_t so_far = 0;
        for (std::size_t& place : next) so_far += std::exchange(place, so_far);
        for (const Item& item : items) sorted[next[item.key >> shift & (kDigit - 1)]++] = item;
        items.swap(sorted);
    }
    return items;
}

void SightLines::build_leaves(const std::vector<Item>& items, float pad) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Node nothing;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        nothing.low[axis].fill(kInfinity);
        nothing.high[axis].fill(-kInfinity);
    }
    const auto take = [](Node& node, std::size_t branch, const Vec3f& low, const Vec3f& high) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis);
            node.low[at][branch] = std::min(node.low[at][branch], low[axis]);
            node.high[at][branch] = std::max(node.high[at][branch], high[axis]);
        }
    };
    const std::size_t leaves = (items.size() + kBranches - 1) / kBranches;
    std::vector<Node> lowest((leaves + kBranches - 1) / kBranches, nothing);
    parallel_blocks(lowest.size(), kNodesOfTask, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            for (std::size_t i = n * kBranches * kBranches;
                 i < std::min((n + 1) * kBranches * kBranches, items.size()); ++i) {
                std::size_t k = 0;
                while (items[i].triangle >= first_[k + 1]) ++k;
                const Triangle& t = meshes_[k].triangles[items[i].triangle - first_[k]];
                for (const std::uint32_t corner : t) {
                    const Vec3f p = (meshes_[k].vertices[corner] - origin_).cast<float>();
                    take(lowest[n], i / kBranches % kBranches, p.array() - pad, p.array() + pad);
                }
            }
        }
    });
    levels_.push_back(std::move(lowest));
    while (levels_.front().size() > 1) {
        const std::vector<Node>& below = levels_.front();
        std::vector<Node> above((below.size() + kBranches - 1) / kBranches, nothing);
        for (std::size_t n = 0; n < below.size(); ++n) {
            Vec3f low, high;
            for (int axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<std::size_t>(axis);
                low[axis] = *std::min_element(below[n].low[at].begin(), below[n].low[at].end());
                high[axis] = *std::max_element(below[n].high[at].begin(), below[n].high[at].end());
            }
            take(above[n / kBranches], n % kBranches, low, high);
        }
        levels_.insert(levels_.begin(), std::move(above));
    }
}

bool SightLines::hidden(const Vec3& point, const Way& way, double near) const {
    const Vec3f from = (point - origin_).cast<float>();
    struct Entry {
        std::uint32_t level, node;
    };
    std::array<Entry, 128> stack;  // seven of each of the levels at most stay behind
    std::size_t waiting = 0;
    stack[waiting++] = {0, 0};
    while (waiting > 0) {
        const Entry entry = stack[--waiting];
        const Node& node = levels_[entry.level][entry.node];
        std::array<float, kBranches> enter, leave;
        enter.fill(0.0F);
        leave.fill(std::numeric_limits<float>::infinity());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& nearer = way.negative_[axis] ? node.high[axis] : node.low[axis];
            const auto& farther = way.negative_[axis] ? node.low[axis] : node.high[axis];
            const float inverse = way.inverse_[static_cast<int>(axis)];
            const float start = from[static_cast<int>(axis)];
            for (std::size_t b = 0; b < kBranches; ++b) {
                const float t0 = (nearer[b] - start) * inverse;
                const float t1 = (farther[b] - start) * inverse * kSlack;
                enter[b] = t0 > enter[b] ? t0 : enter[b];
                leave[b] = t1 < leave[b] ? t1 : leave[b];
            }
        }
        for (std::size_t b = 0; b < kBranches; ++b) {
            if (!(enter[b] <= leave[b]) || static_cast<double>(leave[b]) < near) continue;
            const auto branch = static_cast<std::uint32_t>(entry.node * kBranches + b);
            if (entry.level + 1 < levels_.size()) {
                stack[waiting++] = {entry.level + 1, branch};
                continue;
            }
            const std::size_t begin = std::size_t{branch} * kBranches;
            for (std::size_t i = begin; i < std::min(begin + kBranches, order_.size()); ++i) {
                if (met(order_[i], point, way, near)) return true;
            }
        }
    }
    return false;
}

/// Moeller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997.
bool SightLines::met(std::uint32_t triangle, const Vec3& point, const Way& way, double near) const {
    std::size_t k = 0;
    while (triangle >= first_[k + 1]) ++k;
    const Triangle& t = meshes_[k].triangles[triangle - first_[k]];
    const Vec3& a = meshes_[k].vertices[t[0]];
    const Vec3 ab = meshes_[k].vertices[t[1]] - a, ac = meshes_[k].vertices[t[2]] - a;
    const Vec3 p = way.direction_.cross(ac);
    const double det = ab.dot(p);
    if (det == 0.0) return false;
    const Vec3 from = point - a;
    const double u = from.dot(p) / det;
    if (!(u >= -kWider && u <= 1.0 + kWider)) return false;
    const Vec3 q = from.cross(ab);
    const double v = way.direction_.dot(q) / det;
    if (!(v >= -kWider && u + v <= 1.0 + kWider)) return false;
    return ac.dot(q) / det >= near;
}

}  // namespace beltgrinding

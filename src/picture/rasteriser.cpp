#include "rasteriser.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/lanes.h"
#include "base/large_memory.h"
#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kVerticesOfBlock = 64;  // that are projected or passed over together
constexpr std::size_t kBlocksOfTask = 1U << 9U;
constexpr std::size_t kChunksOfTask = 1U << 8U;
constexpr double kBeside =
    1e-5;  // of places in the picture, and in rays: far beyond their rounding
constexpr std::size_t kAtOnce = 4;  // columns
using Lanes = double __attribute__((vector_size(8 * kAtOnce)));
constexpr float kNarrow = 4.0F;  // columns, up to which all rays of a row are tried

/// A triangle's edge, seen from its third corner's side: a ray's signed distance from it, times
/// its length. Its ends are put in order first, so that both neighbours find the same number for
/// a ray, to the bit, and no ray slips through between them.
class Edge {
  public:
    BELTGRINDING_INLINE Edge(double px, double py, double qx, double qy) {
        const bool turned = qx < px || (qx == px && qy < py);
        x_ = turned ? qx : px;
        y_ = turned ? qy : py;
        dx_ = turned ? px - qx : qx - px;
        dy_ = turned ? py - qy : qy - py;
        sign_ = turned ? -1.0 : 1.0;
    }
    void turn() { sign_ = -sign_; }
    /// Readies it for a row.
    void at_row(double y) { row_ = dx_ * (y - y_); }
    BELTGRINDING_INLINE Lanes at(const Lanes& x) const { return sign_ * (row_ - dy_ * (x - x_)); }
    /// Narrows the row's columns [from, to] to about those on the inner side.
    BELTGRINDING_INLINE void narrow(double& from, double& to) const {
        const double slope = sign_ * dy_;
        if (slope == 0.0) return;
        const double x = x_ + row_ / dy_;
        if (slope > 0.0) {
            to = std::min(to, x + 1.0);
        } else {
            from = std::max(from, x - 1.0);
        }
    }

  private:
    double x_, y_, dx_, dy_, sign_, row_ = 0.0;
};

/// What is the same of a triangle in all its rows.
struct Plane {
    std::uint32_t triangle;
    double depth, to_b, to_c;  // of its first corner; what the others are farther
    float nearest;             // what lies before is not met
};

/// Draws the columns [from, to] of a row, kAtOnce of them together.
BELTGRINDING_INLINE void draw_row(const std::array<Edge, 3>& edges, double from, double to,
                                  const Plane& plane, RayHit* row) {
    for (double x = from; x <= to; x += kAtOnce) {
        const Lanes columns = x + Lanes{0.0, 1.0, 2.0, 3.0};
        const Lanes wa = edges[0].at(columns), wb = edges[1].at(columns), wc = edges[2].at(columns);
        const Lanes whole = wa + wb + wc;
        const auto inside =
            (wa >= 0.0) & (wb >= 0.0) & (wc >= 0.0) & (whole > 0.0) & (columns <= to);
        if ((inside[0] | inside[1] | inside[2] | inside[3]) == 0) continue;
        const Lanes u = wb / whole, v = wc / whole;
        const Lanes depth = plane.depth + u * plane.to_b + v * plane.to_c;
        RayHit* hit = row + static_cast<std::size_t>(x);
        for (std::size_t k = 0; k < kAtOnce; ++k) {
            if (inside[k] == 0) continue;
            const auto there = static_cast<float>(depth[k]);
            if (there < hit[k].depth && there >= plane.nearest)
                hit[k] = {there, plane.triangle, static_cast<float>(u[k]),
                          static_cast<float>(v[k])};
        }
    }
}

BELTGRINDING_INLINE std::uint32_t number_of(std::span<const std::uint32_t> first,
                                            std::uint32_t triangle) {
    std::uint32_t mesh = 0;
    while (triangle >= first[mesh + 1]) ++mesh;
    return mesh;
}

}  // namespace

std::vector<Box> boxes_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    std::vector<Box> boxes((triangles.size() + kTrianglesOfBox - 1) / kTrianglesOfBox);
    parallel_blocks(boxes.size(), kChunksOfTask, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t past = std::min((b + 1) * kTrianglesOfBox, triangles.size());
            for (std::size_t i = b * kTrianglesOfBox; i < past; ++i)
                for (const std::uint32_t v : triangles[i]) boxes[b].extend(vertices[v]);
        }
    });
    return boxes;
}

void Rasteriser::lay_out(std::span<const Mesh> meshes, const RayGrid& grid, std::uint32_t band,
                         const RunContext& context) {
    grid_ = grid;
    band_ = band;
    bands_ = (grid.rows - 1 + band - 1) / band;
    meshes_.clear();
    first_.assign(1, 0);
    first_corner_.clear();
    for (const Mesh& mesh : meshes) {
        meshes_.push_back(mesh.triangles);
        first_.push_back(first_.back() + static_cast<std::uint32_t>(mesh.triangles.size()));
    }
    choose(meshes);
    project(meshes, context);
    sort_into_bands(context);
}

bool Rasteriser::beside(const Box& box) const {
    const Vec3 middle = box.center() - grid_.corner, half = 0.5 * box.sizes();
    const auto outside = [&](const Vec3& axis, double last) {
        const double at = middle.dot(axis), reach = half.dot(axis.cwiseAbs());
        const double pad = 1.0 + kBeside * (std::abs(at) + reach);
        return at + reach + pad < 0.0 || at - reach - pad > last;
    };
    return outside(grid_.right / grid_.right.squaredNorm(), grid_.columns - 1) ||
           outside(grid_.down / grid_.down.squaredNorm(), grid_.rows - 1);
}

void Rasteriser::choose(std::span<const Mesh> meshes) {
    chunks_.clear();
    for (std::uint32_t k = 0; k < meshes.size(); ++k) {
        const std::size_t count = meshes[k].triangles.size();
        for (std::size_t begin = 0; begin < count; begin += kTrianglesOfBox) {
            const std::span<const Box> boxes = meshes[k].boxes;
            if (!boxes.empty() && beside(boxes[begin / kTrianglesOfBox])) continue;
            chunks_.push_back(
                {k, static_cast<std::uint32_t>(begin),
                 static_cast<std::uint32_t>(std::min(begin + kTrianglesOfBox, count))});
        }
    }
}

void Rasteriser::project(std::span<const Mesh> meshes, const RunContext& context) {
    std::size_t count = 0;
    for (const Mesh& mesh : meshes) {
        first_corner_.push_back(static_cast<std::uint32_t>(count));
        count += mesh.vertices.size();
    }
    resize_large(corners_, count);
    mark_corners(meshes, count, context);
    const Vec3 right = grid_.right / grid_.right.squaredNorm();
    const Vec3 down = grid_.down / grid_.down.squaredNorm();
    parallel_blocks(asked_.size(), kBlocksOfTask, context, [&](std::size_t begin, std::size_t end) {
        std::size_t k = 0;
        for (std::size_t block = begin; block < end; ++block) {
            if (asked_[block] == 0) continue;
            const std::size_t past = std::min((block + 1) * kVerticesOfBlock, count);
            for (std::size_t i = block * kVerticesOfBlock; i < past; ++i) {
                while (i >= first_corner_[k] + meshes[k].vertices.size()) ++k;
                const Vec3 p = meshes[k].vertices[i - first_corner_[k]] - grid_.corner;
                corners_[i] = {static_cast<float>(p.dot(right)), static_cast<float>(p.dot(down)),
                               static_cast<float>(p.dot(grid_.into))};
            }
        }
    });
}

void Rasteriser::mark_corners(std::span<const Mesh> meshes, std::size_t count,
                              const RunContext& context) {
    std::size_t all = 0;
    for (const Mesh& mesh : meshes)
        all += (mesh.triangles.size() + kTrianglesOfBox - 1) / kTrianglesOfBox;
    const std::size_t blocks = (count + kVerticesOfBlock - 1) / kVerticesOfBlock;
    asked_.assign(blocks, chunks_.size() == all ? 1 : 0);
    if (chunks_.size() == all) return;
    parallel_blocks(
        chunks_.size(), kChunksOfTask, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                const Chunk& chunk = chunks_[c];
                for (std::uint32_t i = chunk.begin; i < chunk.end; ++i) {
                    for (const std::uint32_t v : meshes_[chunk.mesh][i]) {
                        const std::size_t block =
                            (first_corner_[chunk.mesh] + v) / kVerticesOfBlock;
                        std::atomic_ref(asked_[block]).store(1, std::memory_order_relaxed);
                    }
                }
            }
        });
}

void Rasteriser::sort_into_bands(const RunContext& context) {
    const std::size_t tasks = (chunks_.size() + kChunksOfTask - 1) / kChunksOfTask;
    resize_large(reached_, chunks_.size() * kTrianglesOfBox);
    std::vector<std::size_t> counted(tasks * bands_, 0);  // by task and band
    const auto last_column = static_cast<float>(grid_.columns - 1);
    const auto last_row = static_cast<float>(grid_.rows - 1);
    const auto nearest = static_cast<float>(-grid_.start);
    const auto bands_of = [&](const Corner& a, const Corner& b, const Corner& c) {
        const float left = std::max(std::min({a.x, b.x, c.x}), 0.0F);
        const float right = std::min(std::max({a.x, b.x, c.x}), last_column);
        const float top = std::max(std::min({a.y, b.y, c.y}), 0.0F);
        const float bottom = std::min(std::max({a.y, b.y, c.y}), last_row);
        // Of dense samples many lie between two rays.
        if (!(std::ceil(left) <= std::floor(right)) || !(std::ceil(top) <= std::floor(bottom)) ||
            std::max({a.depth, b.depth, c.depth}) < nearest)
            return Bands{0, 0};
        const auto upper = static_cast<std::uint32_t>(std::ceil(top));
        const auto lower = static_cast<std::uint32_t>(std::floor(bottom));
        const std::uint32_t from = upper == 0 ? 0 : (upper - 1) / band_;
        const std::uint32_t to = std::min(lower / band_, bands_ - 1) + 1;
        return Bands{static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(to)};
    };
    parallel_blocks(
        chunks_.size(), kChunksOfTask, context, [&](std::size_t begin, std::size_t end) {
            std::size_t* found = counted.data() + begin / kChunksOfTask * bands_;
            for (std::size_t c = begin; c < end; ++c) {
                const Chunk& chunk = chunks_[c];
                const Corner* corners = corners_.data() + first_corner_[chunk.mesh];
                Bands* reached = reached_.data() + c * kTrianglesOfBox;
                for (std::uint32_t i = chunk.begin; i < chunk.end; ++i) {
                    const Triangle& t = meshes_[chunk.mesh][i];
                    const Bands bands = bands_of(corners[t[0]], corners[t[1]], corners[t[2]]);
                    *reached++ = bands;
                    for (std::uint32_t b = bands.from; b < bands.to; ++b) ++found[b];
                }
            }
        });
    begin_.resize(bands_ + 1);
    std::size_t so_far = 0;
    for (std::uint32_t b = 0; b < bands_; ++b) {
        begin_[b] = so_far;
        for (std::size_t t = 0; t < tasks; ++t) {
            const std::size_t here = counted[t * bands_ + b];
            counted[t * bands_ + b] = so_far;
            so_far += here;
        }
    }
    begin_[bands_] = so_far;
    resize_large(order_, so_far);
    parallel_blocks(chunks_.size(), kChunksOfTask, context,
                    [&](std::size_t begin, std::size_t end) {
                        std::size_t* next = counted.data() + begin / kChunksOfTask * bands_;
                        for (std::size_t c = begin; c < end; ++c) {
                            const Chunk& chunk = chunks_[c];
                            const Bands* reached = reached_.data() + c * kTrianglesOfBox;
                            for (std::uint32_t i = chunk.begin; i < chunk.end; ++i, ++reached) {
                                for (std::uint32_t b = reached->from; b < reached->to; ++b)
                                    order_[next[b]++] = first_[chunk.mesh] + i;
                            }
                        }
                    });
}

BELTGRINDING_INLINE void Rasteriser::draw(std::uint32_t triangle, std::uint32_t first_row,
                                          std::span<RayHit> hits) const {
    const std::uint32_t mesh = number_of(first_, triangle);
    const Triangle& t = meshes_[mesh][triangle - first_[mesh]];
    const Corner* corners = corners_.data() + first_corner_[mesh];
    const Corner &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
    const double ax = a.x, ay = a.y, bx = b.x, by = b.y, cx = c.x, cy = c.y;
    const double twice_area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (twice_area == 0.0) return;
    std::array<Edge, 3> edges{Edge(bx, by, cx, cy), Edge(cx, cy, ax, ay), Edge(ax, ay, bx, by)};
    if (twice_area < 0.0) {
        for (Edge& edge : edges) edge.turn();
    }
    const auto last_column = static_cast<float>(grid_.columns - 1);
    const float left = std::ceil(std::max(std::min({a.x, b.x, c.x}), 0.0F));
    const float right = std::floor(std::min(std::max({a.x, b.x, c.x}), last_column));
    const auto from_row = static_cast<float>(first_row);
    const float to_row =
        std::min(static_cast<float>(first_row + band_), static_cast<float>(grid_.rows - 1));
    const float top = std::ceil(std::max(std::min({a.y, b.y, c.y}), from_row));
    const float bottom = std::floor(std::min(std::max({a.y, b.y, c.y}), to_row));
    const double depth = a.depth, to_b = static_cast<double>(b.depth) - depth,
                 to_c = static_cast<double>(c.depth) - depth;
    const auto nearest = static_cast<float>(-grid_.start);
    for (float y = top; y <= bottom; y += 1.0F) {
        double from = left, to = right;
        for (Edge& edge : edges) {
            edge.at_row(y);
            if (right - left > kNarrow) edge.narrow(from, to);
        }
        if (!(from <= to)) continue;
        draw_row(edges, std::ceil(from), std::floor(to), {triangle, depth, to_b, to_c, nearest},
                 hits.data() + static_cast<std::size_t>(y - from_row) * grid_.columns);
    }
}

BELTGRINDING_CLONES void Rasteriser::rasterise(std::uint32_t b, std::span<RayHit> hits) const {
    std::fill(hits.begin(), hits.end(), RayHit{});
    for (std::size_t k = begin_[b]; k < begin_[b + 1]; ++k) draw(order_[k], b * band_, hits);
}

}  // namespace beltgrinding

#pragma once

// Private to this room: which triangle each ray of an orthographic picture meets first.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// The first triangle that a ray meets.
struct RayHit {
    float depth = std::numeric_limits<float>::infinity();  ///< mm; infinite: none
    std::uint32_t triangle = 0;                            ///< counted through all meshes
    float u = 0.0F, v = 0.0F;  ///< weights of the triangle's second and third vertex
    bool met() const { return depth < std::numeric_limits<float>::infinity(); }
};

/// Parallel rays on a grid: the ray in column x and row y passes at corner + x right + y down.
struct RayGrid {
    Vec3 corner;       ///< mm
    Vec3 right, down;  ///< mm from one ray to the next, at a right angle
    Vec3 into;         ///< unit vector along the rays
    double start;      ///< mm before the corner's plane: what lies before it is not met
    std::uint32_t columns, rows;
};

/// Neighbours in the order of a mesh's triangles: with their box, all of them are passed over that
/// lie beside a picture.
constexpr std::size_t kTrianglesOfBox = 256;

/// The boxes of each kTrianglesOfBox of `triangles`.
std::vector<Box> boxes_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/// Triangles laid out for a grid of rays. A row is rasterised by itself; neighbours that share
/// an edge, or whose vertices lie in the same places, leave no gap: a ray on their edge meets both.
/// Of triangles equally far the first counts.
class Rasteriser {
  public:
    struct Mesh {
        std::span<const Vec3> vertices;  ///< mm; what is given must outlive the rasteriser
        std::span<const Triangle> triangles;
        std::span<const Box> boxes{};  ///< boxes_of them; empty: none is passed over
    };
    /// Lays the meshes out for a grid, in place of the one before, whose memory it uses again.
    /// `band`: rows that are asked for together. Throws Cancelled.
    void lay_out(std::span<const Mesh> meshes, const RayGrid& grid, std::uint32_t band,
                 const RunContext& context);

    std::uint32_t bands() const { return bands_; }
    /// What the rays of band `b` meet, row by row: rows band * b to band * (b + 1), the last
    /// included as it is the next band's first; (band + 1) * columns in all. Safe from many
    /// threads.
    void rasterise(std::uint32_t b, std::span<RayHit> hits) const;

  private:
    struct Bands {
        std::uint16_t from, to;  ///< to: past the last
    };
    struct Corner {
        float x, y;   ///< columns and rows
        float depth;  ///< mm from the corner's plane
    };
    /// Triangles of a mesh that follow one another, kTrianglesOfBox at most.
    struct Chunk {
        std::uint32_t mesh, begin, end;
    };
    void choose(std::span<const Mesh> meshes);
    bool beside(const Box& box) const;
    void project(std::span<const Mesh> meshes, const RunContext& context);
    /// Which blocks of vertices the chunks need.
    void mark_corners(std::span<const Mesh> meshes, std::size_t count, const RunContext& context);
    void sort_into_bands(const RunContext& context);
    void draw(std::uint32_t triangle, std::uint32_t first_row, std::span<RayHit> hits) const;

    RayGrid grid_{};
    std::uint32_t band_ = 0, bands_ = 0;
    std::vector<Corner> corners_;                      // of all meshes, where they are asked for
    std::vector<std::uint8_t> asked_;                  // of blocks of corners
    std::vector<std::span<const Triangle>> meshes_;    // their triangles
    std::vector<std::uint32_t> first_, first_corner_;  // of each mesh; first_ has an end
    std::vector<Chunk> chunks_;                        // those that may be met
    std::vector<Bands> reached_;                       // by each place of each chunk
    std::vector<std::uint32_t> order_;                 // triangles by band
    std::vector<std::size_t> begin_;                   // of each band in order_, and the end
};

}  // namespace beltgrinding

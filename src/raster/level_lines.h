#pragma once

// Private to this room: level lines of a scalar on triangles.

#include <array>
#include <cstdint>
#include <vector>

#include "raster/raster.h"

namespace beltgrinding {

/// Triangles with the scalar and the normals of their own corners.
struct LevelMesh {
    std::vector<Vec3> point;  ///< mm
    std::vector<Triangle> triangles;
    std::vector<std::array<double, 3>> scalar;
    std::vector<std::array<Vec3, 3>> normal;
    std::vector<std::size_t> part;  ///< a level crosses only the triangles of its own part
};

struct Level {
    double value = 0.0;
    std::size_t part = 0;
};

/// For each point the one that stands for it: points on open edges (those of one triangle only)
/// that lie within `tolerance` mm of each other become one.
std::vector<std::uint32_t> welded(const std::vector<Vec3>& point,
                                  const std::vector<Triangle>& triangles, double tolerance);

/// The level lines (`RasterLine::level` is the index in `levels`), ended where the normal jumps by
/// more than `split_turn`, normals averaged over `smoothing` mm. Marching triangles.
std::vector<RasterLine> level_lines(const LevelMesh& mesh, const std::vector<Level>& levels,
                                    double period, double split_turn, double smoothing,
                                    const RunContext& context);

}  // namespace beltgrinding

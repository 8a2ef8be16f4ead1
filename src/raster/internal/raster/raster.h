#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// A triangulated surface with a scalar whose level lines are the passes of a raster.
struct RasterSurface {
    std::vector<Vec3> point;          ///< mm, work frame
    std::vector<Vec3> normal;         ///< unit, out of the workpiece
    std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
    /// The scalar at the three corners of every triangle; NaN: not known there.
    std::vector<std::array<double, 3>> scalar;
    double period = 0.0;  ///< of the scalar, where the surface is closed (a seam); 0: none
    /// Of the triangles, those on which lines are wanted; empty: all. Where the levels lie is by
    /// all of them.
    std::vector<char> wanted;
};

/// How passes lie beside each other.
enum class RasterSpacing {
    /// Level lines of the scalar itself: planes or isoparametric lines. The step-over is kept where
    /// neighbours are farthest apart.
    kLines,
    /// Lines at equal distance on the surface from the scalar's middle level line.
    kEven,
};

struct RasterOptions {
    double step_over = 10.0;  ///< mm on the surface, at most
    RasterSpacing spacing = RasterSpacing::kLines;
    double weld = 0.0;          ///< mm, vertices nearer than that are one (edges between faces)
    double split_turn = 0.7;    ///< rad, a pass ends where the normal jumps by more
    double smoothing = 0.0;     ///< mm of the pass over which the normal is averaged; 0: none
    std::size_t most = 10'000;  ///< passes; more are refused
};

/// A connected piece of a level line. Its direction keeps higher values of the scalar to the left,
/// seen from outside.
struct RasterLine {
    std::vector<Vec3> point;    ///< mm
    std::vector<Vec3> normal;   ///< unit
    std::vector<Vec3> tangent;  ///< unit, perpendicular to the normal
    std::size_t level = 0;      ///< pieces of one level line have the same number, ascending
    bool closed = false;        ///< the last point is the first one again
};

struct RasterLines {
    std::vector<RasterLine> lines;  ///< by level
    std::vector<double> distance;   ///< mm from each level to the next, where they are farthest
    double uncovered_area = 0.0;    ///< mm2 that no level line can come near to
    double area = 0.0;              ///< mm2 of all triangles
};

/// The passes of a raster, `options.step_over` mm apart at most and half of it from the border.
///
/// kLines: the distance between neighbouring levels is the integral of dc / |grad c|, |grad c| the
/// least over the surface at level c; where that is below a tenth of the usual one (a face that
/// lies in the cutting planes, a pole), the distance is not kept and the area counts as uncovered.
/// kEven: iso-distance passes, whose scallops are even (Kimmel, Bruckstein: Shape offsets via level
/// sets, Computer-Aided Design 25, 1993); distances by fast marching on the triangles (Kimmel,
/// Sethian: Computing geodesic paths on manifolds, PNAS 95, 1998); each connected part has its own.
///
/// Throws InputError for a step-over that is not positive or gives too many passes; Cancelled.
RasterLines raster_lines(const RasterSurface& surface, const RasterOptions& options,
                         const RunContext& context = {});

struct PoseSpacing {
    double chord_error = 0.02;  ///< mm, between the straight way of two poses and the pass
    double max_distance = 10;   ///< mm
    double max_turn = 0.1;      ///< rad, of the normal and of the tangent
    /// mm from the robot's tool centre point to the contact: a turn by t bends the contact's way by
    /// about lever t^2 / 8, which counts as chord error.
    double lever = 0.0;
};

/// Indices of the line's points that are enough as poses: the first, the last, and as few between
/// as the limits allow. A step between neighbouring points that breaks a limit is kept as it is.
std::vector<std::size_t> thin(const RasterLine& line, const PoseSpacing& spacing);

}  // namespace beltgrinding

#pragma once

// Private to this room: the trimming edges of a face, as chains of samples in the sampler's plane.

#include <Geom2d_Curve.hxx>
#include <TopoDS_Face.hxx>
#include <cstdint>
#include <string>
#include <vector>

#include "delaunay.h"
#include "face_surface.h"

namespace beltgrinding {

/// One use of an edge by the face. A seam is used twice, with two curves.
struct TrimCurve {
    Handle(Geom2d_Curve) curve;  ///< in the surface's u, v
    double first = 0, last = 0;
    int edge = 0;                           ///< same number for both uses of a seam
    int vertex_first = 0, vertex_last = 0;  ///< at the curve's ends, by parameter
    double tolerance = 0;                   ///< mm, of the edge's vertices
    bool degenerate = false;                ///< no length: a pole
};

/// All edges of a face, and the box of its parameters.
struct TrimCurves {
    std::vector<TrimCurve> curves;
    std::vector<int> uses;  ///< by edge number; 2 for a seam
    int vertices = 0;
    double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
};

/// Throws std::runtime_error saying what is missing (an edge without a curve on the surface, no
/// edges at all).
TrimCurves collect_trim_curves(const TopoDS_Face& face);

/// A sample while its face is being built.
struct RawSample {
    Vec3 point = Vec3::Zero();
    Vec3 cross = Vec3::Zero();  ///< ds x dt: length is the Jacobian
    bool on_boundary = false;
    bool singular = false;
};

/// Maps the sampler's plane to the integer grid of the triangulation.
struct PlaneGrid {
    double x_scale = 1, y_scale = 1;  ///< grid units per row share, and per mm across
    GridPoint point(double x, double y) const;
};

/// The face's border as closed polygons of samples. Seams are part of it (their samples are shared
/// between both sides), poles too (all their nodes are one sample).
struct Boundary {
    struct Node {
        double s = 0, t = 0;
        double x = 0, y = 0;
        GridPoint grid;
        std::uint32_t sample = 0;
    };
    struct Segment {
        std::uint32_t a = 0, b = 0;  ///< nodes
        int edge = -1;               ///< -1 for a bridge over a gap
        std::size_t interval = 0;    ///< which of the edge's intervals
    };
    std::vector<RawSample> samples;
    std::vector<Node> nodes;
    std::vector<Segment> segments;
};

/// Samples all edges at equal arc length of about `spacing`, more densely where an edge turns by
/// more than a sixth of a circle between samples or where two chords would cross. Throws
/// Standard_Failure.
Boundary sample_boundary(const TrimCurves& trim, const FaceSurface& surface,
                         const SurfaceMetric& metric, const PlaneGrid& grid, double spacing);

/// Indices of the segments that cross another one properly.
std::vector<std::size_t> crossing_segments(const Boundary& boundary);

/// Inside and outside of the border by the even-odd rule.
class TrimScan {
  public:
    /// `bins` rows of equal height from grid y 0 to `top`.
    TrimScan(const Boundary& boundary, double top, std::size_t bins);
    /// Grid x of all crossings of the horizontal line at grid height `y`, ascending.
    std::vector<double> crossings(double y) const;
    bool inside(double x, double y) const;

  private:
    std::size_t bin(double y) const;
    struct Chord {
        double xa, ya, xb, yb;
    };
    std::vector<Chord> chords_;
    std::vector<std::uint32_t> start_, index_;
    double bin_height_ = 1;
};

}  // namespace beltgrinding

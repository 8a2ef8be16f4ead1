#pragma once

// Private to this room: a face's surface in the sampler's own parameters (s along rows, t across).

#include <GeomAdaptor_Surface.hxx>
#include <Geom_Surface.hxx>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "beltgrinding/geometry.h"
#include "sample_density.h"
#include "spline_surface.h"

namespace beltgrinding {

struct SurfacePoint {
    Vec3 point;             ///< mm
    Vec3 ds;                ///< derivative along s
    Vec3 dt;                ///< derivative along t
    bool singular = false;  ///< the derivatives are undefined here and were taken beside it
};

class SurfaceRow;

/// The surface over a rectangle of its parameters. s is u and t is v, or the reverse if `swap`.
struct FaceSurface {
    Handle(Geom_Surface) surface;
    std::shared_ptr<const SplineSurface> spline;  ///< the same, where it is one
    double s0 = 0, s1 = 0, t0 = 0, t1 = 0;
    bool swap = false;

    void swap_parameters() {
        std::swap(s0, t0);
        std::swap(s1, t1);
        swap = !swap;
    }
    /// An evaluator for one thread: adaptors cache the last span and are not thread-safe.
    GeomAdaptor_Surface evaluator() const { return GeomAdaptor_Surface(surface); }
    /// Exact point and first derivatives. Throws Standard_Failure.
    SurfacePoint at(const GeomAdaptor_Surface& evaluator, double s, double t) const;
    /// For many points of constant t, one after the other.
    SurfaceRow row(const GeomAdaptor_Surface& evaluator, double t) const;
    /// Normal curvatures along s and along t, 1/mm, without sign; 0 where there are none.
    std::array<double, 2> bend(const GeomAdaptor_Surface& evaluator, double s, double t) const;
    /// Parameters along s (or t) between which the surface is smooth, the rectangle's own included.
    std::vector<double> knots(bool along_s) const;
};

/// Points of one row, for one thread; lives no longer than what it was made of.
class SurfaceRow {
  public:
    SurfaceRow(const FaceSurface& surface, const GeomAdaptor_Surface& evaluator, double t);
    /// As FaceSurface::at, to rounding.
    SurfacePoint at(double s);

  private:
    const FaceSurface* surface_;
    const GeomAdaptor_Surface* evaluator_;
    double t_;
    std::optional<SplineSurface::Row> row_;
};

/// The map from the rectangle to the sampler's plane: x in [0, 1] is the share of arc length along
/// a row of constant t, y is in mean arc length across the rows, mm. Made from a table of first
/// derivatives; any strictly monotone map is right, a good one makes spacing even. Where a density
/// is asked for, all lengths of the map are stretched by the spacing over that wanted there, along
/// rows and across them each by its own: spacing that is even on the map is then as wanted.
class SurfaceMetric {
  public:
    /// Chooses the direction of the rows (may swap `surface`): that in which neighbouring rows
    /// keep the evener distance. The spacing sets how fine a table is worth while. Throws
    /// Standard_Failure; returns non-finite lengths if the surface gives NaN.
    SurfaceMetric(FaceSurface& surface, const SampleDensity& density);

    double height() const { return y_.back(); }          ///< mm, across the rows
    double mean_length() const { return mean_length_; }  ///< mm, of a row
    double max_length() const { return max_length_; }
    double mean_jacobian() const { return mean_jacobian_; }  ///< mm2 per unit of parameters' area

    double y_of(double t) const;
    double t_of(double y) const;

    /// Arc length along the row at `t`: at each of `columns()`, cumulative, mm.
    struct Row {
        std::vector<double> length;
        double total() const { return length.back(); }
    };
    Row row(double t) const;
    double x_of(const Row& row, double s) const;
    /// `cell`: of the table, in which the last one lay, 0 at first; where `x` goes on from call to
    /// call, nothing is searched.
    double s_of(const Row& row, double x, std::size_t& cell) const;
    double x_of(double s, double t) const;

    /// Whether anything is stretched.
    bool stretched() const { return !stretch_s_.empty(); }
    /// `offset` (mm, at s, t, where the surface has the derivatives of `at`) as stretched: along s,
    /// across it in the surface, along the normal.
    Vec3 stretched(const Vec3& offset, const SurfacePoint& at, double s, double t) const;

  private:
    struct Table;
    void fill(const Table& table);
    void refine_where_bent(const FaceSurface& surface, const GeomAdaptor_Surface& evaluator);
    void stretch(const FaceSurface& surface, const GeomAdaptor_Surface& evaluator,
                 const SampleDensity& density, const Table& table);

    std::vector<double> s_, t_;       ///< table's parameters
    std::vector<double> cumulative_;  ///< [t][s], mm
    std::vector<double> y_;           ///< at t_, mm
    std::vector<double> stretch_s_;   ///< [t][s]; empty: 1 everywhere
    std::vector<double> stretch_t_;   ///< at t_
    double mean_length_ = 0, max_length_ = 0, mean_jacobian_ = 0;
};

}  // namespace beltgrinding

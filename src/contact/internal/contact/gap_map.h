#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/height_field.h"
#include "contact/compliance.h"

namespace beltgrinding {

/// The current surface seen from the wheel, on the wheel's own regular grid, and the way back from
/// the grid to the samples.
///
/// Each sample's top is put into the wheel's cylinder coordinates (arc length s = R theta, axial y,
/// radius r); its gap is r - (R - drop(y)), radial. The gap of a cell is the weighted mean over the
/// samples around it (cloud-in-cell weights), each carried to the cell's centre along its own
/// tangent plane, so that a plane is reproduced exactly whatever the sampling. Where several layers
/// of the surface lie over each other, only the one nearest to the wheel counts.
///
/// The cells must not be finer than the samples: `ContactGrid` spacing >= 1.5 x field spacing.
class GapMap {
  public:
    /// `spacing`: wanted cell, mm; the axial one is adjusted to divide the wheel's width.
    GapMap(const ContactWheel& wheel, double spacing);

    /// Maps the samples `hits` for the wheel at `work_from_contact`. Samples that face away, that
    /// were missed by the stock's rays or that lie beyond the gap `reach` (mm) are left out.
    void update(const HeightField& field, std::span<const std::uint32_t> hits,
                const Frame& work_from_contact, double reach);

    /// Grid of the last update; its length follows the samples in reach.
    const ContactGrid& grid() const { return grid_; }
    const Eigen::ArrayXd& gap() const { return gap_; }            ///< mm; +inf: no surface
    const Eigen::ArrayXd& coverage() const { return coverage_; }  ///< [0, 1]
    bool empty() const { return footprints_.empty(); }
    /// Smallest gap, mm; +inf when empty.
    double lowest() const { return gap_.size() > 0 ? gap_.minCoeff() : kNone; }

    /// Lowers `field.height` by the removal of `rate` (mm/s per cell) over `duration` s: the rate
    /// is interpolated at each sample, then scaled so that the samples' volume equals the cells'
    /// (rate x coverage x cell area x duration) to rounding. No sample falls below the envelope of
    /// the undeformed wheel, moved by `approach` (mm, along the contact frame's z) from where the
    /// map was taken; what that keeps back is taken from the others, as far as they stand above it.
    /// Appends the samples it lowered to `changed`. Returns the volume, mm3.
    double remove(HeightField& field, const Eigen::ArrayXd& rate, double duration, double approach,
                  std::vector<std::uint32_t>& changed);

    /// Lowers every sample that reaches into the wheel's envelope onto it, along its own normal: a
    /// rigid tool. Appends them to `changed`. Returns the volume, mm3.
    double cut(HeightField& field, std::vector<std::uint32_t>& changed) const;

    /// Adds what `rate` (mm/s per cell) takes from each sample in `duration` s to `amounts` (mm,
    /// one per sample of the field), without touching the field: as little as the last `remove`
    /// took where the envelope kept some back.
    void spread(const Eigen::ArrayXd& rate, double duration,
                Eigen::Ref<Eigen::ArrayXd> amounts) const;

    /// Raises `largest` (one per sample of the field) to what `values` (one per cell) are at each
    /// sample, where that is more.
    void raise(const Eigen::ArrayXd& values, std::span<float> largest) const;

    /// The sample of the nearest layer that lies nearest to (s, y), mm; none if the map is empty.
    std::optional<std::uint32_t> sample_near(double s, double y) const;

    /// Mean slopes of the design surface's gap along s and y, over the samples within `reach` mm of
    /// (s, y); NaN where there is none. By the samples' own normals: grinding does not change them.
    Eigen::Vector2d slope_near(double s, double y, double reach) const;

  private:
    static constexpr double kNone = std::numeric_limits<double>::infinity();

    /// A sample on the grid, shared by four cells.
    struct Footprint {
        std::uint32_t sample;
        double s, y;  // mm
        double gap;   // mm, at (s, y); once on the grid, carried to the first cell's centre
        double slope_s, slope_y;  // once on the grid, by a cell
        double inside;            // share of the sample's extent that lies within the wheel's width
        int cell;                 // the first of the four: lower s, lower y
        float u, v;               // weights of the cells of higher s, of higher y
        float own_gap;            // mm, radial, at the sample itself
        float cosine;             // of its normal against the wheel's radius
        float facing;             // cosine of the wheel's radius there against the contact's z
        float area;               // mm2, of the design surface
        float projected_area;     // mm2, on the wheel
        bool boundary;
        float taken = 1.0f;   // share of what the cells' rate asked for that the envelope let go
        bool nearest = true;  // belongs to the layer nearest to the wheel
    };
    /// Finds the four cells.
    void put_on_grid(Footprint& f) const;
    /// Calls visit(cell, weight, gap carried to its centre) for each of the four.
    template <class Visit>
    void for_cells(const Footprint& f, Visit visit) const;
    void fit_grid(double half_length);
    /// How far of `wanted` mm the sample may be lowered until it lies on the envelope of the wheel,
    /// moved by `approach` mm along z.
    double down_to_envelope(const HeightField& field, const Footprint& f, double approach,
                            double wanted) const;

    ContactWheel wheel_;
    double steepest_flank_ = 0.0;  // of the wheel's profile, mm per mm of width
    Frame contact_from_work_ = Frame::Identity();
    ContactGrid grid_;
    Eigen::ArrayXd gap_, coverage_, nearest_, weight_;
    std::vector<std::uint8_t> at_boundary_;
    std::vector<Footprint> footprints_;
    std::vector<double> lowering_, room_;  // mm, by footprint
};

/// Carries a pressure field from one grid to another of the same cells and another length (both are
/// centred); cells without a counterpart get 0.
Eigen::ArrayXd recentre(const Eigen::ArrayXd& values, const ContactGrid& from,
                        const ContactGrid& to);

}  // namespace beltgrinding

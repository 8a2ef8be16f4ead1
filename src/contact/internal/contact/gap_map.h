#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/height_field.h"
#include "contact/coverage.h"
#include "contact/displaced.h"

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
    /// `spacing`: wanted cell, mm; the axial one is adjusted to divide the wheel's width. `beside`:
    /// mm beyond the wheel's side faces up to which samples are kept for what bulges out there.
    GapMap(const ContactWheel& wheel, double spacing, double beside = 0.0);

    /// Maps the samples `hits` for the wheel at `work_from_contact`. Samples that face away, that
    /// were missed by the stock's rays or that lie beyond the gap `reach` (mm) are left out.
    void update(const HeightField& field, std::span<const std::uint32_t> hits,
                const Frame& work_from_contact, double reach);

    /// Grid of the last update; its length follows the samples in reach.
    const ContactGrid& grid() const { return grid_; }
    const Eigen::ArrayXd& gap() const { return gap_; }  ///< mm; +inf: no surface
    /// As `Coverage::share`.
    const Eigen::ArrayXd& coverage() const { return coverage_.share; }
    bool empty() const { return footprints_.empty(); }
    /// Smallest gap, mm; +inf when empty.
    double lowest() const { return gap_.size() > 0 ? gap_.minCoeff() : kNone; }

    /// What bears pressure beyond the side faces from now on, until the next update.
    void reach_beside(const DisplacedPressure& pressure);
    /// mm3/s of `rate`, mm/s per cell, and of `beside`, mm/s as `DisplacedPressure::beside`.
    double volume_rate(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside) const;

    /// Lowers `field.height` by the removal of `rate` (mm/s per cell), and of `beside` (mm/s, as
    /// `DisplacedPressure::beside`), over `duration` s: the rate
    /// is interpolated at each sample, then scaled so that the samples' volume equals the cells'
    /// (`volume_rate` x duration) to rounding. No sample falls below the envelope of
    /// the undeformed wheel, moved by `approach` (mm, along the contact frame's z) from where the
    /// map was taken; what that keeps back is taken from the others, as far as they stand above it.
    /// Appends the samples it lowered to `changed`. Returns the volume, mm3.
    double remove(HeightField& field, const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside,
                  double duration, double approach, std::vector<std::uint32_t>& changed);

    /// Lowers every sample that reaches into the wheel's envelope onto it, along its own normal: a
    /// rigid tool. Appends them to `changed`. Returns the volume, mm3.
    double cut(HeightField& field, std::vector<std::uint32_t>& changed) const;

    /// Adds what `rate` and `beside` (as in `remove`) take from each sample in `duration` s to
    /// `amounts` (mm, one per sample of the field), without touching the field: as little as the
    /// last `remove` took where the envelope kept some back.
    void spread(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside, double duration,
                Eigen::Ref<Eigen::ArrayXd> amounts) const;

    /// The same sample by sample, as much of the cells' volume as the last `remove` took: calls
    /// visit(sample, mm).
    template <class Visit>
    void for_samples(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside, double duration,
                     Visit visit) const {
        sum_rates(rate, beside, sums_);
        for (std::size_t k = 0; k < footprints_.size(); ++k) {
            const Footprint& f = footprints_[k];
            if (sums_[k] != 0.0) visit(f.sample, scale_ * f.taken * sums_[k] * duration);
        }
    }

    /// Raises `largest` (one per sample of the field) to the pressure at each sample, where that is
    /// more.
    void raise(const DisplacedPressure& pressure, std::span<float> largest) const;

    /// The sample of the nearest layer that lies nearest to (s, y), mm; none if the map is empty.
    std::optional<std::uint32_t> sample_near(double s, double y) const;

    /// Mean slopes of the design surface's gap along s and y, over the samples within `reach` mm of
    /// (s, y); NaN where there is none. By the samples' own normals: grinding does not change them.
    Eigen::Vector2d slope_near(double s, double y, double reach) const;

  private:
    static constexpr double kNone = std::numeric_limits<double>::infinity();

    /// A sample on the grid, shared by four cells.
    struct Footprint {
        double gap;  // mm, at (s, y); once on the grid, carried to the first cell's centre
        std::uint32_t sample;
        int cell;                // the first of the four: lower s, lower y
        float s, y;              // mm
        float slope_s, slope_y;  // once on the grid, by a cell
        float u, v;              // weights of the cells of higher s, of higher y
        float shares[4];         // of the four cells in what is true at the sample; sum 1, or all 0
        float inside;            // share of its patch that lies within the wheel's width
        float own_gap;           // mm, radial, at the sample itself
        float cosine;            // of its normal against the wheel's radius
        float facing;            // cosine of the wheel's radius there against the contact's z
        float area;              // mm2, of the design surface
        float taken;             // share of what the cells' rate asked for that the envelope let go
        bool nearest;            // belongs to the layer nearest to the wheel
    };
    /// What a sample stands for, as a rectangle: middle and half its sides, mm.
    struct Patch {
        double s, y, half_s, half_y;
    };
    /// One near an edge, in cells, from the middle of the outermost cell of lower s and y.
    struct EdgePatch {
        std::size_t footprint;
        float s, y, half_s, half_y;
    };
    /// Where the patch of a sample on a border has its middle, from the sample: in the work frame.
    struct BorderPatch {
        std::uint32_t sample;
        Vec3f middle;  // mm
        float along;   // mm, how far samples are apart on the border; 0: as everywhere
    };
    /// A sample whose patch reaches beyond a side face: from there outwards, mm.
    struct BesidePatch {
        std::size_t footprint;
        int side;         // 0: at -y, 1: at +y
        double from, to;  // of the patch
        double whole;     // its side along y
        double share;     // of the patch that is reached
    };
    /// What `values` (two per column, as `DisplacedPressure::beside`) are at the patch.
    double beside_at(const BesidePatch& patch, const Eigen::ArrayXd& values) const;
    /// mm that each sample is lowered by in 1 s, if nothing holds it.
    void sum_rates(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside,
                   std::vector<double>& sums) const;
    /// Keeps the footprint's patch if that reaches beyond the side faces.
    void note_beside(const Patch& patch);
    /// Once for each field.
    void find_borders(const HeightField& field);
    /// The same for the patches' forms, where samples do not lie evenly.
    void find_forms(const HeightField& field);
    /// Null if the sample lies on no border.
    const BorderPatch* border_patch(std::uint32_t sample) const;
    /// Before the footprint is put on the grid.
    Patch patch_of(const Footprint& f, const HeightField& field) const;
    /// Finds the four cells.
    void put_on_grid(Footprint& f) const;
    /// The one of the four that the sample lies in.
    int own_cell(const Footprint& f) const;
    /// Calls visit(cell, weight, gap carried to its centre) for each of the four.
    template <class Visit>
    void for_cells(const Footprint& f, Visit visit) const;
    /// Calls visit(cell, share of it that the patch covers, middle of that from the cell's along
    /// and across in cells, gap carried to its centre).
    template <class Visit>
    void for_patch(const EdgePatch& patch, Visit visit) const;
    void fit_grid(double half_length);
    /// Cells beside which there is nothing, or another layer, are `kEdge`; those up to two further
    /// are `kNearEdge`.
    void mark_edges();
    /// Edge cells are covered as far as patches of their nearest layer lie on them, the others
    /// wholly.
    void cover(const HeightField& field);
    /// The gap of each cell, at its centre.
    void average_gap();
    /// The four cells' shares in each sample: those of its layer, by how much of them is covered.
    void share_cells();
    /// The gap of cells that are covered in part, carried to the middle of that part.
    void carry_to_middles();
    /// What `values` (one per cell) are at the sample.
    double at(const Footprint& f, const Eigen::ArrayXd& values) const;
    /// How far of `wanted` mm the sample may be lowered until it lies on the envelope of the wheel,
    /// moved by `approach` mm along z.
    double down_to_envelope(const HeightField& field, const Footprint& f, double approach,
                            double wanted) const;

    ContactWheel wheel_;
    double steepest_flank_ = 0.0;  // of the wheel's profile, mm per mm of width
    Frame contact_from_work_ = Frame::Identity();
    ContactGrid grid_;
    double layer_ = 0.0;  // mm: what lies further behind the nearest belongs to another layer
    Coverage coverage_;
    Eigen::ArrayXd gap_, weight_;
    std::vector<double> nearest_, farthest_;  // mm, of the samples in a cell
    enum : std::uint8_t { kWhole, kNearEdge, kEdge };
    std::vector<std::uint8_t> kind_, wider_;
    std::vector<Footprint> footprints_;
    std::vector<EdgePatch> patches_;
    std::vector<BorderPatch> borders_;  // by sample
    // Along what is longer of each sample's patch, by how much more; empty: samples lie evenly.
    std::vector<Vec3f> longer_;
    double beside_ = 0.0;  // mm
    std::vector<BesidePatch> beside_patches_;
    Eigen::ArrayXd reach_;  // mm, of what bulges; empty: nothing does
    const HeightField* borders_of_ = nullptr;
    std::size_t borders_size_ = 0;         // samples that it had
    double scale_ = 1.0;                   // of the last `remove`, so that volumes are equal
    std::vector<double> lowering_, room_;  // mm, by footprint
    mutable std::vector<double> sums_;     // mm/s, by footprint
};

/// `ContactProblem::drop` of a wheel.
Eigen::ArrayXd profile_drop(const ContactWheel& wheel, const ContactGrid& grid);

/// Carries a pressure field from one grid to another of the same cells and another length (both are
/// centred); cells without a counterpart get 0.
Eigen::ArrayXd recentre(const Eigen::ArrayXd& values, const ContactGrid& from,
                        const ContactGrid& to);

}  // namespace beltgrinding

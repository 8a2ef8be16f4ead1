#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/height_field.h"
#include "contact/belt_arc.h"
#include "contact/displaced.h"
#include "gap/cell_gaps.h"
#include "gap/cell_table.h"
#include "gap/edge_profiles.h"
#include "gap/noses.h"
#include "gap/placed_samples.h"
#include "gap/sample_removal.h"
#include "gap/sweep.h"
#include "heightfield/sample_blocks.h"

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
/// The cells must not be finer than the samples: `ContactGrid` spacing >= 1.5 x field spacing, but
/// on noses, where samples lie closer.
class GapMap {
  public:
    /// `spacing`: wanted cell, mm, less where the wheel presses on a nose (`Noses`); the axial one
    /// is adjusted to divide the wheel's width. `beside`: mm beyond the wheel's side faces up to
    /// which samples are kept for what bulges out there.
    GapMap(const ContactWheel& wheel, double spacing, double beside = 0.0);

    /// The wheel, a very large one, stands for a belt, which is flat until it is pressed: its gap
    /// is the depth below a plane, far steeper slopes are of one layer, and there is nothing beyond
    /// its free run from `from` to `to`, mm along the travel. `face`: where its face lies.
    void lie_flat(double from, double to, const BeltArc& face = {});
    /// Looks once at the borders and steps of a field and the form of its samples' patches, which
    /// `update` does otherwise.
    void prepare(const SampleBlocks& blocks) {
        placed_.form().look(blocks, run_ ? std::nullopt : std::optional(LowSteps::least(grid_)));
        if (!run_) noses_.look(blocks);
    }

    /// Maps the samples of the blocks `hits` (ascending) for the wheel at `work_from_contact`,
    /// which faces the work by the part of it beyond `ahead` mm from its axis. Samples that face
    /// away or that were missed by the stock's rays are left out. The grid is as long as the
    /// samples within the gap `reach` (mm) lie; of the others in these blocks those that lie on it
    /// and go on with the same layer are mapped as well.
    ///
    /// Edges of what is mapped are looked at near cells with a gap up to `pressable` mm only:
    /// `holds_for` tells whether that was enough, `look_at_all_edges` does the rest.
    void update(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
                const Frame& work_from_contact, double reach, double ahead = 0.0,
                double pressable = EdgeCells::kAll);
    /// No cell that an edge not looked at has to do with bears pressure (MPa, by cell).
    bool holds_for(const Eigen::ArrayXd& pressure) const {
        return cells_.edges().holds_for(pressure);
    }
    void look_at_all_edges(const SampleBlocks& blocks);

    /// mm beyond the `reach` of `update` up to which samples go on with what is in reach.
    double behind() const { return cells_.whole_layer(); }
    /// Grid of the last update; its length follows the samples in reach.
    const ContactGrid& grid() const { return grid_; }
    const Eigen::ArrayXd& gap() const { return cells_.gap(); }  ///< mm; +inf: no surface
    /// As `Coverage::share`.
    const Eigen::ArrayXd& coverage() const { return cells_.coverage().share; }
    bool empty() const { return placed_.count() == 0; }
    /// Samples in reach.
    std::size_t samples() const { return placed_.count(); }
    /// Smallest gap, mm, of a belt that to where its face lies; +inf when empty.
    double lowest() const;
    /// The same of the samples themselves.
    double nearest() const { return placed_.least_gap(); }

    /// What bears pressure beyond the side faces from now on, until the next update.
    void reach_beside(const DisplacedPressure& pressure);
    /// Shares the pressure (MPa by cell) of the cells at edges out among their samples, from now
    /// on, until the next update.
    void sharpen_edges(const SampleBlocks& blocks, const Eigen::ArrayXd& pressure,
                       const EdgeSoftness& softness) {
        profiles_.sharpen(grid_, coverage(), pressure, softness, blocks, cells_.patches(),
                          placed_.footprints());
    }
    /// mm3/s of `rate`, mm/s per cell along the surface's normal, and of `beside`, mm/s as
    /// `DisplacedPressure::beside`.
    double volume_rate(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside) const;

    /// Lowers heights by the removal of `rate` (mm/s per cell), and of `beside` (mm/s, as
    /// `DisplacedPressure::beside`), over `duration` s: the rate
    /// is interpolated at each sample, then scaled so that the samples' volume equals the cells'
    /// (`volume_rate` x duration) to rounding. No sample falls below the envelope of
    /// the undeformed wheel, moved by `approach` (mm, along the contact frame's z) from where the
    /// map was taken; what that keeps back is taken from the others, as far as they stand above it.
    /// Returns the volume, mm3. `blocks`: those of the last update.
    double remove(SampleBlocks& blocks, const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside,
                  double duration, double approach);
    /// mm3/s, or others of the cells, as they are on the mean over the step: `Sweep::mean`.
    Eigen::ArrayXd mean_over(const Sweep& sweep, const Eigen::ArrayXd& values) const {
        return sweep.mean(grid_, placed_.pose().wheel().radius, coverage(), values);
    }

    /// Lowers every sample that reaches into the wheel's envelope onto it, along its own normal: a
    /// rigid tool. Returns the volume, mm3.
    double cut(SampleBlocks& blocks) const { return cut_to_envelope(placed_, blocks); }

    /// What `rate` and `beside` (as in `remove`) take from each sample in `duration` s, without
    /// touching it: as little as the last `remove` took where the envelope kept some back, and not
    /// scaled. Calls visit(position, mm) for those that are not 0.
    template <class Visit>
    void for_samples(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside, double duration,
                     Visit visit) const {
        removal_.for_samples(placed_, grid_, {rate, beside, duration}, visit);
    }
    /// What the last `remove` scaled the samples' volume by.
    double scale() const { return removal_.scale(); }
    /// What is known from the last `update` and `remove` on where the next ones are left out.
    struct Carried {
        std::size_t samples = 0;
        double scale = 1.0;
    };
    Carried carried() const { return {placed_.count(), removal_.scale()}; }
    void carry(const Carried& carried) {
        placed_.set_count(carried.samples);
        removal_.set_scale(carried.scale);
    }

    /// Raises `largest` (one per position, of whole blocks) to the pressure at each sample, where
    /// that is more.
    void raise(const DisplacedPressure& pressure, std::span<float> largest) const;

    /// Calls visit(position, MPa) for the pressure at each sample, where there is some.
    template <class Visit>
    void for_pressed(const DisplacedPressure& pressure, Visit visit) const {
        const auto visit_block = [&visit](std::size_t first, const float* values) {
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane)
                if (values[lane] > 0.0f) visit(first + lane, values[lane]);
        };
        for_pressed_blocks(
            pressure, visit_block,
            [&visit](std::size_t position, double value, double) { visit(position, value); });
    }
    /// The same, with visit_block(first position, values) for the positions of a whole block, some
    /// of which have none, and visit(position, MPa, share) for others, on a share of whose area it
    /// is.
    template <class VisitBlock, class Visit>
    void for_pressed_blocks(const DisplacedPressure& pressure, VisitBlock visit_block,
                            Visit visit) const {
        const Bilinear* table = table_.fill(grid_, pressure.pressure, 1.0);
        float values[kBlockLanes];
        for (const PlacedBlock& block : placed_.regular()) {
            if (interpolate(block, table, 0.0f, values))
                visit_block(std::size_t{block.block} * kBlockLanes, values);
        }
        const auto footprints = placed_.footprints();
        for (const Footprint& f : footprints) {
            if (!f.nearest || !(f.inside > 0.0f)) continue;
            if (const double value = value_at(grid_, f, pressure.pressure); value > 0.0)
                visit(f.position, value, double{f.inside});
        }
        placed_.beside().for_reached(grid_, footprints, pressure.beside,
                                     [&](std::size_t footprint, double share, double value) {
                                         if (value > 0.0)
                                             visit(footprints[footprint].position, value, share);
                                     });
    }

    /// Position of the sample of the nearest layer that lies nearest to (s, y), mm; none if the map
    /// is empty.
    std::optional<std::size_t> sample_near(double s, double y) const {
        return placed_.nearest_to(grid_, s, y);
    }

    /// Of the samples near a place: the mean of where they lie (s, y; mm), which at the surface's
    /// border is not that place, and of the slopes of the design surface's gap along s and y.
    struct MeanSlope {
        Eigen::Vector2d place, slope;
    };
    /// Over the samples within `reach` mm of (s, y); NaN where there is none. By the samples' own
    /// normals: grinding does not change them. `blocks`: those of the last update.
    MeanSlope slope_near(const SampleBlocks& blocks, double s, double y, double reach) const;

  private:
    /// Places the samples, in cells that suit what they stand for.
    void place(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
               const Frame& work_from_contact, const PlacedSamples::Limits& limits);
    /// Cells for samples of up to this |s|, mm.
    void fit_grid(double half_length);
    /// Of a belt: what lies beyond its free run is no surface; `stretch_` of the others.
    void end_flat();

    struct Run {
        double from, to;  // mm
    };
    ContactGrid grid_;
    std::optional<Run> run_;  // of a belt
    BeltArc face_;            // the same: how its face lies
    Eigen::ArrayXd stretch_;  // of a belt: mm2 of surface by mm2 of its cells' plane; else empty
    Noses noses_;
    Noses::Sides sides_;  // of the grid's cells
    PlacedSamples placed_;
    CellGaps cells_;
    EdgeProfiles profiles_;
    SampleRemoval removal_;
    mutable CellTable table_;  // of a pressure
};

}  // namespace beltgrinding
